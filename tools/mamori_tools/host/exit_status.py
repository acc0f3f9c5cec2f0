# SPDX-License-Identifier: Apache-2.0
"""The exit statuses of the command; the launcher script also uses status 3. mamori_trace.base.errors defines the errors."""

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2
EXIT_MISSING = 3
EXIT_UNFINISHED = 4  # inconclusive: its time or its host was not sufficient
EXIT_PIPE = 141  # in the convention of the shell for a program whose reader has ended
EXIT_INTERRUPTED = 130
