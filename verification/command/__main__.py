# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori.verification.command`, the way the launcher script comes in."""

import sys

from mamori.verification.command.main import main

sys.exit(main())
