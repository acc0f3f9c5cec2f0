# SPDX-License-Identifier: Apache-2.0
"""The exit statuses of the command; the launcher script uses status 3, too. The errors are those of mamori_trace.base.errors."""

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2
EXIT_MISSING = 3
EXIT_UNFINISHED = 4  # the call shows nothing: its time or its host did not suffice
EXIT_PIPE = 141  # as a shell reports a program whose reader has ended
EXIT_INTERRUPTED = 130
