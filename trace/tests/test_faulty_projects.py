# SPDX-License-Identifier: Apache-2.0
# Goal: each fault class is found in each format, with every seeded id, file and line; nothing else is reported.
# Method: one fault at a time is seeded into a clean project of 100 requirements on 3 levels, which the real command then checks.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from faulty.faults import FAULTS, WITHOUT_FAULT
from faulty.generate import generate
from faulty.writers import WRITERS

from mamori_trace.checks import list_rules

_CASES = [(name, fault) for name in WRITERS for fault in FAULTS if name not in FAULTS[fault].unstated]


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.verifies("SWR-TRC-045", technique="requirements_based", polarity="nominal")
def test_a_clean_project_has_no_finding(name: str, trace: Callable, tmp_path: Path) -> None:
    project = generate(name, "", tmp_path)

    outcome = trace("check", *project.arguments, "--output", "json")

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    assert len(outcome.content["items"]) == 100
    assert {row["verdict"] for row in outcome.content["items"]} == {"verified"}


@pytest.mark.parametrize(("name", "fault"), _CASES)
@pytest.mark.verifies("SWR-TRC-045", technique="fault_injection", polarity="violation")
def test_each_fault_is_found_where_it_is_and_nothing_else(name: str, fault: str, trace: Callable, tmp_path: Path) -> None:
    project = generate(name, fault, tmp_path)

    outcome = trace("check", *project.arguments, "--output", "json")

    findings = outcome.content["findings"]
    found = [(f"{row['file']}:{row['line']}", row["message"]) for row in findings]
    for seeded in project.seeded:
        assert any(place == f"{seeded.file}:{seeded.line}" and seeded.word in message for place, message in found), (seeded, found)
    assert {place for place, _ in found} == {f"{seeded.file}:{seeded.line}" for seeded in project.seeded}, found
    assert outcome.rules == {FAULTS[fault].rule}
    error = any(row["severity"] == "error" for row in findings)
    assert outcome.status == (2 if fault == "results-cut-off" else 1 if error else 0)


@pytest.mark.verifies("SWR-TRC-045", technique="requirements_based", polarity="nominal")
def test_every_rule_has_a_fault_class_or_a_reason() -> None:
    rules = {rule.id for rule in list_rules()}

    assert rules == {fault.rule for fault in FAULTS.values()} | set(WITHOUT_FAULT)
    assert all(reason for fault in FAULTS.values() for reason in fault.unstated.values())
