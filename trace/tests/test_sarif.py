# SPDX-License-Identifier: Apache-2.0
# Goal: the SARIF output has every part that the format requires and forges use, and no information about the host.
# Method: a handwritten structural check of the rules of SARIF 2.1.0 for these objects (sections 3.13 to 3.58).
from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import pytest
from trace_sample import Sample, format_gtest_case, format_waiver

from mamori_trace.checks import list_rules

SYSTEM = "requirements/system/system.md"
SOFTWARE = "requirements/software/software.md"
WAIVERS = "requirements/waivers.toml"
GTEST = "build/host-release/evidence/junit/safety.xml"
LEVELS = {"none", "note", "warning", "error"}


def get_run(trace: Callable, sample: Sample, *more: str) -> dict[str, Any]:
    log = json.loads(trace("check", "--root", sample.root, "--output", "sarif", *more).out)
    check_log(log)
    return log["runs"][0]


def check_log(log: dict[str, Any]) -> None:
    """The rules of the format for a log with one run."""
    assert log["version"] == "2.1.0" and log["$schema"].endswith("sarif-schema-2.1.0.json")
    assert set(log) == {"$schema", "version", "runs"} and len(log["runs"]) == 1
    run = log["runs"][0]
    driver = run["tool"]["driver"]
    assert driver["name"] and re.match(r"\d", driver["version"])
    ids = [rule["id"] for rule in driver["rules"]]
    assert len(set(ids)) == len(ids)
    for rule in driver["rules"]:
        texts = (rule["shortDescription"]["text"], rule["fullDescription"]["text"], rule["help"]["text"])
        assert all(text.endswith(".") for text in texts), rule
        assert rule["defaultConfiguration"]["level"] in LEVELS
    assert isinstance(run["invocations"][0]["executionSuccessful"], bool)
    for result in run["results"]:
        check_result(result, ids, run["originalUriBaseIds"])


def check_result(result: dict[str, Any], ids: list[str], bases: dict[str, Any]) -> None:
    assert ids[result["ruleIndex"]] == result["ruleId"]
    assert result["level"] in LEVELS and result["message"]["text"]
    assert re.fullmatch(r"[0-9a-f]{32}", result["partialFingerprints"]["mamoriFinding/v1"])
    suppressions = result.get("suppressions", [])
    for suppression in suppressions:
        assert suppression["kind"] in {"inSource", "external"} and suppression["status"] == "accepted" and suppression["justification"]
    for location in result["locations"] + [each["location"] for each in suppressions]:
        place = location["physicalLocation"]
        assert place["region"]["startLine"] >= 1
        assert re.fullmatch(r"[\w.~%/+-]+", place["artifactLocation"]["uri"]) and not place["artifactLocation"]["uri"].startswith("/")
        assert place["artifactLocation"]["uriBaseId"] in bases


@pytest.mark.verifies("SWR-TRC-026", technique="requirements_based", polarity="nominal")
def test_a_clean_project_gives_all_rules_and_no_result(sample: Sample, trace: Callable) -> None:
    run = get_run(trace, sample)

    assert run["results"] == []
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == [rule.id for rule in list_rules()]


@pytest.mark.verifies("SWR-TRC-026", technique="requirements_based", polarity="nominal")
def test_each_finding_is_a_result_with_its_rule_level_file_and_line(sample: Sample, trace: Callable) -> None:
    line = sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    sample.replace(SOFTWARE, "open no connection.", "open no connection if possible.")
    sample.review()

    results = get_run(trace, sample)["results"]

    assert [(each["ruleId"], each["level"], each["properties"]["item"]) for each in results] == [
        ("weak-word", "warning", "SWR-TLS-001"),
        ("shall-count", "error", "SYS-003"),
    ]
    place = results[1]["locations"][0]["physicalLocation"]
    assert (place["artifactLocation"]["uri"], place["region"]["startLine"]) == (SYSTEM, line)


@pytest.mark.verifies("SWR-TRC-026", technique="requirements_based", polarity="nominal")
def test_a_waived_finding_is_a_suppressed_result(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    sample.review()
    sample.write(WAIVERS, format_waiver("shall-count", item="SYS-003", expires="2026-12-24"))

    (result,) = get_run(trace, sample)["results"]

    assert result["suppressions"][0]["justification"] == "It is so. (Sample Reviewer, until 2026-12-24)"
    assert result["suppressions"][0]["location"]["physicalLocation"]["artifactLocation"]["uri"] == WAIVERS


@pytest.mark.verifies("SWR-TRC-026", technique="boundary_values", polarity="nominal")
def test_a_fingerprint_outlives_moved_lines_and_tells_equal_findings_apart(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    case = '    <testcase name="Runs" classname="FreeTest"/>\n'
    sample.replace(GTEST, "  </testsuite>", case + "  </testsuite>")
    sample.review()
    before = [each["partialFingerprints"] for each in get_run(trace, sample)["results"]]
    path = sample.root / SYSTEM
    path.write_text("# Title\n\n\n" + path.read_text())
    after = [each["partialFingerprints"] for each in get_run(trace, sample)["results"]]

    assert before == after
    assert len({str(each) for each in before}) == len(before) == 2


@pytest.mark.verifies("SWR-TRC-026", technique="boundary_values", polarity="violation")
def test_names_with_blanks_and_signs_become_proper_addresses(sample: Sample, trace: Callable) -> None:
    old = sample.root / SYSTEM
    old.rename(old.with_name("a system? 100 %.md"))
    sample.review()
    path = old.with_name("a system? 100 %.md")
    path.write_text(path.read_text().replace("The tool shall run", "The tool runs"))
    sample.review()

    (result,) = get_run(trace, sample)["results"]

    uri = result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    assert uri == "requirements/system/a%20system%3F%20100%20%25.md"


@pytest.mark.verifies("SWR-TRC-026", technique="fault_injection", polarity="violation")
def test_input_that_was_not_read_is_no_success(sample: Sample, trace: Callable) -> None:
    (sample.root / GTEST).write_text("<testsuites>")

    run = get_run(trace, sample)

    assert run["invocations"][0]["executionSuccessful"] is False
    assert "unreadable-input" in {each["ruleId"] for each in run["results"]}


@pytest.mark.verifies("SWR-TRC-026", technique="requirements_based", polarity="nominal")
def test_the_same_project_elsewhere_gives_the_same_bytes(sample: Sample, trace: Callable, tmp_path: Any) -> None:
    sample.replace(GTEST, "  </testsuite>", format_gtest_case("NewTest", "IsNew", "SWR-SUP-909") + "  </testsuite>")
    first = trace("check", "--root", sample.root, "--output", "sarif").out
    sample.root.rename(tmp_path / "moved")

    assert trace("check", "--root", tmp_path / "moved", "--output", "sarif").out == first
