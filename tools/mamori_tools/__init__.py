# SPDX-License-Identifier: Apache-2.0
"""Host tools that users run: table, timing, instruction counts, fault campaign, flight log, end-to-end protection, motion files."""
