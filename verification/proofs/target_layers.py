# SPDX-License-Identifier: Apache-2.0
"""The layers that run on a bare controller: those with TARGET_SUBSET in their CMakeLists.txt."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

SUBSET = re.compile(r"mamori_library\s*\(\s*(\w+)\s+TARGET_SUBSET\b")


@dataclass(frozen=True)
class TargetLayer:
    """A layer of the target subset."""

    name: str
    folder: Path

    @property
    def include(self) -> Path:
        return self.folder / "include"

    def sources(self) -> list[Path]:
        return sorted((self.folder / "src").rglob("*.cpp"))

    def headers(self) -> list[Path]:
        return sorted(self.include.rglob("*.hpp"))

    def library(self, root: Path, build: Path) -> Path:
        return build / self.folder.relative_to(root) / f"libmamori_{self.name}.a"


def find_target_layers(root: Path) -> list[TargetLayer]:
    """All layers of the target subset below `root`."""
    layers = []
    for folder in ("kernel", "safety", "ports"):
        for path in sorted((root / folder).rglob("CMakeLists.txt")):
            layers += [TargetLayer(name, path.parent) for name in SUBSET.findall(path.read_text(encoding="utf-8"))]
    return layers
