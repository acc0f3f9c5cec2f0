# SPDX-License-Identifier: Apache-2.0
# Goal: safety documents name existing ids and tests; the documents of this project are complete and agree with the items.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Outcome, Sample

from mamori_trace.checks import document_link
from mamori_trace.readers.cpp_tests import read_cpp_tests
from mamori_trace.readers.project import read_requirements
from mamori_trace.readers.python_sources import read_python
from mamori_trace.reports.query import format_markdown

ROOT = Path(__file__).parents[2]
FOLDER = "docs/manual/safety"
DOCUMENTS = ("README.md", "safety_plan.md", "verification_plan.md", "techniques.md", "safety_manual.md", "fmea.md", "limits.md", "tool_confidence.md")


@pytest.fixture
def write(sample: Sample) -> Callable[[str], None]:
    (sample.root / FOLDER).mkdir(parents=True)

    def run(text: str) -> None:
        (sample.root / FOLDER / "plan.md").write_bytes(text.encode("latin-1"))

    return run


def list_messages(outcome: Outcome) -> list[tuple[str, str]]:
    return [(f"{row['file']}:{row['line']}", row["message"]) for row in outcome.content["findings"]]


@pytest.mark.verifies("SWR-TRC-082", technique="requirements_based", polarity="nominal")
def test_what_exists_may_be_named(sample: Sample, trace: Callable, write: Callable) -> None:
    write("# SYS-001\n\n`SWR-SUP-001`, HAZ-001: test_offline.py::test_no_connection; SIL-3, SWR-SUP, ISO-8601, XSWR-SUP-909\n")

    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("See SYS-009.", "names SYS-009, which nothing defines"),
        ("See SYS-01.", "nearest: SYS-001"),
        ("See `SWR-OLD-001`.", "SWR-OLD-001"),
        ("| a | SWR-SUP-0011 |", "SWR-SUP-0011"),
        ("test_offline.py::test_no_connectoin", "nearest: test_no_connection"),
        ("test_other.py::test_no_connection", "test_other.py::test_no_connection"),
        ("\xff", "UTF-8"),
    ],
)
@pytest.mark.verifies("SWR-TRC-082", technique="fault_injection", polarity="violation")
def test_what_does_not_exist_is_told_with_its_line(sample: Sample, trace: Callable, write: Callable, text: str, word: str) -> None:
    write(f"# Plan\n\n{text}\n")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    [(place, message)] = list_messages(outcome)
    assert (outcome.status, place) == (1, f"{FOLDER}/plan.md:3")
    assert word in message


@pytest.mark.verifies("SWR-TRC-082", technique="fault_injection", polarity="violation")
def test_a_retired_id_may_not_be_named(sample: Sample, trace: Callable, write: Callable) -> None:
    write("# Plan\n\nSYS-003\n")
    text = (sample.root / "requirements/system/system.md").read_text()
    head, _, tail = text.rpartition("- Status: approved")
    (sample.root / "requirements/system/system.md").write_text(f"{head}- Status: retired{tail}")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert any("names SYS-003, which is retired" in message for _, message in list_messages(outcome))


@pytest.mark.verifies("SWR-TRC-082", technique="requirements_based", polarity="nominal")
def test_the_documents_of_this_project_name_what_exists() -> None:
    project = read_requirements(ROOT)
    project.tests = read_cpp_tests(ROOT, []) + read_python(ROOT, [])[1]

    assert sorted(path.name for path in (ROOT / FOLDER).glob("*.md")) == sorted(DOCUMENTS)
    assert list(document_link.check(project)) == []
    index = (ROOT / FOLDER / "README.md").read_text(encoding="utf-8")
    assert [name for name in DOCUMENTS if name != "README.md" and f"({name})" not in index] == []


@pytest.mark.verifies("SWR-TRC-082", technique="back_to_back", polarity="nominal")
def test_the_safety_manual_holds_the_assumptions_as_the_items_have_them() -> None:
    project = read_requirements(ROOT)
    items = [item for item in project.live_items if item.level == "AOU"]

    assert format_markdown(items) in (ROOT / FOLDER / "safety_manual.md").read_text(encoding="utf-8")


@pytest.mark.verifies("SWR-TRC-082", technique="requirements_based", polarity="nominal")
def test_each_row_of_the_tool_confidence_names_a_test_and_a_requirement() -> None:
    text = (ROOT / FOLDER / "tool_confidence.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("|") and not line.startswith(("|--", "| what"))]

    assert len(rows) >= 20
    assert [row for row in rows if ".py::test_" not in row or "SWR-TRC-" not in row] == []
