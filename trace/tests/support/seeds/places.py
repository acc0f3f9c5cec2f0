# SPDX-License-Identifier: Apache-2.0
"""Locations of the parts of the sample project, for the seeded faults."""

from __future__ import annotations

from trace_sample import Sample

SOFTWARE = "requirements/software/software.md"
SYSTEM = "requirements/system/system.md"
HEADER = "safety/include/alive.hpp"
EVIDENCE = "build/host-release/evidence"
GTEST = f"{EVIDENCE}/junit/safety.xml"

Seed = tuple[str, str, int]
"""Text that the finding must name, its file, its line."""


def find_line(s: Sample, file: str, text: str, after: str = "") -> int:
    content = (s.root / file).read_text()
    return content[: content.index(text, content.index(after))].count("\n") + 1
