# SPDX-License-Identifier: Apache-2.0
"""Changes between two revisions, from low-level git commands: files with renames, line ranges of both sides, and the old files.

@satisfies SWR-TRC-070, SWR-TRC-073      Design: docs/design/trace.md#impact
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.git_run import get_git_environment, make_git_command, run_git

_HUNK = re.compile(rb"@@ -(\d+)(?:,(\d+))? \+(\d+)(?:,(\d+))? @@")
_MAX_FILE = 16 * 1024 * 1024  # larger files are not sources
_PATCHES = {"T": 2, "U": 0}  # a change of type is reported as a removal and a new file; unmerged paths have a separate line
_REGULAR = (b"100644", b"100755")


@dataclass(slots=True)
class FileChange:
    """One changed file. `status` is git's letter; a path is empty on the side without the file. Ranges are (first, last)."""

    status: str
    old_path: str
    new_path: str
    old_ranges: list[tuple[int, int]] = field(default_factory=list)
    new_ranges: list[tuple[int, int]] = field(default_factory=list)

    @property
    def path(self) -> str:
        return self.new_path or self.old_path


def resolve_revision(root: Path, revision: str) -> str:
    """Hash of the commit that `revision` names. Raises InputError without git, repository, or such a commit."""
    if shutil.which("git") is None:
        raise InputError("git is missing; install the package git")
    if run_git(root, ["rev-parse", "--git-dir"]) is None:
        raise InputError(f"{root}: not in a git repository; only git knows what changed")
    if revision and not revision.startswith("-"):
        answer = run_git(root, ["rev-parse", "--verify", "--quiet", "--end-of-options", revision + "^{commit}"])
        if answer:
            return answer.decode().strip()
    shallow = (run_git(root, ["rev-parse", "--is-shallow-repository"]) or b"").strip() == b"true"
    hint = "the clone is shallow; fetch its history with `git fetch --unshallow`" if shallow else "`git log` lists those at hand"
    raise InputError(f"{root}: revision '{revision}' is unknown; {hint}")


def list_changes(root: Path, old: str, new: str | None) -> list[FileChange]:
    """Changes from `old` to `new`, or to the current files if `new` is None; new files count even if untracked."""
    limits = [old] if new is None else [old, new]
    options = ["--raw", "-p", "-z", "-U0", "-M", "--relative", "--no-color", "--no-ext-diff", "--no-textconv", "--abbrev=40",
               "--ignore-submodules"]  # fmt: skip
    data = _demand(root, ["-c", "core.quotepath=off", "-c", "diff.noprefix=false", "diff", *options, *limits, "--", "."])
    changes = _parse_diff(data)
    if new is None:
        for name in _demand(root, ["ls-files", "-z", "--others", "--exclude-standard"]).split(b"\0"):
            if name and (root / os.fsdecode(name)).is_file():
                changes.append(FileChange("A", "", os.fsdecode(name), [], [(1, _count_lines(root / os.fsdecode(name)))]))
    return sorted(changes, key=lambda change: (change.path, change.status))


def write_tree(root: Path, commit: str, folder: Path, wanted: Callable[[str], bool]) -> list[str]:
    """Writes the regular files of `commit` with wanted paths to `folder`. @return their paths, in order."""
    entries = []
    for entry in _demand(root, ["ls-tree", "-r", "-z", commit]).split(b"\0"):
        head, _, name = entry.partition(b"\t")
        parts = head.split()
        path = os.fsdecode(name)
        if len(parts) == 3 and parts[0] in _REGULAR and _is_inside(path) and wanted(path):
            entries.append((path, parts[2]))
    for path, data in read_blobs(root, entries):
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data)
    return sorted(path for path, _ in entries)


def is_shallow(root: Path) -> bool:
    """Whether the repository contains only the latest part of the history."""
    return (run_git(root, ["rev-parse", "--is-shallow-repository"]) or b"").strip() == b"true"


def _is_inside(path: str) -> bool:
    return not path.startswith("/") and ".." not in path.split("/")


def _count_lines(path: Path) -> int:
    with path.open("rb") as file:
        return sum(1 for _ in file) or 1


def _parse_diff(data: bytes) -> list[FileChange]:
    """Raw records come first, each ended by NUL, and an empty record ends them. The patches follow in the same order."""
    changes: list[FileChange] = []
    position = 0
    while data[position : position + 1] == b":":
        end = data.index(b"\0", position)
        status = data[position:end].split()[4].decode()[:1]
        names = []
        for _ in range(2 if status in "RC" else 1):
            stop = data.index(b"\0", end + 1)
            names.append(os.fsdecode(data[end + 1 : stop]))
            end = stop
        changes.append(_make_change(status, names))
        position = end + 1
    hunks = _list_hunks(data[position:].lstrip(b"\0"))
    for change in changes:
        for _ in range(_PATCHES.get(change.status, 1)):
            old, new = next(hunks, ([], []))
            change.old_ranges += old
            change.new_ranges += new
    return changes


def _make_change(status: str, names: list[str]) -> FileChange:
    old = "" if status == "A" else names[0]
    new = "" if status == "D" else names[-1]
    return FileChange(status, old, new)


def _list_hunks(patch: bytes) -> Iterator[tuple[list[tuple[int, int]], list[tuple[int, int]]]]:
    """Line ranges of both sides for each file of the patch. Lines inside a hunk are only counted; their text is never parsed."""
    current: tuple[list[tuple[int, int]], list[tuple[int, int]]] | None = None
    inside = 0
    for line in patch.split(b"\n"):
        if inside and line[:1] in (b"+", b"-"):
            inside -= 1
            continue
        if line.startswith(b"diff --git "):
            if current is not None:
                yield current
            current = ([], [])
        match = _HUNK.match(line)
        if match and current is not None:
            counts = [int(match[index]) if match[index] else 1 for index in (2, 4)]
            inside = sum(counts)
            for ranges, first, count in ((current[0], int(match[1]), counts[0]), (current[1], int(match[3]), counts[1])):
                if count:
                    ranges.append((first, first + count - 1))
    if current is not None:
        yield current


def read_blobs(root: Path, entries: list[tuple[str, bytes]]) -> Iterator[tuple[str, bytes]]:
    """Contents in sequence from one process, so that memory contains one file at a time."""
    if not entries:
        return
    command = make_git_command(root, ["cat-file", "--batch"])
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, env=get_git_environment()) as process:
        stdin, stdout = process.stdin, process.stdout
        assert stdin is not None and stdout is not None  # both are pipes
        for path, name in entries:
            stdin.write(name + b"\n")
            stdin.flush()
            head = stdout.readline().split()
            if len(head) != 3:
                raise InputError(f"{root}: git has not the content of {path}; the clone is partial, fetch it whole")
            size = int(head[2])
            data = stdout.read(size)
            stdout.read(1)
            if size <= _MAX_FILE:
                yield path, data
        stdin.close()


def _demand(root: Path, arguments: list[str]) -> bytes:
    answer = run_git(root, arguments)
    if answer is None:
        words = " ".join(word for word in arguments if not word.startswith("-"))
        raise InputError(f"{root}: `git {words}` failed; is the repository whole?")
    return answer
