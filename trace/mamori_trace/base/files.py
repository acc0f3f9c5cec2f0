# SPDX-License-Identifier: Apache-2.0
"""File access for all readers: paths as findings show them, text with invalid encoding, the source tree.

A path that cannot be opened or listed is a problem, not an absence: an unreadable folder must not count as empty.

@satisfies SWR-TRC-009      Design: docs/design/trace.md#input-errors
"""

from __future__ import annotations

import fnmatch
import os
from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.system_error import explain

UNREADABLE = "unreadable-input"
_SKIPPED_FOLDERS = {"build", "report", "requirements", "docs", "node_modules", "__pycache__"}


def get_shown_path(path: Path, root: Path) -> str:
    """`path` relative to the project root; the full path if it is outside."""
    try:
        lost = path.is_symlink() and not path.exists()  # the user can correct the link, not its target
        whole = path.parent.resolve() / path.name if lost else path.resolve()
        return whole.relative_to(root.resolve()).as_posix()
    except (OSError, RuntimeError):  # a cycle of links, or a name that is too long
        return os.path.relpath(path, root).replace(os.sep, "/")
    except ValueError:
        return path.as_posix()


def read_text(path: Path, shown: str, problems: list[Problem]) -> str:
    """Text of a UTF-8 file. Invalid bytes and an unreadable file become problems; invalid bytes are read as U+FFFD."""
    try:
        if not path.is_file() and path.exists():  # reading a pipe would never end
            raise OSError("it is no file; put one in its place")
        data = path.read_bytes()
    except OSError as error:
        note_unreadable(error, shown, problems)
        return ""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        problems.append(
            Problem(UNREADABLE, Place(shown, line), f"byte 0x{data[error.start]:02x} is not UTF-8; save the file as UTF-8")
        )
        return data.decode("utf-8", errors="replace")


def note_unreadable(error: OSError, shown: str, problems: list[Problem]) -> None:
    """Reports one problem for a file or folder, even if it is read several times."""
    problem = Problem(UNREADABLE, Place(shown, 1), f"cannot be read: {explain(error)}")
    if problem not in problems:
        problems.append(problem)


def walk_folders(top: Path, root: Path, problems: list[Problem]) -> Iterator[tuple[str, list[str], list[str]]]:
    """Like os.walk, but does not follow links to folders; a folder that cannot be listed is a problem."""
    return os.walk(top, onerror=lambda error: note_unreadable(error, get_shown_path(Path(error.filename), root), problems))


def walk_whole(top: Path) -> Iterator[tuple[str, list[str], list[str]]]:
    """Like `walk_folders`, for callers that need the complete tree: raises OSError if a folder cannot be listed."""
    return os.walk(top, onerror=_raise)


def _raise(error: OSError) -> None:
    raise error


def list_paths(folder: Path, pattern: str, root: Path, problems: list[Problem]) -> list[Path]:
    """Like Path.glob, sorted, for names and stars between slashes. A missing folder gives no paths; an unlistable one is a problem."""
    found = [folder]
    for part in pattern.split("/"):
        found = [each / name for each in found for name in _list_names(each, root, problems) if fnmatch.fnmatchcase(name, part)]
    return sorted(found)


def _list_names(folder: Path, root: Path, problems: list[Problem]) -> list[str]:
    try:
        return os.listdir(folder)
    except (FileNotFoundError, NotADirectoryError):
        return []
    except OSError as error:
        note_unreadable(error, get_shown_path(folder, root), problems)
        return []


def walk_sources(root: Path, suffixes: tuple[str, ...], problems: list[Problem]) -> Iterator[tuple[Path, str]]:
    """Source files below `root` with one of `suffixes`, each with its displayed path, sorted by path.

    Excludes hidden folders, build trees, requirements, documents and reports.
    """
    for folder, folders, files in walk_folders(root, root, problems):
        kept = (name for name in folders if name not in _SKIPPED_FOLDERS and not name.startswith((".", "build")))
        folders[:] = sorted(name for name in kept if not name.endswith(".egg-info"))
        relative = os.path.relpath(folder, root).replace(os.sep, "/")
        prefix = "" if relative == "." else relative + "/"
        for name in sorted(files):
            if name.endswith(suffixes):
                yield Path(folder) / name, prefix + name


def is_test_file(shown: str) -> bool:
    """Whether a source file contains tests: it is in a test folder or has the name of a test."""
    *folders, name = shown.split("/")
    if "tests" in folders or "test" in folders or name.startswith("test_"):
        return True
    return name.rpartition(".")[0].endswith(("_test", "_tests", "Test", "Tests"))
