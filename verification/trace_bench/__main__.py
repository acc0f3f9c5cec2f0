# SPDX-License-Identifier: Apache-2.0
"""`python -P -m verification.trace_bench` runs the measurement."""

import sys

from verification.trace_bench.command import main

sys.exit(main())
