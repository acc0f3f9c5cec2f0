# SPDX-License-Identifier: Apache-2.0
# Goal: an approved item is green only with a bound, passed result of each required kind; results that a host cannot produce count
# separately.
from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample, format_gtest_case

GTEST = "build/host-release/evidence/junit/safety.xml"
SILENT = '<testcase name="SilenceIsReported"'
PRIVILEGE = '<skipped message="the privilege for fixed priorities is missing"/>'
INCONCLUSIVE = '<skipped message="verdict=inconclusive: 3 of 4 windows were held up by the host"/>'
BY_PROPERTY = '<skipped/><properties><property name="verdict" value="inconclusive"/></properties>'


def give_outcome(s: Sample, element: str) -> None:
    text = (s.root / GTEST).read_text()
    at = text.index(">", text.index(SILENT)) + 1
    (s.root / GTEST).write_text(text[:at] + element + text[at:])


def judge(trace: Callable, s: Sample, *options: object, recorded: bool = True) -> tuple[int, set[str], str]:
    outcome = trace("check", "--root", s.root, "--output", "json", *options, recorded=recorded)
    return outcome.status, outcome.rules, outcome.get_verdict("SWR-SUP-001")


def read_answers(page: Path) -> str:
    found = re.search(r'<div class="answers">(.*?)<div class="tiles">', page.read_text(), re.DOTALL)
    assert found is not None
    return found[1]


@pytest.mark.verifies("SWR-TRC-100", technique="requirements_based", polarity="nominal")
def test_a_project_whose_items_are_shown_has_no_finding(sample: Sample, trace: Callable) -> None:
    assert judge(trace, sample) == (0, set(), "verified")


@pytest.mark.verifies("SWR-TRC-100", technique="error_guessing", polarity="violation")
def test_a_result_of_the_other_polarity_does_not_show_an_item(sample: Sample, trace: Callable) -> None:
    """The source has polarity `violation`, so no test is missing; the result has `nominal`."""
    text = (sample.root / GTEST).read_text()
    (sample.root / GTEST).write_text(text.replace('value="violation"', 'value="nominal"'))

    assert judge(trace, sample) == (1, {"not-verified"}, "incomplete")
    assert judge(trace, sample, "--allow-missing") == (0, set(), "incomplete")


@pytest.mark.verifies("SWR-TRC-100", technique="error_guessing", polarity="violation")
def test_a_campaign_result_does_not_stand_for_a_test(sample: Sample, trace: Callable) -> None:
    sample.replace("tools/tests/test_offline.py", '@pytest.mark.verifies("SWR-TLS-001", technique="interface")\n', "")
    (sample.evidence / "junit/tools.xml").unlink()
    case = format_gtest_case("offline", "offline-1[SWR-TLS-001]", "SWR-TLS-001")
    (sample.evidence / "junit/campaign.xml").write_text(f"<testsuites><testsuite>{case}</testsuite></testsuites>")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SWR-TLS-001")) == (1, {"not-verified"}, "incomplete")
    assert [one["item"] for one in outcome.content["findings"]] == ["SWR-TLS-001"]


@pytest.mark.verifies("SWR-TRC-100", technique="error_guessing", polarity="violation")
def test_a_draft_below_leaves_an_approved_item_unverified(sample: Sample, trace: Callable) -> None:
    path = sample.root / "requirements/software/software.md"
    head, mark, rest = path.read_text().partition("## SWR-TLS-001")
    path.write_text(head + mark + rest.replace("Status: approved", "Status: draft"))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.status == 1
    assert [(one["rule"], one["item"]) for one in outcome.content["findings"]] == [("not-verified", "SYS-003")]


@pytest.mark.parametrize("element", [PRIVILEGE, INCONCLUSIVE, BY_PROPERTY], ids=["privilege", "message", "property"])
@pytest.mark.verifies("SWR-TRC-101", technique="equivalence_classes", polarity="nominal")
def test_what_the_host_cannot_show_is_counted_apart(sample: Sample, trace: Callable, element: str) -> None:
    give_outcome(sample, element)

    assert judge(trace, sample) == (0, {"result-not-shown"}, "not shown here")
    assert judge(trace, sample, "--allow-missing") == (0, {"result-not-shown"}, "not shown here")
    assert judge(trace, sample, "--release") == (1, {"result-not-shown"}, "not shown here")


@pytest.mark.verifies("SWR-TRC-101", technique="interface", polarity="nominal")
def test_text_json_and_report_agree_on_what_is_not_shown(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    give_outcome(sample, INCONCLUSIVE)

    summary = trace("check", "--root", sample.root, "--output", "json").content["summary"]
    text = trace("check", "--root", sample.root).out
    out = tmp_path / "page.html"
    report = trace("report", "--root", sample.root, "--out", out)

    count = summary["verdicts"]["not shown here"]
    assert summary["statuses"]["not shown here"] == 1 and report.status == 0
    assert f"{count} not shown here" in text and "1 not shown here\n" in text and f"{count} not shown here" in report.out
    answers = read_answers(out)
    assert f">{count} not shown here<" in answers and "0 of" in answers and ">Yes" not in answers


@pytest.mark.parametrize(
    ("element", "rules", "verdict"),
    [('<skipped message="not today"/>', {"result-skipped"}, "incomplete"),
     ('<failure message="verdict=inconclusive"/>', {"result-failed"}, "failed"),
     ('<failure message="f"/>' + BY_PROPERTY, {"result-failed"}, "failed")],
    ids=["other-reason", "failed-with-the-word", "failed-and-skipped"],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-101", technique="error_guessing", polarity="violation")
def test_no_other_result_is_excused_by_the_host(sample: Sample, trace: Callable, element: str, rules: set[str], verdict: str) -> None:
    give_outcome(sample, element)

    assert judge(trace, sample) == (1, rules, verdict)


@pytest.mark.verifies("SWR-TRC-101", technique="error_guessing", polarity="violation")
def test_an_inconclusive_case_that_is_written_as_passed_is_not_green(sample: Sample, trace: Callable) -> None:
    give_outcome(sample, BY_PROPERTY.removeprefix("<skipped/>"))

    assert judge(trace, sample)[2] == "not shown here"


@pytest.mark.verifies("SWR-TRC-101", technique="error_guessing", polarity="violation")
def test_a_release_with_missing_results_is_refused(sample: Sample, trace: Callable) -> None:
    outcome = trace("check", "--root", sample.root, "--release", "--allow-missing")

    assert outcome.status == 2 and "--release and --allow-missing" in outcome.err


@pytest.mark.verifies("SWR-TRC-102", technique="requirements_based", polarity="nominal")
def test_recorded_results_are_bound(sample: Sample, trace: Callable) -> None:
    assert judge(trace, sample, recorded=False) == (0, set(), "verified")


@pytest.mark.verifies("SWR-TRC-102", technique="fault_injection", polarity="violation")
def test_results_without_any_record_are_unbound(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (sample.evidence / "records.json").unlink()

    assert judge(trace, sample, recorded=False) == (1, {"result-unbound"}, "unbound")
    assert judge(trace, sample, "--allow-missing", recorded=False) == (0, set(), "unbound")

    outcome = trace("check", "--root", sample.root, "--output", "json", recorded=False)
    verdicts = outcome.content["summary"]["verdicts"]
    assert verdicts == {"unbound": len(outcome.content["items"])}
    assert len(outcome.content["findings"]) == 3  # two files of results and the campaign
    out = tmp_path / "page.html"
    trace("report", "--root", sample.root, "--out", out, "--allow-missing", recorded=False)
    answers = read_answers(out)
    assert f">{verdicts['unbound']} unbound<" in answers and ">Yes" not in answers


@pytest.mark.parametrize("inner", ["<!-- changed -->", ""], ids=["altered", "no-row"])
@pytest.mark.verifies("SWR-TRC-102", technique="fault_injection", polarity="violation")
def test_a_result_file_that_its_record_does_not_fit_is_unbound(sample: Sample, trace: Callable, inner: str) -> None:
    path = sample.root / GTEST
    if inner:
        path.write_text(path.read_text() + inner)
    else:
        path.rename(path.with_name("other.xml"))

    status, rules, verdict = judge(trace, sample, recorded=False)

    assert (status, rules, verdict) == (1, {"evidence-altered"}, "unbound")


@pytest.mark.verifies("SWR-TRC-102", technique="error_guessing", polarity="violation")
def test_a_failed_result_stays_failed_without_a_record(sample: Sample, trace: Callable) -> None:
    give_outcome(sample, '<failure message="f"/>')
    (sample.evidence / "records.json").unlink()

    assert judge(trace, sample, recorded=False) == (1, {"result-failed", "result-unbound"}, "failed")
