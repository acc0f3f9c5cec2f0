# SPDX-License-Identifier: Apache-2.0
"""`python -P -m mamori.verification.trace_bench` runs the measurement."""

import sys

from mamori.verification.trace_bench.command import main

sys.exit(main())
