# SPDX-License-Identifier: Apache-2.0
# Goal: the page shows real-time measurements with every mark; an invalid record or picture does not affect the others.
from __future__ import annotations

import base64
import copy
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from sample_records import TIMING
from trace_sample import COMMIT, ENVIRONMENT, Sample

from mamori_trace.readers.timing import PICTURE_BYTES_MAX
from mamori_trace.reports.timing_view import PICTURES_BYTES_MAX, format_us

PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(200)) + b"\0\0\0\0IEND\xaeB`\x82"
SVG = b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg"><script>alert("x")</script>' + b" " * 400 + b"</svg>\n"


@pytest.fixture
def folder(sample: Sample) -> Path:
    """The location of one measurement."""
    path = sample.evidence / "timing" / "safe_arm"
    path.mkdir(parents=True)
    return path


@pytest.fixture
def report(sample: Sample, trace: Callable, folder: Path) -> Callable[..., tuple[str, Any]]:
    """Stores a record or a text and writes the report. Returns the section "Timing" and the outcome."""

    def run(record: object = TIMING) -> tuple[str, Any]:
        (folder / "timing.json").write_text(record if isinstance(record, str) else json.dumps(record), encoding="utf-8")
        outcome = trace("report", "--root", sample.root, "--output", "json")
        page = (sample.root / "report" / "index.html").read_text(encoding="utf-8")
        section = page[page.index('<section id="timing"') : page.index('<section id="matrix"')]
        return re.sub(' data-head="[^"]*"', "", section), outcome

    return run


@pytest.mark.verifies("SWR-TRC-015", technique="requirements_based", polarity="nominal")
def test_the_page_shows_what_was_measured(report: Callable) -> None:
    section, outcome = report()

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    for part in (
        "no findings", "2000 cycles of 1000 µs", "8.51 µs", "priority granted", "6.18 (PREEMPT_RT)", "0.12 %",  # head
        "unknown, 2400 MHz", "Sample CPU, 2 cores",  # environment
        '<td class="num first">15.8</td>', '<td class="num">8656</td>', '<td class="num bad">−776.6</td>', '<td class="num first bad">11</td>',
        "0.0153", ">0.87<",  # component
        "arm_reader &gt; drive_gate", "800 to 900", ">1900<", "feedback is not followed",  # chain
        "Missed and overrun openings: 13", "released after its planned close", ">code<", "12 openings missed and 0 cut short",
        "1 given, 1 refused", "exceeded with 1e-06 per opening: 4.32 µs", "the openings are not independent",
    ):  # fmt: skip
        assert part in section, part
    assert "PARTIAL" not in section
    assert "refused:" not in section


@pytest.mark.verifies("SWR-TRC-015", technique="requirements_based", polarity="nominal")
def test_the_section_is_in_the_navigation_and_tells_how_to_measure_where_nothing_was(sample: Sample, trace: Callable) -> None:
    trace("report", "--root", sample.root)

    page = (sample.root / "report" / "index.html").read_text()

    assert '<a href="#timing">Timing</a>' in page
    assert "<code>./mamori timing examples/safe_arm</code> measures one" in page


@pytest.mark.verifies("SWR-TRC-015", technique="fault_injection", polarity="violation")
def test_partial_runs_refused_rights_findings_and_other_commits_are_marked(report: Callable) -> None:
    record = copy.deepcopy(TIMING)
    record.update(exit_status=1, is_partial=True, marks=["PARTIAL: stopped after 7 of 2000 cycles"], findings=["the load ended early"])
    record["cycles"]["run"] = 7
    record["rights"]["priority"] = {"is_granted": False, "errno": 1}
    record["environment"] = ENVIRONMENT | {"commit": COMMIT[::-1]}

    section, outcome = report(record)

    assert outcome.status == 0
    for part in ('<span class="badge failed">1 finding</span>', '<span class="badge incomplete">PARTIAL</span>', ">rights denied<",
                 '<p class="mark">PARTIAL: stopped after 7 of 2000 cycles</p>', "7 of 2000 cycles", "priority denied: Operation not permitted",
                 "of another commit"):  # fmt: skip
        assert part in section, part
    assert section.index("the load ended early") < section.index("Windows: plan")


@pytest.mark.verifies("SWR-TRC-015", technique="boundary_values", polarity="nominal")
def test_twenty_misses_are_shown_and_all_are_counted(report: Callable) -> None:
    misses = [TIMING["misses"][0] | {"cycle": 7000 + number} for number in range(21)]

    section, _ = report(TIMING | {"misses": misses, "miss_count": 12_345})

    assert ">7019<" in section
    assert ">7020<" not in section
    assert "The first 20 of 12345" in section


@pytest.mark.verifies("SWR-TRC-015", technique="error_guessing", polarity="violation")
def test_markup_in_names_is_shown_and_not_run(report: Callable) -> None:
    bad = '<img src=x onerror="alert(1)">'
    text = json.dumps(TIMING)
    for name in ("safe_arm", "protect", "arm_reader", "priority", "6.18", "missed\"", "Safe", "not independent"):
        text = text.replace(name, json.dumps(bad)[1:-1] + (name if name.endswith('"') else ""))

    section, outcome = report(text)

    assert outcome.rules == {"unreadable-input"}  # the reader needs the name of the outcome 'missed'
    text = text.replace(json.dumps(bad)[1:-1] + 'missed"', 'missed"')
    section, outcome = report(text)
    assert outcome.status == 0
    assert "onerror" in section
    assert "<img" not in section


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"frame_ns": 1000000', '"frame_ns": ', "is not whole JSON"),
        ("mamori.timing/1", "mamori.timing/2", "schema is 'mamori.timing/2'"),
        ('"miss_count": 13, ', "", "miss_count is missing"),
        ('"core": 0, ', "", "windows[0].core is missing"),
        ('"core": 0', '"core": true', "windows[0].core is not an integer"),
        ('"core": 0', f'"core": {2**63}', "windows[0].core is not an integer"),
        ('"core": 0', f'"core": 1{"0" * 5000}', "number that is too long"),
        ('"p50": 15765', '"p50": 15765.5', "windows[0].lateness.p50 is not an integer"),
        ('"steal_share": 0.0012', '"steal_share": NaN', "host.steal_share is no number"),
        ('"steal_share": 0.0012', '"steal_share": "none"', "host.steal_share is no number"),
        ('"system": "safe_arm"', '"system": "\\ud800"', "system is no text"),
        ('"system": "safe_arm"', '"system": null', "system is no text"),
        ('"is_partial": false', '"is_partial": 0', "is_partial is no truth value"),
        ('"marks": []', '"marks": {}', "marks is no list"),
        ('"rights": {', '"rights": {"x": 1, ', "rights.x is no table"),
        ('"cpu": ', '"gpu": ', "environment.cpu is missing"),
        ('{"schema"', '[{"schema"', "is not whole JSON"),
    ],
)
@pytest.mark.verifies("SWR-TRC-016", technique="fault_injection", polarity="violation")
def test_a_broken_record_is_one_problem_and_the_page_is_written(
    report: Callable, folder: Path, old: str, new: str, message: str
) -> None:
    good = folder.parent / "good"
    good.mkdir()
    (good / "timing.json").write_text(json.dumps(TIMING))
    text = json.dumps(TIMING)
    assert old in text

    section, outcome = report(text.replace(old, new, 1))

    assert outcome.status == 2
    assert [finding["rule"] for finding in outcome.content["findings"]] == ["unreadable-input"]
    assert outcome.content["findings"][0]["file"].endswith("timing/safe_arm/timing.json")
    assert message in outcome.content["findings"][0]["message"]
    assert "safe_arm in good" in section
    assert section.count("<article") == 1


@pytest.mark.verifies("SWR-TRC-016", technique="equivalence_classes", polarity="nominal")
def test_a_record_with_more_in_it_than_the_page_shows_is_whole(report: Callable) -> None:
    section, outcome = report(TIMING | {"later": {"added": [1]}})

    assert outcome.status == 0
    assert section.count("<article") == 1


@pytest.mark.parametrize("cut", [0, 1, 200, 2000])
@pytest.mark.verifies("SWR-TRC-016", technique="fault_injection", polarity="violation")
def test_a_record_that_is_cut_off_gives_nothing_and_one_problem(report: Callable, cut: int) -> None:
    section, outcome = report(json.dumps(TIMING)[:cut])

    assert [finding["rule"] for finding in outcome.content["findings"]] == ["unreadable-input"]
    assert "<article" not in section


@pytest.mark.verifies("SWR-TRC-016", technique="error_guessing", polarity="violation")
def test_a_record_that_cannot_be_opened_is_one_problem(sample: Sample, trace: Callable, folder: Path) -> None:
    (folder / "timing.json").mkdir()

    outcome = trace("report", "--root", sample.root, "--output", "json")

    assert [finding["rule"] for finding in outcome.content["findings"]] == ["unreadable-input"]


@pytest.mark.verifies("SWR-TRC-015", technique="requirements_based", polarity="nominal")
def test_the_smaller_of_both_pictures_stands_in_the_page_as_data(report: Callable, folder: Path) -> None:
    (folder / "execution_time.png").write_bytes(PNG)
    (folder / "execution_time.svg").write_bytes(SVG)
    (folder / "chain_latency.svg").write_bytes(SVG)

    section, outcome = report()

    assert outcome.status == 0
    assert section.count("<img src=") == 2
    assert f'src="data:image/png;base64,{base64.b64encode(PNG).decode()}"' in section
    assert f'src="data:image/svg+xml;base64,{base64.b64encode(SVG).decode()}"' in section
    assert "alert(" not in section


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (PNG[:-1], "release_lateness.png is no whole picture"),
        (b"<html>" + PNG[6:], "release_lateness.png is no whole picture"),
        (b"", "release_lateness.png is no whole picture"),
        (SVG[:-4], "release_lateness.png is no whole picture"),
    ],
)
@pytest.mark.verifies("SWR-TRC-016", technique="boundary_values", polarity="violation")
def test_a_picture_that_cannot_be_shown_is_told_in_its_place(report: Callable, folder: Path, content: bytes, message: str) -> None:
    (folder / "release_lateness.png").write_bytes(content)
    (folder / "execution_time.png").write_bytes(PNG)

    section, outcome = report()

    assert [finding["rule"] for finding in outcome.content["findings"]] == ["unreadable-input"]
    assert message in outcome.content["findings"][0]["message"]
    assert message in section
    assert section.count("<img src=") == 1


@pytest.mark.parametrize(("size", "shown"), [(PICTURE_BYTES_MAX * 3 // 4 - 18, 1), (PICTURE_BYTES_MAX * 3 // 4 - 15, 0)])
@pytest.mark.verifies("SWR-TRC-015", technique="boundary_values", polarity="nominal")
def test_a_picture_above_the_limit_is_named_and_no_problem(report: Callable, folder: Path, size: int, shown: int) -> None:
    (folder / "release_lateness.png").write_bytes(PNG[:-8] + bytes(size - len(PNG)) + PNG[-8:])

    section, outcome = report()

    assert outcome.status == 0
    assert section.count("<img src=") == shown
    assert ("release_lateness.png would take" in section) is not bool(shown)


@pytest.mark.verifies("SWR-TRC-015", technique="boundary_values", polarity="nominal")
def test_pictures_of_many_systems_are_left_out_before_the_page_grows_too_large(report: Callable, folder: Path) -> None:
    large = PNG[:-8] + bytes(PICTURE_BYTES_MAX * 3 // 4 - 300) + PNG[-8:]
    for system in ("a", "b", "c"):
        other = folder.parent / system
        other.mkdir()
        (other / "timing.json").write_text(json.dumps(TIMING))
        (other / "chain_latency.png").write_bytes(large)

    section, outcome = report()

    assert outcome.status == 0
    assert section.count("<img src=") == PICTURES_BYTES_MAX // PICTURE_BYTES_MAX
    assert "chain_latency.png would take" in section


@pytest.mark.parametrize(
    ("ns", "text"),
    [(None, "–"), (0, "0"), (30, "0.03"), (1234, "1.23"), (15_765, "15.8"), (300_000, "300"), (-776_601, "-776.6"), (1_076_601, "1077")],
)
@pytest.mark.verifies("SWR-TRC-015", technique="equivalence_classes", polarity="nominal")
def test_times_have_the_digits_that_count(ns: int | None, text: str) -> None:
    assert format_us(ns) == text
