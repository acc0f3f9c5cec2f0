# SPDX-License-Identifier: Apache-2.0
"""The only module that calls git for reading. The configuration of a checked repository starts no program.

@satisfies SWR-TRC-106      Design: docs/design/trace.md#record
"""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

TIMEOUT_S = 120

_HARMLESS = ("core.fsmonitor=false", "core.hooksPath=/dev/null", "core.pager=cat", "core.sshCommand=false", "core.askPass=false",
             "core.attributesFile=/dev/null", "credential.helper=", "gpg.program=false", "gpg.ssh.program=false",
             "gpg.x509.program=false", "log.showSignature=false", "protocol.allow=never", "uploadpack.packObjectsHook=", "gc.auto=0",
             "maintenance.auto=false", "submodule.recurse=false", "core.gitProxy=", "sequence.editor=false", "core.editor=false")  # fmt: skip
"""Settings of the command line override the settings of a repository."""
_MORE_OPTIONS = {"diff": ("--no-ext-diff", "--no-textconv", "--ignore-submodules=dirty"), "log": ("--no-ext-diff", "--no-textconv"),
                 "show": ("--no-ext-diff", "--no-textconv"), "status": ("--ignore-submodules=dirty",)}  # fmt: skip
"""git would inspect a submodule with a separate git process, which ignores the settings above."""
_FILTER = re.compile(r"""^[ \t]*\[[ \t]*filter[ \t]+"([^"\n]+)"[ \t]*\]|^[ \t]*\[filter\.([\w.-]+)\]""", re.MULTILINE | re.IGNORECASE)
_PATH = re.compile(r"""^[ \t]*path[ \t]*=[ \t]*"?([^"\n#;]+)""", re.MULTILINE | re.IGNORECASE)
_FILES_MAX = 32


def get_git_environment() -> dict[str, str]:
    """With this environment, git takes no lock, prints English, fetches nothing and never prompts."""
    return {**os.environ, "GIT_OPTIONAL_LOCKS": "0", "LC_ALL": "C", "GIT_NO_LAZY_FETCH": "1", "GIT_TERMINAL_PROMPT": "0"}


def make_git_command(root: Path | str, arguments: Sequence[str]) -> list[str]:
    """The complete command line."""
    harmless = [word for setting in (*_HARMLESS, *_list_filters(root)) for word in ("-c", setting)]
    words = list(arguments)
    index = _find_command(words)
    if index < len(words):
        words[index + 1 : index + 1] = _MORE_OPTIONS.get(words[index], ())
    return ["git", "-C", str(root), "--no-pager", *harmless, *words]


def run_git(root: Path | str, arguments: Sequence[str], timeout_s: float = TIMEOUT_S) -> bytes | None:
    """The output of git; None if git is missing, fails, or takes longer than `timeout_s`."""
    return _run(make_git_command(root, arguments), timeout_s)


def _run(command: list[str], timeout_s: float) -> bytes | None:
    try:
        answer = subprocess.run(command, capture_output=True, timeout=timeout_s, check=False, env=get_git_environment())
    except (OSError, subprocess.TimeoutExpired):
        return None
    return answer.stdout if answer.returncode == 0 else None


def _find_command(words: list[str]) -> int:
    """Index of the git command, after all `-c SETTING`."""
    index = 0
    while index < len(words) and words[index] == "-c":
        index += 2
    return index


def _list_filters(root: Path | str) -> list[str]:
    """Settings that disable each content filter of the repository configuration; git has no option that disables all filters."""
    pending = _find_configurations(Path(root))
    names: set[str] = set()
    for _ in range(_FILES_MAX):
        if not pending:
            break
        path = pending.pop()
        if not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue
        names.update(match[1] or match[2] for match in _FILTER.finditer(text))
        pending += [path.parent / os.path.expanduser(match[1].strip()) for match in _PATH.finditer(text)]
    return [setting for name in sorted(names) for setting in (*(f"filter.{name}.{kind}=" for kind in ("clean", "smudge", "process")),
                                                              f"filter.{name}.required=false")]  # fmt: skip


def _find_configurations(root: Path) -> list[Path]:
    """The configuration files of the repository that contains `root`, also for a linked worktree."""
    top = root.resolve()
    for folder in (top, *top.parents):
        git = folder / ".git"
        if git.is_dir():
            return [git / "config", git / "config.worktree"]
        if git.is_file():
            own = folder / git.read_text(encoding="utf-8", errors="replace").removeprefix("gitdir:").strip()
            try:
                common = own / (own / "commondir").read_text(encoding="utf-8", errors="replace").strip()
            except OSError:
                common = own
            return [common / "config", own / "config.worktree", own / "config"]
    return []
