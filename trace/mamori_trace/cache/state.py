# SPDX-License-Identifier: Apache-2.0
"""The state of files and folders, as in the index of git. If these values are equal, the content counts as unchanged.

@satisfies SWR-TRC-091      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterable

FOLDER_NAME = "trace_cache"
"""Folder of the caches, below `build`; listings omit it."""
RACY_NS = 2_000_000_000
"""A file written this shortly before a run may change again within one tick of its file system, which may be two seconds."""

_SKIPPED = {"node_modules", "__pycache__", "report"}

FileState = list[int] | None


def read_file_state(path: str) -> FileState:
    """Device, inode, mode, size, modification time and change time; None if there is no such file.

    A program cannot set the change time, so a restored file with its old modification time is detected.
    """
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    return [found.st_dev, found.st_ino, found.st_mode, found.st_size, found.st_mtime_ns, found.st_ctime_ns]


def is_racy(state: FileState, started_ns: int) -> bool:
    """Whether the file may have changed without a change of its state."""
    return state is not None and max(state[4], state[5]) > started_ns - RACY_NS


def read_listing(path: str) -> str | None:
    """Names in a folder, each with its kind; None if it cannot be listed. The kind shows a change from file to folder."""
    try:
        with os.scandir(path) as entries:
            names = sorted(_get_kind(entry) + entry.name for entry in entries if entry.name != FOLDER_NAME)
    except (OSError, ValueError):
        return None
    return "\0".join(names)


def _get_kind(entry: os.DirEntry[str]) -> str:
    """One character: folder, file, link to a folder, link to anything else."""
    letters = "LD" if entry.is_dir() else "lf"
    return letters[not entry.is_symlink()]


def list_folders(root: str) -> dict[str, str | None]:
    """Listing of each folder below `root` in which a reader may search a name, except hidden folders and build trees."""
    found: dict[str, str | None] = {}
    waiting = [os.path.abspath(root)]
    while waiting:
        folder = waiting.pop()
        listing = found[folder] = read_listing(folder)
        for name in (listing or "").split("\0"):
            if name.startswith("D") and not name.startswith((".", "build"), 1) and name[1:] not in _SKIPPED:
                waiting.append(os.path.join(folder, name[1:]))
    return found


def read_clock_ns(folder: str) -> int:
    """The earlier of two times: the clock of the file system of `folder` and the system clock. Raises OSError."""
    path = os.path.join(folder, f".clock.{os.getpid()}")
    descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
    try:
        return min(os.fstat(descriptor).st_mtime_ns, time.time_ns())
    finally:
        os.close(descriptor)
        os.unlink(path)


def read_tool_state(folders: Iterable[str]) -> dict[str, FileState]:
    """State of each file of the tool itself, so that a new version never repeats an outcome of an old one."""
    found: dict[str, FileState] = {}
    for top in folders:
        for folder, names, files in os.walk(top):
            names[:] = [name for name in names if name not in ("__pycache__", "tests")]
            for name in files:
                path = os.path.join(folder, name)
                found[path] = read_file_state(path)
    return found
