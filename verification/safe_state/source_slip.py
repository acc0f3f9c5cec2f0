# SPDX-License-Identifier: Apache-2.0
"""A slip that is put into a copy of a C++ source, for the tests that demand of the provers to find it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Slip:
    """`right` stands once in `file` and becomes `wrong`; the properties `broken` are refuted then."""

    file: str
    right: str
    wrong: str
    broken: tuple[str, ...]

    def put_into(self, folder: Path) -> None:
        """@param folder copy of the sources, in which `file` is found."""
        path = folder / self.file
        text = path.read_text(encoding="utf-8")
        assert text.count(self.right) == 1, "the source has changed; adapt the slip"
        path.write_text(text.replace(self.right, self.wrong), encoding="utf-8")
