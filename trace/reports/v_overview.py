# SPDX-License-Identifier: Apache-2.0
"""Lays out the V: needs down to code on the left, unit tests up to the campaign on the right.

@satisfies SWR-TRC-011      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from mamori.trace.model.evidence import CAMPAIGN, FAILED, INTEGRATION, PASSED, SKIPPED, UNIT
from mamori.trace.model.project import Project
from mamori.trace.model.verdict import WORST_FIRST, Verdict

BOX_HEIGHT = 92
HEIGHT = 478
_STEP_Y = 124
_TOP = 4


@dataclass(frozen=True, slots=True)
class Layout:
    """Widths of a drawing, in its own units. `step_x` moves each row inwards, which makes the V."""

    css: str
    width: int
    box_width: int
    step_x: int

    @property
    def bar_width(self) -> int:
        return self.box_width - 28


LAYOUTS = (Layout("wide", 960, 250, 58), Layout("narrow", 372, 180, 0))


@dataclass(frozen=True, slots=True)
class Segment:
    """A piece of a box's bar; `x` and `width` in drawing units."""

    css: str
    x: float
    width: float


@dataclass(frozen=True, slots=True)
class Box:
    """One station of the V. `target` is where a click leads to, with the filters that belong to it."""

    name: str
    count: str
    detail: str
    x: int
    y: int
    target: str
    segments: tuple[Segment, ...]


def make_boxes(project: Project, verdicts: dict[str, Verdict], layout: Layout) -> list[Box]:
    """Boxes row by row; left and right box of a row show the same height of the V."""
    results = {kind: [result.status for result in project.results if result.kind == kind] for kind in (UNIT, INTEGRATION)}
    # A failing or left-over campaign result counts with the cases only where there are no cases to count.
    cases = [PASSED if case.passed else FAILED for case in project.evidence.cases]
    cases = cases or [result.status for result in project.results if result.kind == CAMPAIGN]
    files = len({tag.place.file for tag in project.tags})
    left = (("Needs and hazards", ("STK", "HAZ")), ("System requirements", ("SYS", "AOU")), ("Software requirements", ("SWR",)))
    right = (("Fault campaign", cases, "cases", "#campaign"), ("Integration tests", results[INTEGRATION], "tests", "#tests?kind=integration"),
             ("Unit tests", results[UNIT], "tests", "#tests?kind=unit"))  # fmt: skip
    boxes: list[Box] = []
    for row, ((name, levels), (test_name, statuses, noun, target)) in enumerate(zip(left, right)):
        y = _TOP + row * _STEP_Y
        x = row * layout.step_x
        words = [verdict.word for key, verdict in verdicts.items() if project.items[key].level in levels]
        bar = _make_segments(words, reversed(WORST_FIRST), x, layout)
        detail = _describe(words, WORST_FIRST, "verified")
        boxes.append(Box(name, str(len(words)), detail, x, y, "#matrix?" + "&".join(f"level={level}" for level in levels), bar))
        x = layout.width - layout.box_width - x
        words = [FAILED if status not in (PASSED, SKIPPED) else status for status in statuses]
        bar = _make_segments(words, (PASSED, SKIPPED, FAILED), x, layout)
        detail = _describe(words, (FAILED, SKIPPED), "passed") if words else f"no {noun} run"
        boxes.append(Box(test_name, str(len(words)), detail, x, y, target, bar))
    detail = f"tags in {files} file{'' if files == 1 else 's'}"
    boxes.append(Box("Code", str(len(project.tags)), detail, (layout.width - layout.box_width) // 2, _TOP + 3 * _STEP_Y, "#code", ()))
    return boxes


def _describe(words: list[str], worst_first: Iterable[str], good: str) -> str:
    counts = Counter(words)
    bad = [f"{counts[word]} {word}" for word in worst_first if counts[word] and word != good]
    return ", ".join(bad[:2]) if bad else f"all {good}" if words else "none"


def _make_segments(words: list[str], order: Iterable[str], x: int, layout: Layout) -> tuple[Segment, ...]:
    counts = Counter(words)
    segments: list[Segment] = []
    at = float(x + (layout.box_width - layout.bar_width) / 2)
    for word in order:
        if counts[word]:
            width = round(layout.bar_width * counts[word] / len(words), 2)
            segments.append(Segment(word.replace(" ", "-"), round(at, 2), width))
            at += width
    return tuple(segments)
