# SPDX-License-Identifier: Apache-2.0
# Goal: item blocks are read part by part with their lines; every deviation from the format is reported at its location.
from __future__ import annotations

from pathlib import Path

import pytest
from trace_sample import SCHEMA, format_item

from mamori_trace.base.finding import Problem
from mamori_trace.model.item import Item
from mamori_trace.readers.headings import list_anchors
from mamori_trace.readers.markdown_items import parse_items
from mamori_trace.readers.schema import read_schema

GOOD = format_item("SWR-ABC-001", "Title", "The tool shall work.", Parents="SYS-001, HAZ-002", Polarity="nominal, violation")


def parse(text: str) -> tuple[list[Item], list[Problem]]:
    problems: list[Problem] = []
    return parse_items(text, "a.md", read_schema(SCHEMA.parents[2]), problems), problems


@pytest.mark.verifies("SWR-TRC-001", technique="requirements_based", polarity="nominal")
def test_each_part_of_a_block_is_read_with_its_line() -> None:
    items, problems = parse("# Area\n\nProse.\n\n" + GOOD)

    assert problems == []
    item = items[0]
    assert (item.id, item.title, item.statement, item.level) == ("SWR-ABC-001", "Title", "The tool shall work.", "SWR")
    assert (item.parents, item.polarity, item.status) == (("SYS-001", "HAZ-002"), ("nominal", "violation"), "approved")
    assert (item.place.line, item.statement_line, item.lines["Parents"], item.lines["Status"]) == (5, 7, 10, 15)


@pytest.mark.verifies("SWR-TRC-001", technique="equivalence_classes", polarity="nominal")
def test_statement_and_rationale_may_go_on_in_the_next_line() -> None:
    text = GOOD.replace("The tool shall work.", "The tool\nshall work.").replace("It is needed.", "It is\n  needed.")

    items, problems = parse(text)

    assert problems == []
    assert (items[0].statement, items[0].rationale) == ("The tool shall work.", "It is needed.")


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("## SWR-ABC-001 Title", "## SWR-ABC-1 Title", 1, "SWR-ABC-1"),
        ("## SWR-ABC-001 Title", "## SWR-ABC-001", 1, "no title"),
        ("The tool shall work.\n\n", "", 1, "no statement"),
        ("The tool shall work.", "The tool shall work.\n\nMore.", 5, "second paragraph"),
        ("The tool shall work.", "```\nThe tool shall work.", 3, "plain text"),
        ("- SIL: 2\n", "", 1, "lacks SIL"),
        ("- SIL: 2\n", "- SIL: 5\n", 7, "'5' is not one of"),
        ("- SIL: 2\n", "- SIL:\n", 7, "SIL is empty"),
        ("- SIL: 2\n", "- SIL: 2\n- SIL: 2\n", 8, "given twice"),
        ("- SIL: 2\n", "- Sil: 2\n", 7, "unknown attribute 'Sil'"),
        ("- Verify: test\n", "- Verify: tests\n", 8, "'tests' is not one of"),
        ("- Parents: SYS-001, HAZ-002", "- Parents: SYS-001, HAZ2", 6, "'HAZ2' is not an id"),
        ("- Design: -\n- Status: approved", "- Status: approved\n- Design: -", 11, "out of order"),
        ("- Status: approved", "- Status: approved\n\nAfterwards.", 13, "text after the attributes"),
        ("- Design: -", "- Design: -\n  more", 11, "second line"),
    ],
)
@pytest.mark.verifies("SWR-TRC-001", technique="error_guessing", polarity="violation")
def test_each_departure_from_the_format_is_told_at_its_line(old: str, new: str, line: int, message: str) -> None:
    assert GOOD.count(old) == 1

    _, problems = parse(GOOD.replace(old, new))

    assert [problem.rule for problem in problems] == ["malformed-item"] * len(problems)
    assert any(problem.place.line == line and message in problem.message for problem in problems), problems


@pytest.mark.verifies("SWR-TRC-001", technique="error_guessing", polarity="violation")
def test_a_broken_block_does_not_spoil_the_next_one() -> None:
    items, problems = parse(GOOD.replace("- SIL: 2", "- SIL: high") + GOOD.replace("001 T", "002 T"))

    assert [(item.id, item.whole) for item in items] == [("SWR-ABC-001", False), ("SWR-ABC-002", True)]
    assert len(problems) == 1


@pytest.mark.verifies("SWR-TRC-001", technique="equivalence_classes", polarity="nominal")
def test_anchors_are_spelled_as_forges_spell_them() -> None:
    text = "# A: b & c\n## Same\n## Same\n```\n# not a heading\n```\n### `code` and [link](x.md) ##\n"

    assert list_anchors(text) == ["a-b--c", "same", "same-1", "code-and-link"]


@pytest.mark.verifies("SWR-TRC-001", technique="requirements_based", polarity="nominal")
def test_the_items_of_this_project_keep_to_the_format() -> None:
    root = Path(__file__).parents[2]
    problems: list[Problem] = []
    files = sorted((root / "requirements").glob("*/*.md"))

    items = [item for path in files for item in parse_items(path.read_text(), path.name, read_schema(root), problems)]

    assert problems == []
    assert len(items) >= 44
