# SPDX-License-Identifier: Apache-2.0
"""The exit statuses of the command and the errors that lead to them. Status 3, cannot install, is the launcher script's."""

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2
EXIT_INTERRUPTED = 130


class UsageError(Exception):
    """Wrong arguments or input. The message is one line: what, where, how to mend it."""


class StepError(Exception):
    """A step could not do its work. The message is one line and ends in the step's log as well."""
