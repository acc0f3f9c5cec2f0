# SPDX-License-Identifier: Apache-2.0
# Goal: each fault, seeded alone into a clean project, is reported with id, file and line; no other rule reports anything.
# Method: the faults are in seeds/, sorted by the affected part.
from __future__ import annotations

from collections.abc import Callable

import pytest
from seeds import links, records, results, texts
from seeds.places import Seed
from trace_sample import COMMIT, Sample

from mamori_trace.checks import list_rules

SEEDS = (*links.SEEDS, *texts.SEEDS, *records.SEEDS, *results.SEEDS)
HINTS = {"test-unlinked", "weak-word", "independence-missing"}  # warnings at the SIL of the seeded fault


@pytest.mark.verifies("SWR-TRC-010", technique="requirements_based", polarity="nominal")
def test_a_clean_project_has_no_finding_and_status_0(sample: Sample, trace: Callable) -> None:
    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    assert outcome.content["summary"]["verdicts"] == {"verified": 8}


@pytest.mark.parametrize(("seed", "rule", "reviewed"), SEEDS, ids=[seed.__name__ for seed, _, _ in SEEDS])
@pytest.mark.verifies("SWR-TRC-010", technique="fault_injection", polarity="violation")
def test_a_seeded_fault_is_named_and_no_other_rule_speaks_up(
    sample: Sample, trace: Callable, seed: Callable[[Sample], Seed], rule: str, reviewed: bool
) -> None:
    named, file, line = seed(sample)
    if reviewed:
        sample.review()

    outcome = trace("check", "--root", sample.root, "--output", "json")

    findings = outcome.content["findings"]
    severities = {finding["severity"] for finding in findings}
    assert outcome.status == (1 if rule not in HINTS else 0), findings
    assert severities == ({"warning"} if rule in HINTS else {"error"})
    assert outcome.rules == {rule}, findings
    assert any((f["file"], f["line"]) == (file, line) and named in f["message"] for f in findings), findings


@pytest.mark.verifies("SWR-TRC-010", technique="fault_injection", polarity="violation")
def test_many_faults_are_told_in_one_run(sample: Sample, trace: Callable) -> None:
    chosen = (results.code_unknown, links.no_child, results.result_failed, results.campaign_failed, links.design_heading, results.unlinked)
    for seed in chosen:
        seed(sample)
    sample.review()

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.rules == {rule for seed, rule, _ in SEEDS if seed in chosen}


@pytest.mark.verifies("SWR-TRC-010", technique="requirements_based", polarity="violation")
def test_each_rule_has_a_seeded_fault() -> None:
    told_elsewhere = {"unreadable-input"}  # seeded in test_results.py
    told_elsewhere |= {"untraced-function", "function-unexecuted", "mcdc-gap"}  # seeded in test_functions.py and test_coverage_files.py
    # Seeded in test_evidence_records.py, test_foreign_results.py and test_analysis.py.
    told_elsewhere |= {"evidence-altered", "result-flaky", "analysis-finding"}
    told_elsewhere |= {"not-verified", "result-not-shown", "result-unbound"}  # seeded in test_demanded_results.py

    assert {rule.id for rule in list_rules()} - told_elsewhere == {rule for _, rule, _ in SEEDS}


@pytest.mark.verifies("SWR-TRC-010", technique="fault_injection", polarity="violation")
def test_evidence_of_another_commit_is_told(sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mamori_trace.readers.project.read_head", lambda root: "f" * 40)

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (1, {"evidence-stale"})
    assert all(COMMIT[:12] in finding["message"] for finding in outcome.content["findings"])
