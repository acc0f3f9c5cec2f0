# SPDX-License-Identifier: Apache-2.0
# Goal: results of GoogleTest and pytest and campaign cases get the correct outcome; malicious and invalid files are rejected.
from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample, format_gtest_case

from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import TestResult
from mamori_trace.readers.junit import parse_junit


def parse(text: str) -> tuple[list[TestResult], list[Problem]]:
    problems: list[Problem] = []
    return parse_junit(text.encode(), "a.xml", "unit", Path("."), problems), problems


@pytest.mark.parametrize(
    ("case", "status", "message"),
    [
        (format_gtest_case("A", "B", "SWR-ABC-001"), "passed", ""),
        (format_gtest_case("A", "B", "SWR-ABC-001", inner='<failure message="1 != 2" type=""></failure>'), "failed", "1 != 2"),
        (format_gtest_case("A", "B", "SWR-ABC-001", inner="<failure>from text</failure>"), "failed", "from text"),
        (format_gtest_case("A", "B", "SWR-ABC-001", inner='<error message="crashed"/>'), "error", "crashed"),
        (format_gtest_case("A", "B", "SWR-ABC-001", inner='<skipped message="no data"/>'), "skipped", "no data"),
        (format_gtest_case("A", "B", "SWR-ABC-001", inner='<skipped message="s"/><failure message="f"/>'), "failed", "s"),
        (format_gtest_case("A", "B", "SWR-ABC-001", status="notrun", result="suppressed"), "skipped", "disabled"),
    ],
    ids=["passed", "failure", "failure-text", "error", "skipped", "worst-of-two", "disabled"],
)
@pytest.mark.verifies("SWR-TRC-004", technique="equivalence_classes", polarity="nominal")
def test_each_kind_of_result_is_read_as_what_it_is(case: str, status: str, message: str) -> None:
    results, problems = parse(f"<testsuites>\n<testsuite>\n{case}</testsuite></testsuites>")

    assert problems == []
    result = results[0]
    assert (result.status, result.message, result.requirement, result.place.line) == (status, message, "SWR-ABC-001", 3)


@pytest.mark.verifies("SWR-TRC-004", technique="interface", polarity="nominal")
def test_properties_are_read_also_where_old_versions_write_attributes() -> None:
    results, _ = parse('<testsuite><testcase name="b" classname="a" requirement="SWR-ABC-001" polarity="violation"/></testsuite>')

    assert (results[0].requirement, results[0].polarity) == ("SWR-ABC-001", "violation")


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ('<?xml version="1.0"?>\n<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]>\n<testsuite>&c;</testsuite>', 2, "DTD"),
        ('<?xml version="1.0"?>\n<!DOCTYPE a SYSTEM "file:///etc/passwd">\n<a/>', 2, "DTD"),
        ('<testsuites>\n<testsuite>\n<testcase name="a" classname="b"/>\n', 4, "not whole XML"),
        ("", 1, "not whole XML"),
    ],
    ids=["entities", "external", "cut-off", "empty"],
)
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_hostile_and_broken_xml_is_refused_with_one_finding(text: str, line: int, message: str) -> None:
    results, problems = parse(text)

    assert results == []
    assert [(problem.rule, problem.place.line) for problem in problems] == [("unreadable-input", line)]
    assert message in problems[0].message


@pytest.mark.parametrize(
    ("file", "data", "line"),
    [
        ("requirements/system/system.md", b"# System\n\n\xff\n", 3),
        ("safety/include/alive.hpp", b"// @satisfies SWR-SUP-001 \xe9\n", 1),
        ("tools/offline.py", b'"""@satisfies SWR-TLS-001"""\ndef (:\n', 2),
        ("build/host-release/evidence/junit/safety.xml", b"<testsuites>\n<a", 2),
        ("build/host-release/evidence/environment.json", b'{"schema": "mamori.environment/1",\n', 2),
        ("build/host-release/evidence/environment.json", b'{"schema": "other/1"}', 1),
        ("build/host-release/evidence/campaign/campaign.json", b"[]", 1),
        ("build/host-release/evidence/campaign/campaign.json", b'{"schema": "mamori.campaign/1"}', 1),
        ("build/host-release/evidence/campaign/campaign.json", b'{"schema": "mamori.campaign/1", "cases": [{"id": 3}]}', 1),
        ("requirements/trace.lock", b"SWR-SUP-001 523d4b7e0a7a\n", 1),
    ],
)
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_an_input_that_cannot_be_read_is_named_and_ends_with_status_2(
    sample: Sample, trace: Callable, file: str, data: bytes, line: int
) -> None:
    (sample.root / file).write_bytes(data)

    outcome = trace("check", "--root", sample.root, "--output", "json")

    found = [f for f in outcome.content["findings"] if f["rule"] == "unreadable-input"]
    assert (outcome.status, [(f["file"], f["line"]) for f in found]) == (2, [(file, line)])


@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_an_environment_that_cannot_be_read_is_not_told_as_missing(sample: Sample, trace: Callable) -> None:
    (sample.evidence / "environment.json").write_text("[")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.rules == {"unreadable-input"}


@pytest.mark.verifies("SWR-TRC-009", technique="requirements_based", polarity="nominal")
def test_whole_inputs_are_not_refused(sample: Sample, trace: Callable) -> None:
    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (0, set())


@pytest.mark.verifies("SWR-TRC-005", technique="requirements_based", polarity="nominal")
def test_a_campaign_case_counts_for_each_item_that_it_names(sample: Sample, trace: Callable) -> None:
    row = json.loads(trace("show", "SYS-002", "--root", sample.root, "--output", "json").out)

    assert row["cases"] == [{"case": case, "passed": True, "status": "passed"} for case in ("no_fault-1", "encoder_freeze-1")]


@pytest.mark.verifies("SWR-TRC-005", technique="fault_injection", polarity="violation")
def test_a_case_may_show_another_side_of_one_item(sample: Sample, trace: Callable) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["requirement_polarity"] = {"SYS-002": "nominal"}
    path.write_text(json.dumps(content, indent=1))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.rules, outcome.get_verdict("SYS-002")) == ({"campaign-missing"}, "incomplete")


@pytest.mark.verifies("SWR-TRC-005", technique="fault_injection", polarity="violation")
def test_a_written_pass_does_not_count_when_a_check_failed(sample: Sample, trace: Callable) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["checks"][0].update(measured="Operational", passed=False)
    path.write_text(json.dumps(content, indent=1))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("SYS-002")) == (1, {"result-failed"}, "failed")
