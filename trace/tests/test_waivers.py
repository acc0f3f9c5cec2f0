# SPDX-License-Identifier: Apache-2.0
# Goal: a waiver removes one specified finding from the count, is listed, and ends on its date; an invalid waiver has no effect.
from __future__ import annotations

from collections.abc import Callable

import pytest
from trace_sample import Sample, format_record, format_waiver

SOFTWARE = "requirements/software/software.md"
SYSTEM = "requirements/system/system.md"
WAIVERS = "requirements/waivers.toml"
DECOMPOSITION = "requirements/decomposition.toml"


@pytest.fixture
def faulty(sample: Sample) -> Sample:
    """A project with one finding: SYS-003 has no 'shall'."""
    sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    sample.review()
    return sample


@pytest.mark.parametrize("columns", [{"item": "SYS-003"}, {"file": SYSTEM}, {"item": "SYS-003", "file": SYSTEM, "expires": "2026-11-21"}])
@pytest.mark.verifies("SWR-TRC-021", technique="equivalence_classes", polarity="nominal")
def test_a_waived_finding_is_listed_and_does_not_count(faulty: Sample, trace: Callable, columns: dict[str, str]) -> None:
    faulty.write(WAIVERS, format_waiver("shall-count", **columns))

    outcome = trace("check", "--root", faulty.root, "--output", "json")
    text = trace("check", "--root", faulty.root).out

    assert (outcome.status, outcome.content["findings"], outcome.content["summary"]["waived"]) == (0, [], 1)
    waived = outcome.content["waived"][0]
    assert (waived["rule"], waived["item"], waived["reason"], waived["waiver"]) == ("shall-count", "SYS-003", "It is so.", f"{WAIVERS}:3")
    assert "waived: [shall-count]" in text and "0 errors, 0 warnings, 1 waived" in text


@pytest.mark.parametrize(
    ("rule", "columns"),
    [("shall-count", {"item": "SYS-002"}), ("shall-count", {"item": "SYS-003", "file": SOFTWARE}), ("cycle", {"item": "SYS-003"})],
)
@pytest.mark.verifies("SWR-TRC-021", technique="equivalence_classes", polarity="violation")
def test_a_waiver_of_something_else_waives_nothing(faulty: Sample, trace: Callable, rule: str, columns: dict[str, str]) -> None:
    faulty.write(WAIVERS, format_waiver(rule, **columns))

    outcome = trace("check", "--root", faulty.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (1, {"shall-count", "waiver-unused"})


@pytest.mark.parametrize(("day", "status"), [("2026-12-24", 0), ("2026-12-25", 1)])
@pytest.mark.verifies("SWR-TRC-021", technique="boundary_values", polarity="violation")
def test_a_waiver_holds_on_its_last_day_and_not_on_the_next(faulty: Sample, trace: Callable, day: str, status: int) -> None:
    faulty.write(WAIVERS, format_waiver("shall-count", item="SYS-003", expires="2026-12-24"))

    outcome = trace("check", "--root", faulty.root, "--output", "json", "--date", day)

    assert outcome.status == status
    assert outcome.rules == (set() if status == 0 else {"shall-count", "waiver-expired"})


@pytest.mark.verifies("SWR-TRC-021", technique="requirements_based", polarity="nominal")
def test_the_day_is_that_of_the_commit_and_without_one_that_of_the_evidence(
    faulty: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    faulty.write(WAIVERS, format_waiver("shall-count", item="SYS-003", expires="2026-11-21"))
    by_evidence = trace("check", "--root", faulty.root)
    monkeypatch.setattr("mamori_trace.readers.project.read_commit_date", lambda root: "2026-11-22")
    by_commit = trace("check", "--root", faulty.root)

    assert (by_evidence.status, by_commit.status) == (0, 1)
    assert "this is the state of 2026-11-22" in by_commit.out


@pytest.mark.verifies("SWR-TRC-021", technique="fault_injection", polarity="violation")
def test_where_nothing_tells_the_day_a_waiver_with_an_end_does_not_hold(faulty: Sample, trace: Callable) -> None:
    faulty.write(WAIVERS, format_waiver("shall-count", item="SYS-003", expires="2026-12-24"))
    (faulty.evidence / "environment.json").unlink()

    outcome = trace("check", "--root", faulty.root, "--allow-missing")

    assert outcome.status == 1 and "add --date" in outcome.out


@pytest.mark.parametrize(
    ("text", "line", "named"),
    [
        (format_waiver("shall-cuont", item="SYS-003"), 3, "nearest: shall-count"),
        (format_waiver("unreadable-input", item="SYS-003"), 3, "none that can be waived"),
        (format_waiver("waiver-unused", item="SYS-003"), 3, "none that can be waived"),
        (format_waiver("shall-count"), 3, "neither item nor file"),
        (format_waiver("shall-count", item="SYS-003", by=""), 3, "says no by"),
        (format_waiver("shall-count", item="SYS-003", expires="24.12.2026"), 3, "'24.12.2026' is no day"),
        (format_waiver("shall-count", itme="SYS-003"), 3, "nearest: item"),
        (format_waiver("shall-count", item="SYS-003") + "expires = 7\n", 3, "'expires' is no text"),
        (format_waiver("shall-count", item="SYS-003") + "reason = ", 8, "is not TOML"),
        (format_waiver("shall-count", item="SYS-003").replace("waivers/1", "waivers/2"), 1, "schema is"),
        ('schema = "mamori.waivers/1"\n[waivers]\n', 1, "unknown entry 'waivers'"),
        ('schema = "mamori.waivers/1"\nwaiver = "all"\n', 1, "is no list of rows"),
    ],
)
@pytest.mark.verifies("SWR-TRC-021", technique="error_guessing", polarity="violation")
def test_a_broken_waiver_is_named_and_waives_nothing(faulty: Sample, trace: Callable, text: str, line: int, named: str) -> None:
    (faulty.root / WAIVERS).write_text(text, encoding="utf-8")

    outcome = trace("check", "--root", faulty.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"shall-count", "unreadable-input"})
    told = next(finding for finding in outcome.content["findings"] if finding["rule"] == "unreadable-input")
    assert (told["file"], told["line"]) == (WAIVERS, line) and named in told["message"]


@pytest.mark.verifies("SWR-TRC-021", technique="error_guessing", polarity="nominal")
def test_a_day_may_be_written_without_quotation_marks(faulty: Sample, trace: Callable) -> None:
    faulty.write(WAIVERS, format_waiver("shall-count", item="SYS-003") + "expires = 2026-12-24\n")

    assert trace("check", "--root", faulty.root).status == 0


@pytest.mark.verifies("SWR-TRC-021", technique="error_guessing", polarity="violation")
def test_a_day_on_the_command_line_that_is_none_is_wrong_usage(faulty: Sample, trace: Callable) -> None:
    with pytest.raises(SystemExit) as ended:
        trace("check", "--root", faulty.root, "--date", "2026-02-30")

    assert ended.value.code == 2


@pytest.mark.verifies("SWR-TRC-022", technique="requirements_based", polarity="nominal")
def test_a_recorded_decomposition_justifies_a_lower_sil(sample: Sample, trace: Callable) -> None:
    sample.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    sample.review()
    without = trace("check", "--root", sample.root, "--output", "json")
    sample.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-001"))

    assert (without.status, without.rules) == (1, {"sil-lower"})
    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.parametrize(
    ("carrier", "change", "named"),
    [
        ("SWR-SUP-002", ("", ""), "is the child itself"),
        ("SWR-SUP-001", ("- Parents: SYS-001, HAZ-001\n- SIL: 2", "- Parents: SYS-001, HAZ-001\n- SIL: 1"), "has SIL 1, lower than SIL 2"),
    ],
)
@pytest.mark.verifies("SWR-TRC-022", technique="fault_injection", polarity="violation")
def test_an_item_that_does_not_carry_the_sil_is_no_carrier(
    sample: Sample, trace: Callable, carrier: str, change: tuple[str, str], named: str
) -> None:
    sample.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    if change[0]:
        sample.replace(SOFTWARE, *change)
    sample.review()
    sample.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", carrier))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    told = [finding["message"] for finding in outcome.content["findings"] if finding["rule"] == "decomposition-unsound"]
    assert outcome.status == 1 and len(told) == 1 and named in told[0]


@pytest.mark.parametrize("lost", ["reason", "independence", "by", "child", "carried_by"])
@pytest.mark.verifies("SWR-TRC-022", technique="error_guessing", polarity="violation")
def test_a_record_that_lacks_a_part_justifies_nothing(sample: Sample, trace: Callable, lost: str) -> None:
    sample.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    sample.review()
    text = format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-001")
    (sample.root / DECOMPOSITION).write_text("".join(line for line in text.splitlines(True) if not line.startswith(lost)))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"sil-lower", "unreadable-input"})


@pytest.mark.verifies("SWR-TRC-022", technique="error_guessing", polarity="violation")
def test_a_record_that_is_given_twice_is_told(sample: Sample, trace: Callable) -> None:
    sample.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    sample.review()
    text = format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-001")
    sample.write(DECOMPOSITION, text + text.partition("\n")[2])

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (1, {"decomposition-unused"})
