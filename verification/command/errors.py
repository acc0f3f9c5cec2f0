# SPDX-License-Identifier: Apache-2.0
"""The exit statuses of the command and the errors that lead to them. The launcher script uses status 3, too."""

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2
EXIT_MISSING = 3
EXIT_PIPE = 141  # as a shell counts a program whose reader is gone
EXIT_INTERRUPTED = 130


class UsageError(Exception):
    """Wrong arguments or input. The message is one line: what, where, how to mend it."""


class MissingError(Exception):
    """Something that the command needs is not available: a tool, the lock of the project, a folder that can be written."""


class StepError(Exception):
    """A step could not do its work. The message is one line and ends in the step's log as well."""
