# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori.trace` runs the trace command without the launcher."""

import sys

from mamori.trace.command import main

sys.exit(main())
