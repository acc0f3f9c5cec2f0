# SPDX-License-Identifier: Apache-2.0
# Goal: executed results determine the verdict, worst first; a test that did not run never leaves an item green.
from __future__ import annotations

import json
import shutil
from collections.abc import Callable

import pytest
from trace_sample import Sample

SOFTWARE = "requirements/software/software.md"
SYSTEM = "requirements/system/system.md"
GTEST = "build/host-release/evidence/junit/safety.xml"
SILENT = '<testcase name="SilenceIsReported"'


def give_outcome(s: Sample, element: str) -> None:
    text = (s.root / GTEST).read_text()
    at = text.index(">", text.index(SILENT)) + 1
    (s.root / GTEST).write_text(text[:at] + element + text[at:])


def judge(trace: Callable, s: Sample, *ids: str, options: tuple[str, ...] = ()) -> list[str]:
    outcome = trace("check", "--root", s.root, "--output", "json", *options)
    return [outcome.get_verdict(item) for item in ids]


@pytest.mark.verifies("SWR-TRC-006", technique="requirements_based", polarity="nominal")
def test_an_item_is_verified_when_everything_demanded_passed(sample: Sample, trace: Callable) -> None:
    assert judge(trace, sample, "SWR-SUP-001", "SWR-TLS-001", "SYS-002") == ["verified"] * 3


@pytest.mark.parametrize(
    ("element", "verdict"),
    [("<failure/>", "failed"), ('<error message="crash"/>', "failed"), ("<skipped/>", "incomplete")],
)
@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_one_bad_result_beside_good_ones_is_enough(sample: Sample, trace: Callable, element: str, verdict: str) -> None:
    give_outcome(sample, element)

    assert judge(trace, sample, "SWR-SUP-001", "SWR-SUP-002") == [verdict, "verified"]


@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_a_test_without_result_leaves_its_item_incomplete(sample: Sample, trace: Callable) -> None:
    sample.replace(GTEST, "SilenceIsNotHealedByOneReport", "SomethingElse")

    assert judge(trace, sample, "SWR-SUP-001") == ["incomplete"]


@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_no_results_at_all_leave_everything_incomplete(sample: Sample, trace: Callable) -> None:
    shutil.rmtree(sample.evidence / "junit")
    shutil.rmtree(sample.evidence / "campaign")

    verdicts = judge(trace, sample, "SWR-SUP-001", "SWR-TLS-001", "SYS-001", "SYS-002", "HAZ-001", "STK-001")

    assert verdicts == ["incomplete"] * 6


@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_a_missing_violation_test_leaves_its_item_incomplete(sample: Sample, trace: Callable) -> None:
    sample.replace("safety/tests/alive_test.cpp", "Polarity::kViolation", "Polarity::kNominal")
    sample.replace(GTEST, 'value="violation"', 'value="nominal"')

    assert judge(trace, sample, "SWR-SUP-001") == ["incomplete"]


@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_no_code_leaves_a_software_item_incomplete(sample: Sample, trace: Callable) -> None:
    sample.replace("safety/include/alive.hpp", "/// @satisfies SWR-SUP-002\n", "")

    assert judge(trace, sample, "SWR-SUP-002") == ["incomplete"]


@pytest.mark.verifies("SWR-TRC-006", technique="fault_injection", polarity="violation")
def test_a_campaign_told_twice_is_believed_where_it_is_worse(sample: Sample, trace: Callable) -> None:
    case = '<testcase classname="encoder_freeze" name="encoder_freeze-1[SYS-002]"><failure message="drift"/><properties>'
    rows = '<property name="requirement" value="SYS-002"/><property name="polarity" value="violation"/></properties></testcase>'
    (sample.evidence / "junit" / "campaign.xml").write_text(f"<testsuites><testsuite>{case}{rows}</testsuite></testsuites>")

    assert judge(trace, sample, "SYS-002") == ["failed"]


@pytest.mark.verifies("SWR-TRC-007", technique="requirements_based", polarity="nominal")
def test_verified_children_verify_what_they_refine(sample: Sample, trace: Callable) -> None:
    assert judge(trace, sample, "SYS-001", "SYS-003", "HAZ-001", "STK-001") == ["verified"] * 4


@pytest.mark.verifies("SWR-TRC-007", technique="fault_injection", polarity="violation")
def test_a_failure_climbs_to_the_hazard(sample: Sample, trace: Callable) -> None:
    give_outcome(sample, "<failure/>")

    assert judge(trace, sample, "SYS-001", "HAZ-001", "STK-001", "SYS-003") == ["failed", "failed", "failed", "verified"]


@pytest.mark.verifies("SWR-TRC-007", technique="fault_injection", polarity="violation")
def test_a_draft_child_does_not_verify_its_parent(sample: Sample, trace: Callable) -> None:
    text = (sample.root / SOFTWARE).read_text()
    head, _, tail = text.rpartition("- Status: approved")
    (sample.root / SOFTWARE).write_text(head + "- Status: draft" + tail)

    assert judge(trace, sample, "SWR-TLS-001", "SYS-003") == ["draft", "incomplete"]


@pytest.mark.verifies("SWR-TRC-007", technique="boundary_values", polarity="violation")
def test_children_that_show_one_side_do_not_verify_a_parent_that_demands_two(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "- SIL: QM\n- Verify: test\n- Polarity: nominal", "- SIL: QM\n- Verify: test\n- Polarity: nominal, violation")

    assert judge(trace, sample, "SYS-003", "SWR-TLS-001") == ["incomplete", "verified"]


@pytest.mark.verifies("SWR-TRC-014", technique="requirements_based", polarity="nominal")
def test_missing_results_are_not_run_when_they_may_be_missing(sample: Sample, trace: Callable) -> None:
    shutil.rmtree(sample.evidence)

    outcome = trace("check", "--root", sample.root, "--output", "json", "--allow-missing")

    assert (outcome.status, outcome.rules) == (0, set())
    assert outcome.content["summary"]["verdicts"] == {"not run": 8}


@pytest.mark.verifies("SWR-TRC-014", technique="fault_injection", polarity="violation")
def test_failing_and_skipped_results_count_also_when_others_may_be_missing(sample: Sample, trace: Callable) -> None:
    give_outcome(sample, "<failure/>")
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["verdict"] = "fail"
    path.write_text(json.dumps(content))

    outcome = trace("check", "--root", sample.root, "--output", "json", "--allow-missing")

    assert (outcome.status, outcome.rules) == (1, {"result-failed"})
    assert [outcome.get_verdict(item) for item in ("SWR-SUP-001", "SYS-002")] == ["failed", "failed"]


@pytest.mark.verifies("SWR-TRC-014", technique="fault_injection", polarity="violation")
def test_a_test_that_was_never_written_is_no_missing_result(sample: Sample, trace: Callable) -> None:
    sample.replace("safety/tests/alive_test.cpp", '    verifies("SWR-SUP-002");\n', "")
    shutil.rmtree(sample.evidence)

    outcome = trace("check", "--root", sample.root, "--output", "json", "--allow-missing")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SWR-SUP-002")) == (1, {"test-missing"}, "incomplete")


@pytest.mark.verifies("SWR-TRC-101", technique="fault_injection", polarity="violation")
def test_an_inconclusive_campaign_case_is_not_shown_here_and_no_finding(sample: Sample, trace: Callable) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1].update(verdict="inconclusive", checks=[])
    path.write_text(json.dumps(content))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SYS-002")) == (0, set(), "not shown here")
