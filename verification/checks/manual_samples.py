# SPDX-License-Identifier: Apache-2.0
"""Checks that each C++ and C sample of the manual is part of a source that the build compiles, or of a program that the consumer proof builds.

@satisfies SWR-PRF-050      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

INTEGRATION = "verification/integration/src/manual_samples.cpp"
COMPILED = (
    "examples/c_components/rtmsafety/SPEED.c",
    "examples/c_components/rtmsafety/SPEED.h",
    "examples/c_components/rtmsafety/speed.cpp",
    "examples/c_components/simple_io.c",
    "examples/c_components/simple_io.cpp",
    "examples/c_components/simple_io.h",
    "examples/minimal/main.cpp",
    "examples/tour/event_log.cpp",
    "examples/tour/fifo_ports.cpp",
    "examples/tour/fsm_component.cpp",
    "examples/tour/introspection.cpp",
    "examples/tour/recorder.cpp",
    "examples/tour/safety_module.cpp",
    "examples/tour/system_modes.cpp",
    "examples/tour/two_cores.cpp",
    "ports/conformance/tests/porting_page_test.cpp",
    "ports/lcm/tests/lcm_link_test.cpp",
    "ports/lcm/tests/lcm_page_test.cpp",
    "ports/lcm/tests/sample_types_program.cpp",
    "safety/tests/integrity_page_test.cpp",
    "safety/tests/supervision/manual_page_test.cpp",
    "tools/probe/table_dump/tests/robot_with_modes.hpp",
    "verification/e2e/tests/protected_speed.hpp",
    "verification/integration/src/lcm_replay_system.cpp",
    INTEGRATION,
)
"""Sources with samples. The build compiles each of them."""

BUILT = {"last_resort.md": "int main(", "partitions.md": "", "real_time.md": "int main(", "timing.md": "int main("}
"""Pages whose samples verification/proofs/test_consumer.py builds and runs: pages that contain this text."""

LANGUAGES = ("cpp", "c", "cmake", "text")
_CPP_LINE = re.compile(r" {4}\s*(#include |(static|constexpr|using|namespace|class|struct) .*[;{]$|.*(\)|\}| = [^;]*);( *//.*)?$)")


@dataclass(frozen=True)
class Sample:
    """One fenced block of a page; `line` is the line of its fence, from 1."""

    line: int
    language: str
    text: str


def find_samples(page: str) -> Iterator[Sample]:
    """Fenced blocks in order. A C++ block without a fence has the language "" and one line."""
    lines = page.splitlines(keepends=True)
    begin: int | None = None
    for number, line in enumerate(lines, start=1):
        if not line.startswith("```"):
            if begin is None and _CPP_LINE.match(line):
                yield Sample(number, "", line)
        elif begin is None:
            begin = number
        else:
            yield Sample(begin, lines[begin - 1][3:].strip(), "".join(lines[begin : number - 1]))
            begin = None
    if begin is not None:
        yield Sample(begin, lines[begin - 1][3:].strip(), "".join(lines[begin:]))


def check_samples(root: Path) -> Iterator[tuple[str, int, str]]:
    """File, line and message of each sample that no build compiles."""
    sources = {name: (root / name).read_text(encoding="utf-8") for name in COMPILED if (root / name).is_file()}
    for path in sorted((root / "docs" / "manual").rglob("*.md")):
        name = path.relative_to(root / "docs" / "manual").as_posix()
        for sample in find_samples(path.read_text(encoding="utf-8")):
            fault = _find_fault(sample, name, list(sources.values()))
            if fault:
                yield path.relative_to(root).as_posix(), sample.line, fault


def _find_fault(sample: Sample, page: str, sources: list[str]) -> str:
    if sample.language == "":
        return "C++ sample without a fence; begin it with ```cpp"
    if sample.language not in LANGUAGES:
        return f"language '{sample.language}' of a sample is unknown; valid: {', '.join(LANGUAGES)}"
    if sample.language not in ("cpp", "c") or (page in BUILT and BUILT[page] in sample.text):
        return ""
    shapes = (sample.text, textwrap.indent(sample.text, " " * 4))
    if any(shape in source for source in sources for shape in shapes):
        return ""
    return f"no source compiles this sample; add it to {INTEGRATION}, or correct it"
