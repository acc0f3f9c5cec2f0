# SPDX-License-Identifier: Apache-2.0
"""The one place that calls git to read."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

TIMEOUT_S = 120


def get_git_environment() -> dict[str, str]:
    """git then takes no lock beside a user who works in the same repository, and speaks English."""
    return {**os.environ, "GIT_OPTIONAL_LOCKS": "0", "LC_ALL": "C"}


def run_git(root: Path | str, arguments: Sequence[str], timeout_s: float = TIMEOUT_S) -> bytes | None:
    """What git prints; nothing where it is not there, fails, or takes longer than `timeout_s`."""
    command = ["git", "-C", str(root), *arguments]
    try:
        answer = subprocess.run(command, capture_output=True, timeout=timeout_s, check=False, env=get_git_environment())
    except (OSError, subprocess.TimeoutExpired):
        return None
    return answer.stdout if answer.returncode == 0 else None
