# SPDX-License-Identifier: Apache-2.0
"""Asks git which commit is checked out, whether the files are as it has them, and who reviews."""

from __future__ import annotations

import subprocess
from pathlib import Path

from mamori.trace.readers.git_changes import ask_git


def read_head(root: Path) -> str:
    """Hash of the checked-out commit, or an empty text where there is no git repository."""
    return _ask(root, "rev-parse", "HEAD")


def read_commit_date(root: Path) -> str:
    """Day of the checked-out commit as its committer wrote it (ISO 8601), or an empty text where there is no git repository."""
    return _ask(root, "show", "--no-patch", "--format=%cs", "HEAD")


def read_user(root: Path) -> str:
    """Name of the person at work as git knows it, or an empty text."""
    return _ask(root, "config", "user.name")


def read_worktree(root: Path) -> str:
    """`clean` or `changed` since the commit; `unknown` where there is no git repository."""
    answer = ask_git(root, ["status", "--porcelain"])
    return "unknown" if answer is None else "changed" if answer else "clean"


def _ask(root: Path, *arguments: str) -> str:
    command = ["git", "-C", str(root), *arguments]
    try:
        answer = subprocess.run(command, capture_output=True, text=True, timeout=10, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return answer.stdout.strip() if answer.returncode == 0 else ""
