# SPDX-License-Identifier: Apache-2.0
"""Files during writing, with the line of each part of each requirement."""

from __future__ import annotations

from pathlib import Path


class Pages:
    """Lines of files by name. For a part that is written twice, the last line counts."""

    def __init__(self) -> None:
        self.files: dict[str, list[str]] = {}
        self.places: dict[tuple[str, str], tuple[str, int]] = {}

    def add(self, file: str, line: str, *parts: tuple[str, str]) -> None:
        """Adds one line; `parts` are the (id, part) pairs in this line."""
        lines = self.files.setdefault(file, [])
        lines.append(line)
        for part in parts:
            self.places[part] = (file, len(lines))

    def find(self, requirement: str, *parts: str) -> tuple[str, int]:
        """The location of the first of `parts` that the format writes."""
        return next(self.places[(requirement, part)] for part in parts if (requirement, part) in self.places)

    def write(self, root: Path) -> None:
        for name, lines in self.files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("\n".join(lines) + "\n", encoding="utf-8")
