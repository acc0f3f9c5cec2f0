# SPDX-License-Identifier: Apache-2.0
"""Git queries whose output is an input of a run. The next run repeats them to detect changes.

@satisfies SWR-TRC-091      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import os
from pathlib import Path

from mamori_trace.base.git_run import run_git
from mamori_trace.cache.inputs import note_question

_TIMEOUT_S = 60


def ask(root: Path | str, *arguments: str) -> str:
    """The output of git, or an empty text if it fails."""
    answer = run_git(root, arguments, _TIMEOUT_S)
    text = "" if answer is None else os.fsdecode(answer).strip()
    note_question(str(root), arguments, text)
    return text
