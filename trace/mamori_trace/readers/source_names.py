# SPDX-License-Identifier: Apache-2.0
"""Finds the project file that evidence of another host names by a different path."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path, PurePosixPath


class SourceNames:
    """The files of the project. Evidence of another checkout has other folders, so the longest known suffix of a path determines the
    file."""

    def __init__(self, root: Path, known: Iterable[str]) -> None:
        self._root = root.resolve().as_posix()
        self._known = frozenset(known)
        self._found: dict[str, str] = {}

    def find(self, path: str) -> str:
        """The name of the file in findings, or nothing for a file outside the project."""
        if path not in self._found:
            self._found[path] = self._search(path.replace("\\", "/"))
        return self._found[path]

    def _search(self, path: str) -> str:
        if path.startswith(f"{self._root}/"):
            inner = path[len(self._root) + 1 :]
            return inner if inner in self._known else ""
        parts = [part for part in PurePosixPath(path).parts if part not in ("/", ".")]
        ends = ("/".join(parts[start:]) for start in range(len(parts)))
        return next((end for end in ends if end in self._known), "")

    def find_any(self, path: str) -> str:
        """Like `find`, for every existing file, including files without code: at least the folder must match."""
        found = self.find(path)
        if found or not path:
            return found
        plain = path.replace("\\", "/")
        inner = plain.removeprefix(f"{self._root}/")
        parts = [part for part in PurePosixPath(inner).parts if part not in ("/", ".")]
        if ".." in parts:
            return ""
        ends = ["/".join(parts[start:]) for start in range(max(1, len(parts) - 1))]
        return next((end for end in ends if (Path(self._root) / end).is_file()), "")
