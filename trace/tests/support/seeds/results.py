# SPDX-License-Identifier: Apache-2.0
"""Faults of code, tests, results and the campaign."""

from __future__ import annotations

import json

from trace_sample import Sample, format_gtest_case, format_item

from seeds.places import EVIDENCE, GTEST, HEADER, SOFTWARE, SYSTEM, Seed, find_line

CPP_TEST = "safety/tests/alive_test.cpp"
CAMPAIGN = f"{EVIDENCE}/campaign/campaign.json"
SILENT = '<testcase name="SilenceIsReported"'


def edit_case(s: Sample, index: int, **changes: object) -> None:
    path = s.root / CAMPAIGN
    content = json.loads(path.read_text())
    content["cases"][index].update(changes)
    path.write_text(json.dumps(content, indent=1))


def set_outcome(s: Sample, element: str) -> None:
    text = (s.root / GTEST).read_text()
    at = text.index(">", text.index(SILENT)) + 1
    (s.root / GTEST).write_text(text[:at] + element + text[at:])


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


def case_twice(s: Sample) -> Seed:
    edit_case(s, 1, id="no_fault-1")
    return "no_fault-1", CAMPAIGN, find_line(s, CAMPAIGN, '"no_fault-1"')


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


def retired(s: Sample) -> Seed:
    path = s.root / SOFTWARE
    head, _, tail = path.read_text().rpartition("- Status: approved")
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


def unlinked(s: Sample) -> Seed:
    case = '    <testcase name="Runs" classname="FreeTest"/>\n'
    return "FreeTest: 1 test", GTEST, s.replace(GTEST, "  </testsuite>", case + "  </testsuite>")


def no_environment(s: Sample) -> Seed:
    (s.evidence / "environment.json").unlink()
    return "missing", f"{EVIDENCE}/environment.json", 1


SEEDS = (
    (code_unknown, "unknown-id", True),
    (source_unknown, "unknown-id", True),
    (result_unknown, "unknown-id", True),
    (campaign_unknown, "unknown-id", True),
    (case_twice, "duplicate-id", True),
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
    (retired, "retired-id", True),
    (technique_unknown, "unknown-word", True),
    (unlinked, "test-unlinked", True),
    (no_environment, "evidence-stale", True),
)
"""Seed, rule, whether the links are reviewed again afterwards."""
