# SPDX-License-Identifier: Apache-2.0
# Goal: the page shows the counts with all marks and findings; an invalid record does not affect the other records.
from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sample_records import COST
from trace_sample import COMMIT, ENVIRONMENT, Sample


@pytest.fixture
def folder(sample: Sample) -> Path:
    """The location of one count."""
    path = sample.evidence / "cost" / "safe_arm"
    path.mkdir(parents=True)
    return path


@pytest.fixture
def report(sample: Sample, trace: Callable, folder: Path) -> Callable[..., tuple[str, Any]]:
    """Stores a record or a text and writes the report. Returns the section "Timing" and the outcome."""

    def run(record: object = COST) -> tuple[str, Any]:
        (folder / "cost.json").write_text(record if isinstance(record, str) else json.dumps(record), encoding="utf-8")
        outcome = trace("report", "--root", sample.root, "--output", "json")
        page = (sample.root / "report" / "index.html").read_text(encoding="utf-8")
        section = page[page.index('<section id="timing"') : page.index('<section id="matrix"')]
        return re.sub(' data-head="[^"]*"', "", section), outcome

    return run


@pytest.mark.verifies("SWR-TIM-034")
def test_the_page_shows_counts_limits_ratio_and_assumption(report: Callable) -> None:
    section, outcome = report()

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    for part in (
        "Cost of components, counted", "limits kept", "GNU 12.2.0 -O2, glibc 2.36", "1.72 ns, the worst (channel); least 0.22 ns",
        "0.257 ns each of 32776 instructions", "50 % of the measured maximum", "Assumption: no model of caches.",
        ">4961<", ">8.53<", ">12.8<", ">237.2<", ">kept<", "safety_supervisor",  # limits
        ">539<", ">545<", ">551<", ">552<", ">152<", ">0.94<", ">0.37 %<",  # steps
        "1.720", "3.715", "the arm ended in state Operational",  # folded
    ):  # fmt: skip
        assert part in section, part
    assert "finding" not in section


@pytest.mark.verifies("SWR-TIM-034")
def test_classes_of_one_component_stand_together(report: Callable) -> None:
    section, _ = report()

    steps = section[section.index("Instructions of a single step") :]
    assert steps.index(">551<") < steps.index(">552<") < steps.index(">channel<")


@pytest.mark.verifies("SWR-TIM-034", technique="fault_injection", polarity="violation")
def test_findings_marks_and_other_commits_stand_at_the_top(report: Callable) -> None:
    record = copy.deepcopy(COST)
    record.update(exit_status=1, marks=["TIMES WITHOUT REAL-TIME PRIVILEGES"], findings=["window 'protect': budget <8 us", "another"])
    record["limits"][0].update(left_ns=-4800.0, is_kept=False)
    record["environment"] = ENVIRONMENT | {"commit": COMMIT[::-1]}

    section, outcome = report(record)

    assert outcome.status == 0
    for part in ('<span class="badge failed">2 findings</span>', '<p class="mark">TIMES WITHOUT REAL-TIME PRIVILEGES</p>', "budget &lt;8 us",
                 "of another commit", '<td class="num bad">−4.80</td>', "bad\">too low</td>"):  # fmt: skip
        assert part in section, part
    assert section.index("another") < section.index("Budgets and declared")


@pytest.mark.parametrize(("change", "complaint"), [
    (lambda record: record.pop("pace"), "pace is missing; count again"),
    (lambda record: record["steps"][0]["instructions"].update(max="many"), "steps[0].instructions.max is not an integer"),
    (lambda record: record["limits"][0].update(is_kept=1), "limits[0].is_kept is no truth value"),
    (lambda record: record.update(schema="mamori.cost/2"), "this tool reads 'mamori.cost/1'"),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-034", technique="equivalence_classes", polarity="violation")
def test_record_that_is_not_in_order_is_one_problem_and_hides_nothing_else(report: Callable, change: Callable, complaint: str) -> None:
    record = copy.deepcopy(COST)
    change(record)

    section, outcome = report(record)

    (finding,) = outcome.content["findings"]
    assert complaint in finding["message"]
    assert "Cost of components" not in section
    assert "No system was measured in real time" in section


@pytest.mark.verifies("SWR-TIM-034", technique="error_guessing", polarity="violation")
def test_record_that_is_cut_off_is_a_problem(report: Callable) -> None:
    _, outcome = report(json.dumps(COST)[:-20])

    (finding,) = outcome.content["findings"]
    assert "is not whole JSON" in finding["message"]
