# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori_tools.command`, which the launcher script calls."""

import sys


def _run() -> int:
    from mamori_tools.command.main import main

    return main()


try:
    if sys.argv[1:2] == ["trace"]:
        from mamori_trace.cache.outcome import run_kept

        status = run_kept(sys.argv[2:], _run)
    else:
        status = _run()
except KeyboardInterrupt:  # stopped before the signal handler was installed
    print("\nmamori: stopped; no report was written", file=sys.stderr)
    status = 130

sys.exit(status)
