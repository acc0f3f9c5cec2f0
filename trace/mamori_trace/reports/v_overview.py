# SPDX-License-Identifier: Apache-2.0
"""Layout of the V: from needs to code on the left, from unit tests to the campaign on the right.

@satisfies SWR-TRC-011      Design: docs/design/trace.md#report
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from mamori_trace.model.evidence import CAMPAIGN, FAILED, INTEGRATION, NOT_SHOWN, PASSED, SKIPPED, UNBOUND, UNIT
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import WORST_FIRST, Verdict

BOX_HEIGHT = 106
_GOOD_FIRST = (PASSED, NOT_SHOWN, UNBOUND, SKIPPED, FAILED)
HEIGHT = 522
_STEP_Y = 136
_TOP = 4
_SEGMENT_MIN = 4.0
"""Minimum width of a segment of a bar, in drawing units, so that it is visible."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Widths of a drawing, in its own units. `step_x` moves each row inwards, which forms the V.

    `detail_letters` is the capacity of the last line of a box, in characters.
    """

    css: str
    width: int
    box_width: int
    step_x: int
    detail_letters: int

    @property
    def bar_width(self) -> int:
        return self.box_width - 28


LAYOUTS = (Layout("wide", 960, 250, 58, 24), Layout("narrow", 372, 180, 0, 20))


@dataclass(frozen=True, slots=True)
class Segment:
    """A segment of the bar of a box; `x` and `width` in drawing units."""

    css: str
    x: float
    width: float


@dataclass(frozen=True, slots=True)
class Box:
    """One station of the V. `target` is the view that a click opens, with its filters."""

    name: str
    count: str
    detail: str
    x: int
    y: int
    target: str
    segments: tuple[Segment, ...]


def make_boxes(project: Project, verdicts: dict[str, Verdict], layout: Layout) -> list[Box]:
    """Boxes row by row; left and right box of a row are at the same height of the V."""
    results = {kind: [result.status for result in project.results if result.kind == kind] for kind in (UNIT, INTEGRATION)}
    # Failed or other remaining campaign results count with the cases only if there are no cases.
    cases = [case.status for case in project.evidence.cases]
    cases = cases or [result.status for result in project.results if result.kind == CAMPAIGN]
    files = len({tag.place.file for tag in project.tags})
    system = "System, assumptions" if any(item.level == "AOU" for item in project.items.values()) else "System requirements"
    left = (("Needs and hazards", ("STK", "HAZ", "SG")), (system, ("SYS", "AOU", "ARC")), ("Software requirements", ("SWR",)))
    right = (("Fault campaign", cases, "cases", "#campaign"), ("Integration tests", results[INTEGRATION], "tests", "#tests?kind=integration"),
             ("Unit tests", results[UNIT], "tests", "#tests?kind=unit"))  # fmt: skip
    boxes: list[Box] = []
    for row, ((name, levels), (test_name, statuses, noun, target)) in enumerate(zip(left, right, strict=True)):
        y = _TOP + row * _STEP_Y
        x = row * layout.step_x
        words = [verdict.word for key, verdict in verdicts.items() if project.items[key].level in levels]
        bar = _make_segments(words, reversed(WORST_FIRST), x, layout)
        detail = _describe(words, WORST_FIRST, "verified", layout)
        boxes.append(Box(name, f"{len(words):,}", detail, x, y, "#matrix?" + "&".join(f"level={level}" for level in levels), bar))
        x = layout.width - layout.box_width - x
        words = [status if status in _GOOD_FIRST else FAILED for status in statuses]
        bar = _make_segments(words, _GOOD_FIRST, x, layout)
        detail = _describe(words, reversed(_GOOD_FIRST), "passed", layout) if words else f"no {noun} run"
        boxes.append(Box(test_name, f"{len(words):,}", detail, x, y, target, bar))
    detail = f"tags in {files:,} file{'' if files == 1 else 's'}"
    boxes.append(Box("Code", f"{len(project.tags):,}", detail, (layout.width - layout.box_width) // 2, _TOP + 3 * _STEP_Y, "#code", ()))
    return boxes


def _describe(words: list[str], worst_first: Iterable[str], good: str, layout: Layout) -> str:
    """The two worst lines, or only the worst if there is no space for both."""
    counts = Counter(words)
    bad = [f"{counts[word]:,} {word}" for word in worst_first if counts[word] and word != good]
    if not bad:
        return f"all {good}" if words else "none"
    both = ", ".join(bad[:2])
    return both if len(both) <= layout.detail_letters else bad[0]


def _make_segments(words: list[str], order: Iterable[str], x: int, layout: Layout) -> tuple[Segment, ...]:
    counts = Counter(words)
    present = [word for word in order if counts[word]]
    # One failure among thousands would be too narrow to see. It gets a minimum width, taken from the longer segments.
    lengths = [max(_SEGMENT_MIN, layout.bar_width * counts[word] / len(words)) for word in present]
    excess = sum(lengths) - layout.bar_width
    spare = sum(length - _SEGMENT_MIN for length in lengths)
    segments: list[Segment] = []
    at = float(x + (layout.box_width - layout.bar_width) / 2)
    for word, length in zip(present, lengths, strict=True):
        width = length - (excess * (length - _SEGMENT_MIN) / spare if spare else 0.0)
        segments.append(Segment(word.replace(" ", "-"), round(at, 2), round(width, 2)))
        at += width
    return tuple(segments)
