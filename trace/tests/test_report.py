# SPDX-License-Identifier: Apache-2.0
# Goal: one offline file leads from hazard to result and back, and draws each case; equal inputs give equal bytes.
from __future__ import annotations

import json
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import pytest
from trace_sample import Sample, write_large_campaign

from mamori_trace.readers.campaign import make_case
from mamori_trace.readers.series import Series, read_series
from mamori_trace.reports.case_page import write_case_page
from mamori_trace.reports.plots import POINTS_MAX, Marks, draw_case, list_bands, pick_samples
from mamori_trace.reports.svg import make_inline
from mamori_trace.reports.timing_view import ABSENT, Cell, Column, make_table

SIZE_BYTES_MAX = 5_000_000


class Page(HTMLParser):
    """Ids, links and all addresses that a browser would fetch."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.fetched: list[str] = []
        self.text = text
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            elif name == "href" and (value or "").startswith("#"):
                self.links.append((value or "")[1:])
            elif name in ("src", "href", "xlink:href", "srcset", "data", "action") and not (value or "").startswith("data:"):
                self.fetched.append(f"{tag} {name}={value}")


@pytest.fixture
def write(trace: Callable, sample: Sample) -> Callable[[], Page]:
    def run() -> Page:
        out = sample.root / "report" / "index.html"
        trace("report", "--root", sample.root)
        return Page(out.read_text(encoding="utf-8"))

    return run


@pytest.mark.verifies("SWR-TRC-011", technique="requirements_based", polarity="nominal")
def test_every_link_of_the_page_leads_to_one_place_in_the_page(write: Callable[[], Page]) -> None:
    page = write()

    assert page.fetched == []
    assert len(page.ids) == len(set(page.ids))
    assert set(page.links) <= set(page.ids)


@pytest.mark.verifies("SWR-TRC-011", technique="requirements_based", polarity="nominal")
def test_the_page_leads_from_hazard_to_result_and_back(write: Callable[[], Page]) -> None:
    text = write().text
    item = text[text.index('id="item/SWR-SUP-001"') : text.index('id="item/SWR-SUP-002"')]
    hazard = text[text.index('id="item/HAZ-001"') : text.index('id="item/SYS-001"')]

    for part in ('href="#item/HAZ-001"', 'href="#item/SYS-001"', "safety/include/alive.hpp:5", "AliveTest.SilenceIsReported", "passed"):
        assert part in item
    for part in ('href="#item/SYS-001"', 'href="#item/SWR-SUP-001"'):
        assert part in hazard


@pytest.mark.verifies("SWR-TRC-011", technique="error_guessing", polarity="nominal")
def test_texts_of_inputs_are_shown_and_not_run(sample: Sample, write: Callable[[], Page]) -> None:
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", '## SYS-003 <script>alert("x")</script>')

    text = write().text

    assert "<script>alert" not in text
    assert "&lt;script&gt;alert" in text


@pytest.mark.verifies("SWR-TRC-013", technique="requirements_based", polarity="nominal")
def test_the_same_inputs_give_the_same_bytes(sample: Sample, write: Callable[[], Page]) -> None:
    first = write().text

    assert write().text == first


@pytest.mark.verifies("SWR-TRC-011", technique="error_guessing", polarity="nominal")
def test_an_old_report_stays_when_the_new_one_cannot_be_written(sample: Sample, trace: Callable) -> None:
    out = sample.root / "report" / "index.html"
    out.mkdir(parents=True)

    outcome = trace("report", "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert [path.name for path in out.parent.iterdir()] == ["index.html"]


@pytest.mark.verifies("SWR-TRC-012", technique="requirements_based", polarity="nominal")
def test_each_case_has_a_figure_with_fault_reaction_and_limit_marked(write: Callable[[], Page]) -> None:
    text = write().text
    case = text[text.index('id="case-1-encoder_freeze-1"') :]

    for part in ("<svg", "fault 2.000 s", "reaction 2.010 s", "standstill 2.310 s", ">limit<", "Operational", "Safe", ">J7<"):
        assert part in case


def make_series(times_s: list[float]) -> Series:
    rows = [[0.001 * joint * time_s for time_s in times_s] for joint in range(7)]
    return Series(times_s, rows, rows, ["Operational"] * len(times_s))


@pytest.mark.parametrize(
    ("fault_s", "captions"),
    [(None, ["Whole run"]), (0.5, ["Whole run", "100 ms around the fault, from 0.480 s to 0.580 s"]),
     (0.0, ["Whole run", "100 ms around the fault, from -0.020 s to 0.080 s"]), (1.0, ["Whole run", "100 ms around the fault, from 0.980 s to 1.080 s"]),
     (-0.001, ["Whole run"]), (1.001, ["Whole run"])],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-111", technique="boundary_values", polarity="nominal")
def test_a_fault_inside_the_run_is_drawn_again_with_the_100_ms_around_it(fault_s: float | None, captions: list[str]) -> None:
    series = make_series([0.001 * step for step in range(1001)])

    drawings = draw_case(series, Marks(fault_s, None, None, [1.0] * 7, 2), "p", "a case")

    assert [drawing.caption for drawing in drawings] == captions
    # Same time base: the axes of both drawings have the same label, and the ticks of the near drawing are inside its 100 ms.
    assert all("time since the start of the run [s]" in drawing.svg for drawing in drawings)
    for drawing in drawings[1:]:
        assert fault_s is not None
        ticks = [float(text) for text in re.findall(r">(-?\d\.\d{3})<", drawing.svg.replace("\u2212", "-"))]
        assert len(ticks) >= 4 and all(fault_s - 0.0205 <= tick <= fault_s + 0.0805 for tick in ticks)


@pytest.mark.verifies("SWR-TRC-112", technique="interface", polarity="nominal")
def test_one_case_is_a_page_of_its_own(sample: Sample, tmp_path: Path) -> None:
    folder = sample.evidence / "campaign"
    row = json.loads((folder / "campaign.json").read_text())["cases"][1]
    out = tmp_path / "case.html"

    view = write_case_page(make_case(row), folder, out)

    text = out.read_text()
    assert view.plot_problem == ""
    for part in ("encoder_freeze-1", "Whole run", "100 ms around the fault", "hold drift", row["requirements"][0]):
        assert part in text
    assert 'href="#' not in re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)


@pytest.mark.verifies("SWR-TRC-112", technique="error_guessing", polarity="violation")
def test_a_failed_case_without_a_series_still_has_its_page_with_the_reason(sample: Sample, tmp_path: Path) -> None:
    folder = sample.evidence / "campaign"
    row = json.loads((folder / "campaign.json").read_text())["cases"][1]
    row["verdict"], row["checks"][0]["passed"], row["folder"] = "fail", False, "absent"

    view = write_case_page(make_case(row), folder, tmp_path / "case.html")

    text = (tmp_path / "case.html").read_text()
    assert "series.csv cannot be read" in view.plot_problem
    assert f"No plot: {view.plot_problem}" in text
    assert "final state: expected Safe, measured Safe" in text


@pytest.mark.verifies("SWR-TRC-110", technique="boundary_values", polarity="violation")
def test_a_column_in_which_no_row_has_a_value_is_left_out() -> None:
    columns = (Column("a"), Column("b", "group"), Column("c", "group"))

    def make(row: dict[str, str]) -> list[Cell]:
        return [Cell(row["a"]), Cell(row["b"]), Cell(row["c"])]

    rows = [{"a": "1", "b": ABSENT, "c": "0"}, {"a": "2", "b": "", "c": ABSENT}]
    assert [column.head for column in make_table("t", columns, rows, make).columns] == ["a", "c"]
    rows[1]["b"] = "3"
    assert make_table("t", columns, rows, make).columns == columns
    assert make_table("t", columns, [], make).columns == columns


@pytest.mark.verifies("SWR-TRC-012", technique="boundary_values", polarity="nominal")
def test_a_campaign_of_thirty_cases_fits_in_the_page(sample: Sample, write: Callable[[], Page]) -> None:
    write_large_campaign(sample.evidence)

    page = write()

    assert page.text.count('aria-label="Whole run of ') == 30
    assert len(page.text.encode()) < SIZE_BYTES_MAX
    assert len(page.ids) == len(set(page.ids))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [("t_s,", "time,", "'t_s'"), ("\n0.01,", "\nzero,", "line 3"), ("\n0.02,", "\n0.005,", "line 4"), ("\n0.01,", "\nnan,", "line 3")],
)
@pytest.mark.verifies("SWR-TRC-012", technique="error_guessing", polarity="nominal")
def test_a_series_that_cannot_be_drawn_is_told_and_the_page_is_written(
    sample: Sample, trace: Callable, old: str, new: str, message: str
) -> None:
    series = sample.evidence / "campaign" / "encoder_freeze-1" / "series.csv"
    series.write_text(series.read_text().replace(old, new, 1))

    outcome = trace("report", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"unreadable-input"})
    assert message in outcome.content["findings"][0]["message"]
    assert "No plot" in (sample.root / "report" / "index.html").read_text()


@pytest.mark.parametrize(
    "run",
    [{}, {"fault": "x", "physics": [1]}, {"fault": {"at_s": "now"}, "reacted_at_s": [1], "physics": {"stop_travel_rad": ["z"]}}],
)
@pytest.mark.verifies("SWR-TRC-012", technique="error_guessing", polarity="nominal")
def test_a_run_that_lacks_its_facts_is_shown_without_them(sample: Sample, trace: Callable, run: dict) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["run"] = run
    path.write_text(json.dumps(content))
    (sample.evidence / "environment.json").write_text(json.dumps({"schema": "mamori.environment/1", "commit": "0123456789ab"}))

    outcome = trace("report", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"unreadable-input"})
    assert "tells no speed limits" in outcome.content["findings"][0]["message"]


@pytest.mark.verifies("SWR-TRC-012", technique="equivalence_classes", polarity="nominal")
def test_an_arm_that_went_on_has_no_stop_travel(sample: Sample, write: Callable[[], Page]) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["run"]["physics"].update(stop_travel_rad=[0.123456] * 7, hold_drift_rad=0.0234)
    path.write_text(json.dumps(content))
    before = write().text
    assert "123.5 mrad" in before
    assert "23.4 mrad" in before
    content["cases"][1]["run"].update(reacted_at_s=None, standstill_at_s=None)
    path.write_text(json.dumps(content))

    text = write().text

    assert "123.5 mrad" not in text
    assert "23.4 mrad" not in text


@pytest.mark.verifies("SWR-TRC-012", technique="boundary_values", polarity="nominal")
def test_thinning_keeps_the_ends_and_the_peaks() -> None:
    values = [0.0] * 5000
    values[1234] = 9.0
    values[4321] = -9.0

    chosen = pick_samples(values)

    assert len(chosen) <= POINTS_MAX
    assert {0, 1234, 4321, 4999} <= set(chosen)
    assert pick_samples(values[:POINTS_MAX]) == list(range(POINTS_MAX))


@pytest.mark.verifies("SWR-TRC-012", technique="requirements_based", polarity="nominal")
def test_states_become_bands_without_gaps(sample: Sample) -> None:
    series: Series = read_series(sample.evidence / "campaign" / "encoder_freeze-1" / "series.csv")

    bands = list_bands(series)

    assert [band[0] for band in bands] == ["SelfTest", "Operational", "ProtectiveStopSs1", "Safe"]
    assert [band[1] for band in bands[1:]] == [band[2] for band in bands[:-1]]


@pytest.mark.verifies("SWR-TRC-012", technique="requirements_based", polarity="nominal")
def test_ids_inside_a_drawing_get_its_prefix() -> None:
    svg = '<?xml?><svg width="1" height="2"><metadata>x</metadata><g id="unused"/><path id="a" d="M 1.04 2.06 \nL 3 4"/><use xlink:href="#a"/></svg>'

    assert make_inline(svg, "p", "l") == (
        '<svg role="img" aria-label="l"><g/><path id="p-0" d="M1 2.1L3 4"/><use href="#p-0"/></svg>'
    )
    assert not re.search(r"xlink|metadata", make_inline(svg, "p", "l"))


@pytest.mark.verifies("SWR-TRC-011", technique="error_guessing", polarity="nominal")
def test_a_project_without_any_evidence_gives_a_page_that_says_so(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (sample.root / "build").rename(tmp_path / "away")

    outcome = trace("report", "--root", sample.root, "--allow-missing")

    page = Page((sample.root / "report" / "index.html").read_text())
    assert outcome.status == 0
    assert set(page.links) <= set(page.ids)
    assert "No campaign was run." in page.text
