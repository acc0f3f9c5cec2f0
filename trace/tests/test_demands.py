# SPDX-License-Identifier: Apache-2.0
# Goal: rules for a SIL apply only at that SIL; weak words match only as complete words; a retired id stays retired.
from __future__ import annotations

import subprocess
from collections.abc import Callable

import pytest
from trace_sample import Sample, format_item, format_review

from mamori_trace.checks import weak_word
from mamori_trace.model.words import UNFINISHED_WORDS, WEAK_WORDS
from mamori_trace.readers.project import read_requirements

SOFTWARE = "requirements/software/software.md"
SYSTEM = "requirements/system/system.md"
HEADER = "safety/include/alive.hpp"
TOOL = "tools/offline.py"
IDS = "requirements/ids.lock"
SCHEMA = "requirements/schema/items.toml"
REVIEWS = "requirements/reviews.toml"


@pytest.mark.parametrize(("sil", "rules"), [("QM", set()), ("1", set()), ("2", {"review-missing"}), ("3", {"review-missing", "design-missing"})])
@pytest.mark.verifies("SWR-TRC-023", technique="equivalence_classes", polarity="violation")
def test_each_sil_demands_what_the_shipped_pack_says(sample: Sample, trace: Callable, sil: str, rules: set[str]) -> None:
    sample.append(SYSTEM, format_item("AOU-001", "Clock", "The integrator shall provide a clock.", Parents="STK-001", SIL=sil, Verify="review"))
    sample.review()

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (int(bool(rules)), rules)


@pytest.mark.verifies("SWR-TRC-023", technique="requirements_based", polarity="nominal")
def test_a_recorded_analysis_by_somebody_else_meets_the_demand(sample: Sample, trace: Callable) -> None:
    sample.append(SYSTEM, format_item("AOU-001", "Clock", "The integrator shall provide a clock.", Parents="SYS-001", Verify="analysis"))
    sample.review()
    sample.write(REVIEWS, format_review("AOU-001", read_requirements(sample.root).items["AOU-001"].calc_fingerprint()))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules, outcome.get_verdict("AOU-001")) == (0, set(), "verified")


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"method": "look"}, "'look' is not one of"),
        ({"date": "yesterday"}, "no day of the form"),
        ({"looked_at": ""}, "says no looked_at"),
        ({"reviewer": "Somebody"}, "unknown entry 'reviewer'"),
    ],
)
@pytest.mark.verifies("SWR-TRC-023", technique="error_guessing", polarity="violation")
def test_a_broken_record_is_named_and_shows_nothing(sample: Sample, trace: Callable, changes: dict[str, str], named: str) -> None:
    sample.append(SYSTEM, format_item("AOU-001", "Clock", "The integrator shall provide a clock.", Parents="SYS-001", Verify="analysis"))
    sample.review()
    sample.write(REVIEWS, format_review("AOU-001", "0123456789ab", **changes))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"review-missing", "unreadable-input"})
    assert any(named in finding["message"] and finding["file"] == REVIEWS for finding in outcome.content["findings"])


@pytest.mark.parametrize("word", WEAK_WORDS)
@pytest.mark.verifies("SWR-TRC-024", technique="equivalence_classes", polarity="violation")
def test_each_weak_word_is_found(sample: Sample, word: str) -> None:
    assert find_weak(sample, f"The tool shall stop, {word.upper()}.") == [f"'{word.upper()}'"]


@pytest.mark.parametrize("text", ["stop steadfastly", "keep the breakfast", "run too fast", "show fast-forward", "use Fastnet", "open a slowness log"])
@pytest.mark.verifies("SWR-TRC-024", technique="equivalence_classes", polarity="nominal")
def test_parts_of_words_and_excepted_phrases_are_not_weak(sample: Sample, text: str) -> None:
    assert find_weak(sample, f"The tool shall {text}.") == []


@pytest.mark.verifies("SWR-TRC-024", technique="requirements_based", polarity="nominal")
def test_the_list_of_the_project_replaces_that_of_the_tool(sample: Sample) -> None:
    sample.replace(SCHEMA, 'weak_word_exceptions = ["too fast", "as fast as it can"]', 'weak_words = ["as bold as", "bold"]')

    assert find_weak(sample, "The tool shall be fast.") == []
    assert find_weak(sample, "The tool shall be as bold as a lion.") == ["'as bold as'"]


@pytest.mark.verifies("SWR-TRC-024", technique="equivalence_classes", polarity="nominal")
def test_drafts_and_needs_may_be_weak(sample: Sample) -> None:
    head, _, tail = (sample.root / SOFTWARE).read_text().rpartition("- Status: approved")
    (sample.root / SOFTWARE).write_text(f"{head}- Status: draft{tail}")
    sample.replace("requirements/stakeholder/needs.md", "Engineers need reports.", "Engineers need fast reports.")

    assert find_weak(sample, "The tool shall be fast.") == []


def find_weak(sample: Sample, statement: str) -> list[str]:
    """The words that the rule finds in this statement of SWR-TLS-001."""
    path = sample.root / SOFTWARE
    lines = path.read_text().splitlines(keepends=True)
    at = next(number for number, line in enumerate(lines) if line.startswith("## SWR-TLS-001")) + 2
    path.write_text("".join([*lines[:at], statement + "\n", *lines[at + 1 :]]))
    return [message.split(" says ")[1].split(", which")[0] for _, message, _ in weak_word.check(read_requirements(sample.root))]


@pytest.fixture
def shrunk(sample: Sample) -> Sample:
    """SWR-SUP-002 was committed and then deleted with all references."""
    commit(sample)
    text = (sample.root / SOFTWARE).read_text()
    start = text.index("## SWR-SUP-002")
    (sample.root / SOFTWARE).write_text(text[:start] + text[text.index("## SWR-TLS-001") :])
    sample.replace(HEADER, "/// @satisfies SWR-SUP-002\n", "")
    test = "safety/tests/alive_test.cpp"
    sample.replace(test, '    verifies("SWR-SUP-002");\n', "")
    results = sample.evidence / "junit" / "safety.xml"
    text = results.read_text()
    results.write_text(text[: text.index('    <testcase name="LatenessIsReported/0"')] + text[text.index("  </testsuite>") :])
    return sample


def commit(sample: Sample) -> None:
    git = ["git", "-C", str(sample.root), "-c", "user.name=Sample", "-c", "user.email=sample@example.org"]
    subprocess.run([*git, "init", "--quiet"], check=True)
    subprocess.run([*git, "add", "requirements"], check=True)
    subprocess.run([*git, "commit", "--quiet", "--message", "Sample"], check=True)


@pytest.mark.verifies("SWR-TRC-025", technique="requirements_based", polarity="nominal")
def test_a_deleted_id_is_told_until_it_is_recorded(shrunk: Sample, trace: Callable) -> None:
    rules = {finding["rule"] for finding in run_check(shrunk, trace)}
    recorded = trace("review", "SWR-SUP-002", "--by", "Somebody", "--root", shrunk.root)

    assert rules == {"id-unrecorded"}
    assert recorded.status == 0 and "SWR-SUP-002" in recorded.out
    assert (shrunk.root / IDS).read_text().splitlines()[1].endswith(" Late")
    assert run_check(shrunk, trace) == []


@pytest.mark.verifies("SWR-TRC-025", technique="requirements_based", polarity="violation")
def test_a_deleted_id_that_comes_back_is_told_unless_it_is_the_old_item(shrunk: Sample, trace: Callable) -> None:
    trace("review", "SWR-SUP-002", "--by", "Somebody", "--root", shrunk.root)
    shrunk.append(SOFTWARE, format_item("SWR-SUP-002", "Torque", "The supervision shall cut the torque.", Parents="SYS-001"))
    shrunk.review()
    taken = {(finding["rule"], finding["file"]) for finding in run_check(shrunk, trace)}
    text = (shrunk.root / SOFTWARE).read_text()
    head = text[: text.index("## SWR-SUP-002")]
    old = format_item("SWR-SUP-002", "Late", "The supervision shall report a late entity.", Parents="SYS-001")
    (shrunk.root / SOFTWARE).write_text(head + old)
    restored = {finding["rule"] for finding in run_check(shrunk, trace)}

    assert ("id-reused", SOFTWARE) in taken
    assert "id-reused" not in restored


@pytest.mark.verifies("SWR-TRC-025", technique="error_guessing", polarity="violation")
def test_a_cut_line_of_the_ledger_is_told(sample: Sample, trace: Callable) -> None:
    (sample.root / IDS).write_text("# head\nSWR-SUP-009 0123456789ab\n")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, [(f["file"], f["line"]) for f in outcome.content["findings"]]) == (2, [(IDS, 2)])


def run_check(sample: Sample, trace: Callable) -> list[dict]:
    """Findings except those about the commit of the evidence."""
    findings = trace("check", "--root", sample.root, "--output", "json").content["findings"]
    return [finding for finding in findings if finding["rule"] != "evidence-stale"]


@pytest.mark.parametrize("word", UNFINISHED_WORDS)
@pytest.mark.verifies("SWR-TRC-010", technique="equivalence_classes", polarity="violation")
def test_each_unfinished_word_is_found(sample: Sample, trace: Callable, word: str) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run offline.", f"The tool shall run offline, {word}.")
    sample.review()

    assert trace("check", "--root", sample.root, "--output", "json").rules == {"unfinished-text"}


@pytest.mark.parametrize("words", ['["later"]', "[]"])
@pytest.mark.verifies("SWR-TRC-010", technique="boundary_values", polarity="nominal")
def test_unfinished_words_of_the_project_replace_those_of_the_tool(sample: Sample, trace: Callable, words: str) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run offline.", "The dummy shall run offline.")
    sample.replace(SCHEMA, "weak_word_exceptions", f"unfinished_words = {words}\nweak_word_exceptions")
    sample.review()

    assert trace("check", "--root", sample.root).status == 0
