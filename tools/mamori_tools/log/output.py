# SPDX-License-Identifier: Apache-2.0
"""Standard output of a command that continues when the reader of its output has ended.

@satisfies SWR-REC-011      Design: docs/design/recorder.md#the-command-log
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def until_reader_ends() -> Iterator[None]:
    """Ends the block early if the reader of standard output has ended."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        # Python must not print an error at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
