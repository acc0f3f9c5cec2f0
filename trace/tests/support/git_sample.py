# SPDX-License-Identifier: Apache-2.0
"""Puts a sample project under git, with the settings of a normal user."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

_ENVIRONMENT = {
    **os.environ,
    "GIT_CONFIG_GLOBAL": os.devnull,
    "GIT_CONFIG_NOSYSTEM": "1",
    "GIT_AUTHOR_NAME": "The Maintainers",
    "GIT_AUTHOR_EMAIL": "maintainers@example.invalid",
    "GIT_COMMITTER_NAME": "The Maintainers",
    "GIT_COMMITTER_EMAIL": "maintainers@example.invalid",
    "GIT_AUTHOR_DATE": "2026-11-21T10:00:00+00:00",
    "GIT_COMMITTER_DATE": "2026-11-21T10:00:00+00:00",
}


def git(root: Path, *arguments: str) -> str:
    """The output of git; an error of git fails the test."""
    answer = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=True, env=_ENVIRONMENT)
    return answer.stdout.strip()


def start_history(root: Path) -> str:
    """A repository with one commit of all files except the build tree. @return its hash."""
    git(root, "init", "-q", "-b", "main")
    (root / ".gitignore").write_text("build/\nreport/\n", encoding="utf-8")
    return commit(root, "Start")


def commit(root: Path, message: str) -> str:
    """Commits all current files. @return the hash."""
    git(root, "add", "-A")
    git(root, "commit", "-q", "--allow-empty", "-m", message)
    return git(root, "rev-parse", "HEAD")
