# SPDX-License-Identifier: Apache-2.0
"""Questions to git whose answers count as inputs of a run, so that they can be put again when the next run asks whether all is as it was.

@satisfies SWR-TRC-091      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import os
from pathlib import Path

from mamori_trace.base.git_run import run_git
from mamori_trace.cache.inputs import note_question

_TIMEOUT_S = 60


def ask(root: Path | str, *arguments: str) -> str:
    """What git answers, or an empty text where it does not."""
    answer = run_git(root, arguments, _TIMEOUT_S)
    text = "" if answer is None else os.fsdecode(answer).strip()
    note_question(str(root), arguments, text)
    return text
