# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori_trace` runs the trace command without the launcher."""

import sys

from mamori_trace.cache.outcome import run_kept


def _run() -> int:
    from mamori_trace.command import main  # loads all readers and rules; an unchanged project does not need them

    return main()


sys.exit(run_kept(sys.argv[1:], _run))
