# SPDX-License-Identifier: Apache-2.0
"""Queries git for the checked-out commit, for uncommitted changes, and for the name of the reviewer."""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.git_run import run_git
from mamori_trace.cache.questions import ask


def read_head(root: Path) -> str:
    """Hash of the checked-out commit, or an empty text without a git repository."""
    return ask(root, "rev-parse", "HEAD")


def read_commit_date(root: Path) -> str:
    """Commit date of the checked-out commit (ISO 8601), in the time zone of its committer; empty without a git repository."""
    return ask(root, "show", "--no-patch", "--format=%cs", "HEAD")


def read_title(root: Path, item_id: str) -> str:
    """Title of an item in the checked-out commit, or empty if it is not there."""
    line = ask(root, "grep", "-h", "--fixed-strings", "--max-count=1", f"## {item_id} ", "HEAD", "--", "requirements")
    return line.partition("\n")[0].removeprefix(f"## {item_id}").strip() if line.startswith(f"## {item_id} ") else ""


def read_user(root: Path) -> str:
    """Name of the user in the git configuration, or an empty text."""
    return ask(root, "config", "user.name")


def read_worktree(root: Path) -> str:
    """`clean` or `changed` since the commit; `unknown` without a git repository."""
    answer = run_git(root, ["status", "--porcelain"])
    return "unknown" if answer is None else "changed" if answer else "clean"
