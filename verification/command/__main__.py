# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori.verification.command`, the way the launcher script comes in."""

import sys

try:
    from mamori.verification.command.main import main
except KeyboardInterrupt:  # stopped before it could listen
    print("\nmamori: stopped; no report was written", file=sys.stderr)
    sys.exit(130)

sys.exit(main())
