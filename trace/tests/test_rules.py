# SPDX-License-Identifier: Apache-2.0
# Goal: each fault, seeded alone into a clean project, is named with its id, file and line, and no other rule speaks up.
from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import COMMIT, Sample, format_gtest_case, format_item, format_record, format_review, format_technique, format_waiver

from mamori.trace.checks import list_rules
from mamori.trace.readers.project import read_requirements

SOFTWARE = "requirements/software/software.md"
SYSTEM = "requirements/system/system.md"
HEADER = "safety/include/alive.hpp"
CPP_TEST = "safety/tests/alive_test.cpp"
EVIDENCE = "build/host-release/evidence"
DECOMPOSITION = "requirements/decomposition.toml"
IDS = "requirements/ids.lock"
LINKS = "requirements/schema/links.toml"
LOCK = "requirements/trace.lock"
PACK = "requirements/schema/rules.toml"
REVIEWS = "requirements/reviews.toml"
TECHNIQUES = "requirements/schema/techniques.toml"
WAIVERS = "requirements/waivers.toml"
GTEST = f"{EVIDENCE}/junit/safety.xml"
CAMPAIGN = f"{EVIDENCE}/campaign/campaign.json"
SILENT = '<testcase name="SilenceIsReported"'

HINTS = {"test-unlinked", "weak-word", "independence-missing"}  # warnings, at the SIL at which they are seeded

Seed = tuple[str, str, int]  # (what the finding names, file, line)


def parent_unknown(s: Sample) -> Seed:
    return "SYS-999", SOFTWARE, s.replace(SOFTWARE, "- Parents: SYS-003", "- Parents: SYS-003, SYS-999")


def code_unknown(s: Sample) -> Seed:
    return "SWR-SUP-909", HEADER, s.replace(HEADER, "SWR-SUP-002", "SWR-SUP-002, SWR-SUP-909")


def source_unknown(s: Sample) -> Seed:
    s.replace(GTEST, "  </testsuite>", format_gtest_case("NewTest", "IsNew", "SWR-SUP-909") + "  </testsuite>")
    return "SWR-SUP-909", CPP_TEST, s.append(CPP_TEST, 'TEST(NewTest, IsNew) { verifies("SWR-SUP-909"); }\n')


def result_unknown(s: Sample) -> Seed:
    case = format_gtest_case("NewTest", "IsNew", "SWR-SUP-909")
    return "SWR-SUP-909", GTEST, s.replace(GTEST, "  </testsuite>", case + "  </testsuite>")


def campaign_unknown(s: Sample) -> Seed:
    edit_case(s, 1, requirements=["SYS-002", "SYS-909"])
    return "SYS-909", CAMPAIGN, find_line(s, CAMPAIGN, '"encoder_freeze-1"')


def duplicate(s: Sample) -> Seed:
    block = format_item("SWR-SUP-002", "Again", "The supervision shall repeat itself.", Parents="SYS-001")
    return "SWR-SUP-002", SOFTWARE, s.append(SOFTWARE, block)


def case_twice(s: Sample) -> Seed:
    edit_case(s, 1, id="no_fault-1")
    return "no_fault-1", CAMPAIGN, find_line(s, CAMPAIGN, '"no_fault-1"')


def malformed(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.append(SOFTWARE, "Afterthought.\n")


def cycle(s: Sample) -> Seed:
    line = s.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, HAZ-001, SWR-SUP-002")
    return "SWR-SUP-002 -> SYS-001 -> SWR-SUP-002", SYSTEM, line


def no_parent(s: Sample) -> Seed:
    s.append(SYSTEM, format_item("SYS-004", "Extra", "The tool shall be extra.", Parents="STK-001"))
    s.append(SOFTWARE, format_item("SWR-TLS-002", "Extra", "The tool shall be extra.", Parents="SYS-004", SIL="QM"))
    s.replace(HEADER, "SWR-SUP-002", "SWR-SUP-002, SWR-TLS-002")
    s.replace(GTEST, "  </testsuite>", format_gtest_case("ExtraTest", "IsExtra", "SWR-TLS-002") + "  </testsuite>")
    return "SYS-004", SYSTEM, s.replace(SYSTEM, "- Parents: STK-001\n- SIL: 2", "- Parents: -\n- SIL: QM")


def no_child(s: Sample) -> Seed:
    needs = "requirements/stakeholder/needs.md"
    return "STK-002", needs, s.append(needs, format_item("STK-002", "Lonely", "Engineers need more.", SIL="QM", Verify="review"))


def level_skipped(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: STK-001\n")
    return "SWR-SUP-002", SOFTWARE, find_line(s, SOFTWARE, "- Parents: STK-001\n")


def level_sideways(s: Sample) -> Seed:
    return "SYS-001 names SYS-003", SYSTEM, s.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, HAZ-001, SYS-003")


def sil_lower(s: Sample) -> Seed:
    line = s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "SWR-SUP-002", SOFTWARE, line + 1


def no_code(s: Sample) -> Seed:
    s.replace(HEADER, "/// @satisfies SWR-SUP-002\n", "")
    return "SWR-SUP-002", SOFTWARE, find_line(s, SOFTWARE, "## SWR-SUP-002")


def no_test(s: Sample) -> Seed:
    s.replace(CPP_TEST, '    verifies("SWR-SUP-002");\n', "")
    text = (s.root / GTEST).read_text()
    start = text.index('    <testcase name="LatenessIsReported/0"')
    (s.root / GTEST).write_text(text[:start] + text[text.index("  </testsuite>") :])
    return "SWR-SUP-002", SOFTWARE, find_line(s, SOFTWARE, "- Verify: test", after="## SWR-SUP-002")


def result_failed(s: Sample) -> Seed:
    set_outcome(s, '<failure message="1 != 2" type=""></failure>')
    return "SWR-SUP-001", CPP_TEST, find_line(s, CPP_TEST, 'verifies("SWR-SUP-001", Technique::kB')


def result_error(s: Sample) -> Seed:
    set_outcome(s, '<error message="crashed"/>')
    return "SWR-SUP-001", CPP_TEST, find_line(s, CPP_TEST, 'verifies("SWR-SUP-001", Technique::kB')


def result_skipped(s: Sample) -> Seed:
    set_outcome(s, '<skipped message="no data"/>')
    return "SWR-SUP-001", CPP_TEST, find_line(s, CPP_TEST, 'verifies("SWR-SUP-001", Technique::kB')


def result_disabled(s: Sample) -> Seed:
    s.replace(GTEST, SILENT + ' status="run"', SILENT + ' status="notrun"')
    return "SWR-SUP-001", CPP_TEST, find_line(s, CPP_TEST, 'verifies("SWR-SUP-001", Technique::kB')


def result_missing(s: Sample) -> Seed:
    s.replace(GTEST, "LatenessIsReported", "SomethingElse")
    return "SWR-SUP-002", CPP_TEST, find_line(s, CPP_TEST, 'verifies("SWR-SUP-002")')


def no_violation(s: Sample) -> Seed:
    s.replace(CPP_TEST, "Polarity::kViolation", "Polarity::kNominal")
    s.replace(GTEST, 'value="violation"', 'value="nominal"')
    return "SWR-SUP-001", SOFTWARE, find_line(s, SOFTWARE, "- Polarity: nominal, violation")


def no_violation_below(s: Sample) -> Seed:
    line = s.replace(SYSTEM, "- Parents: STK-001\n- SIL: QM\n- Verify: test\n- Polarity: nominal",
                     "- Parents: STK-001\n- SIL: QM\n- Verify: test\n- Polarity: nominal, violation")  # fmt: skip
    return "SYS-003", SYSTEM, line + 3


def no_campaign(s: Sample) -> Seed:
    edit_case(s, 0, requirements=[])
    edit_case(s, 1, requirements=[])
    return "SYS-002", SYSTEM, find_line(s, SYSTEM, "- Verify: campaign")


def no_campaign_violation(s: Sample) -> Seed:
    edit_case(s, 1, requirements=[])
    return "SYS-002", SYSTEM, find_line(s, SYSTEM, "- Polarity: nominal, violation", after="- Verify: campaign")


def campaign_failed(s: Sample) -> Seed:
    edit_case(s, 1, verdict="fail")
    return "encoder_freeze-1", CAMPAIGN, find_line(s, CAMPAIGN, '"encoder_freeze-1"')


def unfinished(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "open no connection", "open to" + "do no connection")


def shall_absent(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "shall open no", "opens no")


def shall_twice(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "no connection.", "no connection and shall close it.")


def design_file(s: Sample) -> Seed:
    return "docs/design/gone.md", SOFTWARE, seed_design(s, "docs/design/gone.md#a")


def design_heading(s: Sample) -> Seed:
    return "#hazard", SOFTWARE, seed_design(s, "docs/design/arm.md#hazard")


def retired(s: Sample) -> Seed:
    path = s.root / SOFTWARE
    head, mark, tail = path.read_text().rpartition("- Status: approved")
    s.append(SYSTEM, format_item("SYS-005", "Spare", "The tool shall stay.", Parents="STK-001", SIL="QM", Status="draft"))
    s.replace(SYSTEM, "- Verify: test\n- Polarity: nominal\n- Design: -\n- Status: approved",
              "- Verify: test\n- Polarity: nominal\n- Design: -\n- Status: draft")  # fmt: skip
    path.write_text(head + "- Status: retired" + tail)
    test = "tools/tests/test_offline.py"
    (s.root / test).unlink()
    (s.root / EVIDENCE / "junit" / "tools.xml").unlink()
    return "SWR-TLS-001", "tools/offline.py", 3


def technique_unknown(s: Sample) -> Seed:
    s.replace(CPP_TEST, "Technique::kBoundaryValues", "Technique::kGuess")
    return "'guess'", CPP_TEST, find_line(s, CPP_TEST, "Technique::kGuess")


def suspect(s: Sample) -> Seed:
    s.replace(SYSTEM, "The tool shall run offline.", "The tool shall run far away.")
    return "SYS-003 changed", SOFTWARE, find_line(s, SOFTWARE, "- Parents: SYS-003")


def lock_gone(s: Sample) -> Seed:
    (s.root / "requirements" / "trace.lock").unlink()
    return "trace review", "requirements/trace.lock", 1


def unlinked(s: Sample) -> Seed:
    case = '    <testcase name="Runs" classname="FreeTest"/>\n'
    return "FreeTest: 1 test", GTEST, s.replace(GTEST, "  </testsuite>", case + "  </testsuite>")


def no_environment(s: Sample) -> Seed:
    (s.evidence / "environment.json").unlink()
    return "missing", f"{EVIDENCE}/environment.json", 1


def decomposition_idle(s: Sample) -> Seed:
    return "no lower", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-001"))


def decomposition_of_nothing(s: Sample) -> Seed:
    return "no parent SYS-003", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-003", "SWR-TLS-001"))


def carrier_elsewhere(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "does not refine SYS-001", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-TLS-001"))


def carrier_unknown(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "SWR-SUP-009", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-009"))


def weak(s: Sample) -> Seed:
    return "'if possible'", SOFTWARE, s.replace(SOFTWARE, "open no connection.", "open no connection if possible.")


def id_taken_again(s: Sample) -> Seed:
    s.write(IDS, "# [[ids]]\nSWR-SUP-002 0123456789ab 2026-10-01 Brake wear\n")
    return "'Brake wear'", SOFTWARE, find_line(s, SOFTWARE, "## SWR-SUP-002")


def id_dropped(s: Sample) -> Seed:
    with (s.root / LOCK).open("a") as lock:
        lock.write("SWR-SUP-009 0123456789ab SYS-001 0123456789ab 2026-10-01 Sample Reviewer\n")
    return "SWR-SUP-009", LOCK, find_line(s, LOCK, "SWR-SUP-009")


def add_analysed(s: Sample, verify: str = "analysis") -> int:
    """An item that is shown by analysis. @return the line of that attribute."""
    block = format_item("AOU-001", "Clock", "The integrator shall provide a clock.", Parents="SYS-001", Verify=verify)
    return s.append(SYSTEM, block) + block[: block.index("- Verify")].count("\n")


def write_review(s: Sample, **changes: str) -> int:
    s.review()
    fingerprint = read_requirements(s.root).items["AOU-001"].calc_fingerprint()
    return s.write(REVIEWS, format_review("AOU-001", fingerprint, **changes))


def review_absent(s: Sample) -> Seed:
    return "AOU-001 demands analysis", SYSTEM, add_analysed(s)


def review_outdated(s: Sample) -> Seed:
    line = add_analysed(s)
    s.write(REVIEWS, format_review("AOU-001", "0123456789ab"))
    return "AOU-001 changed", SYSTEM, line


def review_of_nothing(s: Sample) -> Seed:
    return "AOU-007", REVIEWS, s.write(REVIEWS, format_review("AOU-007", "0123456789ab"))


def review_not_demanded(s: Sample) -> Seed:
    return "SWR-TLS-001, which demands test", REVIEWS, s.write(REVIEWS, format_review("SWR-TLS-001", "0123456789ab", method="review"))


def review_by_author(s: Sample) -> Seed:
    add_analysed(s)
    return "by its author", REVIEWS, write_review(s, author="sample reviewer")


def review_without_author(s: Sample) -> Seed:
    add_analysed(s)
    return "does not say who wrote", REVIEWS, write_review(s, author="")


def violation_not_demanded(s: Sample) -> Seed:
    s.replace(SYSTEM, "- Parents: STK-001, HAZ-001\n- SIL: 2\n- Verify: test\n- Polarity: nominal, violation",
              "- Parents: STK-001, HAZ-001\n- SIL: 2\n- Verify: test\n- Polarity: nominal")  # fmt: skip
    return "SYS-001 answers HAZ-001", SYSTEM, find_line(s, SYSTEM, "- Polarity: nominal\n")


def no_design(s: Sample) -> Seed:
    s.write(PACK, '# [[design]]\nschema = "mamori.rules/1"\n[rule.design-missing]\n2 = "error"\nQM = "off"\n')
    for file in (SYSTEM, SOFTWARE):
        text = (s.root / file).read_text()
        (s.root / file).write_text(text.replace("- Design: -", "- Design: docs/design/arm.md#hazards"))
    text = (s.root / SOFTWARE).read_text()
    (s.root / SOFTWARE).write_text(text.replace("- Design: docs/design/arm.md#hazards", "- Design: -", 1))
    return "SWR-SUP-001", SOFTWARE, find_line(s, SOFTWARE, "- Design: -")


def technique_without_proof(s: Sample) -> Seed:
    return "neither items nor tests", TECHNIQUES, s.write(TECHNIQUES, format_technique())


def technique_without_item(s: Sample) -> Seed:
    return "SWR-SUP-009 is defined nowhere", TECHNIQUES, s.write(TECHNIQUES, format_technique(items=["SWR-SUP-009"]))


def technique_without_test(s: Sample) -> Seed:
    return "no test uses back_to_back", TECHNIQUES, s.write(TECHNIQUES, format_technique(tests=["back_to_back"]))


def technique_without_heading(s: Sample) -> Seed:
    return "no heading #gone", TECHNIQUES, s.write(TECHNIQUES, format_technique(documents=["docs/design/arm.md#gone"]))


def code_for_a_need(s: Sample) -> Seed:
    copy_links(s)
    return "STK-001, which is of the kind need", HEADER, s.replace(HEADER, "SWR-SUP-002", "SWR-SUP-002, STK-001")


def hazard_without_design(s: Sample) -> Seed:
    copy_links(s)
    file = "requirements/safety/hazards.md"
    return "HAZ-001 says no Design", file, s.replace(file, "- Design: docs/design/arm.md#hazards", "- Design: -")


def copy_links(s: Sample) -> None:
    shutil.copy(Path(__file__).parents[2] / LINKS, s.root / LINKS)


def waiver_idle(s: Sample) -> Seed:
    return "SWR-SUP-002", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002"))


def waiver_over(s: Sample) -> Seed:
    return "2026-11-20", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002", expires="2026-11-20"))


def waiver_silent(s: Sample) -> Seed:
    return "no reason", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002", reason=""))


# (seed, rule, whether the links are reviewed again afterwards)
def document_id(s: Sample) -> Seed:
    (s.root / "docs" / "manual" / "safety").mkdir(parents=True)
    (s.root / "docs" / "manual" / "safety" / "limits.md").write_text("# Limits\n\nSYS-001 and SWR-SUP-909 hold.\n")
    return "SWR-SUP-909", "docs/manual/safety/limits.md", 3


SEEDS = (
    (parent_unknown, "unknown-id", True),
    (code_unknown, "unknown-id", True),
    (source_unknown, "unknown-id", True),
    (result_unknown, "unknown-id", True),
    (campaign_unknown, "unknown-id", True),
    (duplicate, "duplicate-id", False),
    (case_twice, "duplicate-id", True),
    (malformed, "malformed-item", False),
    (cycle, "cycle", True),
    (no_parent, "parent-missing", True),
    (no_child, "child-missing", True),
    (level_skipped, "level-order", True),
    (level_sideways, "level-order", True),
    (sil_lower, "sil-lower", True),
    (decomposition_idle, "decomposition-unused", True),
    (decomposition_of_nothing, "decomposition-unused", True),
    (carrier_elsewhere, "decomposition-unsound", True),
    (carrier_unknown, "decomposition-unsound", True),
    (weak, "weak-word", True),
    (id_taken_again, "id-reused", True),
    (id_dropped, "id-unrecorded", False),
    (review_absent, "review-missing", True),
    (review_outdated, "review-missing", True),
    (review_of_nothing, "review-unused", True),
    (review_not_demanded, "review-unused", True),
    (review_by_author, "independence-missing", True),
    (review_without_author, "independence-missing", True),
    (violation_not_demanded, "violation-not-demanded", True),
    (no_design, "design-missing", True),
    (technique_without_proof, "technique-unshown", True),
    (technique_without_item, "technique-unshown", True),
    (technique_without_test, "technique-unshown", True),
    (technique_without_heading, "technique-unshown", True),
    (code_for_a_need, "link-kind", True),
    (hazard_without_design, "link-kind", True),
    (waiver_idle, "waiver-unused", True),
    (waiver_over, "waiver-expired", True),
    (waiver_silent, "waiver-without-reason", True),
    (no_code, "code-missing", True),
    (no_test, "test-missing", True),
    (result_failed, "result-failed", True),
    (result_error, "result-failed", True),
    (result_skipped, "result-skipped", True),
    (result_disabled, "result-skipped", True),
    (result_missing, "result-missing", True),
    (no_violation, "polarity-missing", True),
    (no_violation_below, "polarity-missing", True),
    (no_campaign, "campaign-missing", True),
    (no_campaign_violation, "campaign-missing", True),
    (campaign_failed, "result-failed", True),
    (unfinished, "unfinished-text", True),
    (shall_absent, "shall-count", True),
    (shall_twice, "shall-count", True),
    (design_file, "design-link", True),
    (design_heading, "design-link", True),
    (document_id, "document-link", True),
    (retired, "retired-id", True),
    (technique_unknown, "unknown-word", True),
    (suspect, "suspect-link", False),
    (lock_gone, "suspect-link", False),
    (unlinked, "test-unlinked", True),
    (no_environment, "evidence-stale", True),
)


def edit_case(s: Sample, index: int, **changes: object) -> None:
    path = s.root / CAMPAIGN
    content = json.loads(path.read_text())
    content["cases"][index].update(changes)
    path.write_text(json.dumps(content, indent=1))


def set_outcome(s: Sample, element: str) -> None:
    text = (s.root / GTEST).read_text()
    at = text.index(">", text.index(SILENT)) + 1
    (s.root / GTEST).write_text(text[:at] + element + text[at:])


def seed_design(s: Sample, link: str) -> int:
    path = s.root / SOFTWARE
    head, _, tail = path.read_text().rpartition("- Design: -")
    path.write_text(f"{head}- Design: {link}{tail}")
    return head.count("\n") + 1


def find_line(s: Sample, file: str, text: str, after: str = "") -> int:
    content = (s.root / file).read_text()
    return content[: content.index(text, content.index(after))].count("\n") + 1


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
    chosen = (code_unknown, no_child, result_failed, campaign_failed, design_heading, unlinked)
    for seed in chosen:
        seed(sample)
    sample.review()

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.rules == {rule for seed, rule, _ in SEEDS if seed in chosen}


@pytest.mark.verifies("SWR-TRC-010", technique="requirements_based", polarity="violation")
def test_each_rule_has_a_seeded_fault() -> None:
    told_elsewhere = {"unreadable-input"}  # seeded in test_results.py
    told_elsewhere |= {"untraced-function", "function-unexecuted", "mcdc-gap"}  # seeded in test_functions.py and test_coverage_files.py
    told_elsewhere |= {"evidence-altered", "result-flaky", "analysis-finding"}  # seeded in test_evidence_records.py, test_foreign_results.py and test_analysis.py

    assert {rule.id for rule in list_rules()} - told_elsewhere == {rule for _, rule, _ in SEEDS}


@pytest.mark.verifies("SWR-TRC-010", technique="fault_injection", polarity="violation")
def test_evidence_of_another_commit_is_told(sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mamori.trace.readers.project.read_head", lambda root: "f" * 40)

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (1, {"evidence-stale"})
    assert all(COMMIT[:12] in finding["message"] for finding in outcome.content["findings"])
