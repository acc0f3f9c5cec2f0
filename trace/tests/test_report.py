# SPDX-License-Identifier: Apache-2.0
# Goal: one offline file that leads from hazard to result and back, draws each case, and is the same for the same inputs.
from __future__ import annotations

import json
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import pytest
from trace_sample import Sample, write_large_campaign

from mamori.trace.readers.series import Series, read_series
from mamori.trace.reports.plots import list_bands, pick_samples
from mamori.trace.reports.svg import make_inline

SIZE_BYTES_MAX = 5_000_000


class Page(HTMLParser):
    """Ids, links and anything that would be fetched."""

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


@pytest.mark.verifies("SWR-TRC-012", technique="boundary_values", polarity="nominal")
def test_a_campaign_of_thirty_cases_fits_in_the_page(sample: Sample, write: Callable[[], Page]) -> None:
    write_large_campaign(sample.evidence)

    page = write()

    assert page.text.count('class="plot scroll"') == 30
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

    assert len(chosen) <= 400
    assert {0, 1234, 4321, 4999} <= set(chosen)
    assert pick_samples(values[:400]) == list(range(400))


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
