# SPDX-License-Identifier: Apache-2.0
# Goal: the page data are complete, safe and small; without a script, all rows are plain HTML; git supplies the history.
from __future__ import annotations

import base64
import hashlib
import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from large_project import make_large_project
from trace_sample import Sample, format_waiver

from mamori_trace.base.errors import WorkError
from mamori_trace.base.finding import Place
from mamori_trace.checks import list_rule_ids
from mamori_trace.model.code import Function
from mamori_trace.model.coverage import Condition, CoverageRun, FileCoverage
from mamori_trace.model.technique import Technique
from mamori_trace.model.verdict import calc_verdicts
from mamori_trace.readers.item_history import CHANGES_MAX, find_changes, read_item_history
from mamori_trace.readers.project import read_project
from mamori_trace.reports import v_overview
from mamori_trace.reports.html import write_report
from mamori_trace.reports.inline_json import format_inline

SIZE_BYTES_MAX = 30_000_000
HOSTILE = ("</script><script>alert(1)</script>", "</noscript><img src=x onerror=alert(1)>", "<!--<script>", "]]>\u2028\u2029", '" onload="x', "&lt;b&gt;")
DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)


@pytest.fixture
def page(trace: Callable, sample: Sample) -> Callable[[], str]:
    def run() -> str:
        trace("report", "--root", sample.root)
        return (sample.root / "report" / "index.html").read_text(encoding="utf-8")

    return run


def read_data(text: str) -> dict[str, Any]:
    match = DATA.search(text)
    assert match
    return json.loads(match[1])


@pytest.mark.verifies("SWR-TRC-060", technique="requirements_based", polarity="nominal")
def test_the_data_names_items_with_their_links_results_code_cases_and_findings(sample: Sample, page: Callable[[], str]) -> None:
    sample.replace("requirements/software/software.md", "Parents: SYS-001, HAZ-001", "Parents: SYS-001, HAZ-009")

    data = read_data(page())

    number = data["items"]["id"].index("SWR-SUP-001")
    assert data["items"]["parents"][number] == [data["items"]["id"].index("SYS-001"), "HAZ-009"]
    assert [data["results"]["name"][row] for row, item in enumerate(data["results"]["item"]) if item == number] == [
        "SilenceIsNotHealedByOneReport", "SilenceIsReported"]  # fmt: skip
    assert [data["files"][data["tags"]["file"][row]] for row, item in enumerate(data["tags"]["item"]) if item == number] == ["safety/include/alive.hpp"]
    assert [case[0] for case in data["cases"]] == ["encoder_freeze-1", "no_fault-1"]
    assert "unknown-id" in data["findings"]["rule"]
    assert {row[0] for row in data["rules"]} >= set(data["findings"]["rule"])


@pytest.mark.verifies("SWR-TRC-060", technique="requirements_based", polarity="nominal")
def test_boxes_of_the_v_and_bars_of_the_dashboard_lead_to_their_rows(page: Callable[[], str]) -> None:
    text = page()

    for part in ('href="#matrix" data-query="level=STK&amp;level=HAZ&amp;level=SG"', 'href="#tests" data-query="kind=unit"',
                 'href="#matrix" data-query="level=SYS&amp;verdict=verified"', 'href="#tests" data-query="kind=unit&amp;status=passed"',
                 'data-query="sil=2">SIL 2</a> <span class="note"><b>5</b> of 5 verified',
                 'data-query="sil=QM">QM</a> <span class="note"><b>3</b> of 3 verified'):  # fmt: skip
        assert part in text, part


@pytest.mark.parametrize("layout", v_overview.LAYOUTS)
@pytest.mark.verifies("SWR-TRC-060", technique="boundary_values", polarity="violation")
def test_one_failure_among_thousands_is_seen_in_the_bar_of_the_v(tmp_path: Path, layout: v_overview.Layout) -> None:
    project = make_large_project(tmp_path, 100, 3000)
    for result in project.results:
        result.status = "passed"
        result.kind = "unit"
    project.results[0].status = "failed"

    box = next(box for box in v_overview.make_boxes(project, calc_verdicts(project), layout) if box.name == "Unit tests")

    assert (box.count, box.detail) == ("3,000", "1 failed")
    assert [segment.css for segment in box.segments] == ["passed", "failed"]
    assert min(segment.width for segment in box.segments) >= 4
    assert sum(segment.width for segment in box.segments) == pytest.approx(layout.bar_width, abs=0.02)


def list_answers(text: str) -> dict[str, tuple[str, str]]:
    """Question -> (colour, words of the answer)."""
    blocks = re.findall(r'<div class="answer ([\w-]+)">\s*<h2>(.*?)</h2>(.*?)</ul>', text, re.DOTALL)
    return {question: (css, " ".join(re.sub(r"<[^>]+>", " ", body).split())) for css, question, body in blocks}


@pytest.mark.verifies("SWR-TRC-069", technique="requirements_based", polarity="nominal")
def test_the_first_screen_of_a_whole_project_says_yes_three_times(page: Callable[[], str]) -> None:
    answers = list_answers(page())

    assert list(answers) == ["Is it safe?", "Is it complete?", "What is wrong?"]
    assert {css for css, _ in answers.values()} == {"verified"}, answers
    assert "2 of 2 campaign cases ended as expected" in answers["Is it safe?"][1]
    assert "5 of 5 items with a SIL verified" in answers["Is it safe?"][1]
    assert answers["Is it complete?"][1].startswith("Yes 8 of 8 items verified")
    assert answers["What is wrong?"][1].startswith("No findings")


@pytest.mark.verifies("SWR-TRC-069", technique="equivalence_classes", polarity="violation")
def test_the_first_screen_tells_failures_and_what_was_not_run(sample: Sample, trace: Callable) -> None:
    sample.replace("build/host-release/evidence/junit/tools.xml", 'name="test_no_connection[b]" time="0.001">',
                   'name="test_no_connection[b]" time="0.001"><failure message="no"/>')  # fmt: skip
    (sample.evidence / "junit" / "safety.xml").unlink()

    trace("report", "--root", sample.root, "--allow-missing")

    answers = list_answers((sample.root / "report" / "index.html").read_text())
    assert answers["Is it safe?"][0] == "incomplete" and "Not fully shown" in answers["Is it safe?"][1]
    assert answers["Is it complete?"][0] == "incomplete" and " not run" in answers["Is it complete?"][1]
    assert answers["What is wrong?"] == ("failed", "1 error 1 failed test result-failed: 1 error")


@pytest.mark.verifies("SWR-TRC-069", technique="fault_injection", polarity="violation")
def test_a_failed_campaign_case_is_not_safe_and_only_its_scenario_has_a_bar(sample: Sample, page: Callable[[], str]) -> None:
    assert '<span class="note"><b>1</b> of 1 cases</span>' not in page()  # no failures, so no bar
    path = sample.evidence / "campaign" / "campaign.json"
    content = json.loads(path.read_text())
    content["cases"][1]["verdict"] = "fail"
    path.write_text(json.dumps(content, indent=1))

    text = page()

    answers = list_answers(text)
    assert answers["Is it safe?"][0] == "failed" and answers["Is it safe?"][1].startswith("No 1 of 2 campaign cases")
    assert "1 failed campaign case" in answers["What is wrong?"][1]
    overview = text[text.index('id="overview"') : text.index('id="findings"')]
    scenario = content["cases"][1]["scenario"].replace("_", " ")
    assert re.findall(r'<a class="name" href="#case-[^"]*">([^<]*)</a>', overview) == [scenario]


@pytest.mark.verifies("SWR-TRC-069", technique="boundary_values", polarity="violation")
def test_without_a_campaign_safety_is_not_shown(sample: Sample, page: Callable[[], str]) -> None:
    (sample.evidence / "campaign" / "campaign.json").unlink()

    css, words = list_answers(page())["Is it safe?"]

    assert css == "incomplete" and words.startswith("Not fully shown no fault campaign was run")


@pytest.mark.verifies("SWR-TRC-061", technique="requirements_based", polarity="nominal")
def test_everything_stands_in_plain_rows_for_those_without_scripts(sample: Sample, page: Callable[[], str]) -> None:
    sample.replace("build/host-release/evidence/junit/safety.xml", 'result="completed" time="0.001" classname="Limits/LateTest">',
                   'result="completed" time="0.001" classname="Limits/LateTest"><failure message="too late"/>')  # fmt: skip
    text = re.sub(r"<script.*?</script>", "", page(), flags=re.DOTALL)

    for part in ("The supervision shall report a late entity.", "too late", "SWR-TLS-001", "tools/offline.py", "test_no_connection",
                 "result-failed", 'href="#case-1-encoder_freeze-1"'):  # fmt: skip
        assert part in text, part
    assert text.count("<noscript>") == text.count("</noscript>") >= 4


@pytest.mark.verifies("SWR-TRC-060", technique="requirements_based", polarity="nominal")
def test_findings_of_one_waiver_stand_together_below_its_reason(sample: Sample, page: Callable[[], str]) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run", "The tool runs")
    sample.replace("requirements/system/system.md", "The kernel shall supervise", "The kernel supervises")
    sample.review()
    sample.write("requirements/waivers.toml", format_waiver("shall-count", file="requirements/system/system.md"))

    text = page()

    waived = text[text.index("<h2>Waived</h2>") :].split("</ul>")[0]
    assert waived.count("It is so.") == 1 and 'Accepted by Sample Reviewer: <code class="place">requirements/waivers.toml:3</code>' in waived
    assert [name for name in ("SYS-001", "SYS-002", "SYS-003") if f"#item/{name}" in waived] == ["SYS-001", "SYS-003"]


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.verifies("SWR-TRC-062", technique="error_guessing", polarity="violation")
def test_no_text_gets_out_of_the_data(text: str) -> None:
    inline = format_inline({"title": text})

    assert not set("<>&\u2028\u2029") & set(inline)
    assert json.loads(inline) == {"title": text}


@pytest.mark.parametrize("title", HOSTILE)
@pytest.mark.verifies("SWR-TRC-062", technique="error_guessing", polarity="violation")
def test_hostile_titles_stay_titles(sample: Sample, page: Callable[[], str], title: str) -> None:
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", "## SYS-003 Plain title")
    plain = page()
    sample.replace("requirements/system/system.md", "## SYS-003 Plain title", f"## SYS-003 {title}")

    text = page()

    assert title.split("\u2028")[0] in read_data(text)["items"]["title"][4]
    for tag in ("<script", "</script", "<noscript", "</noscript", "<img", "<!--", '" onload="x'):
        assert text.count(tag) == plain.count(tag), tag


@pytest.mark.verifies("SWR-TRC-062", technique="error_guessing", polarity="nominal")
def test_a_lone_surrogate_in_foreign_json_spoils_nothing(sample: Sample, page: Callable[[], str]) -> None:
    path = sample.evidence / "campaign" / "campaign.json"
    path.write_text(path.read_text().replace('"title": "Fault-free motion"', '"title": "half \\ud800 a pair"'))

    assert "half ? a pair" in page()


@pytest.mark.verifies("SWR-TRC-062", technique="requirements_based", polarity="nominal")
def test_the_policy_allows_the_scripts_of_the_page_and_no_connection(page: Callable[[], str]) -> None:
    text = page()
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)

    assert policy
    assert policy[1].startswith("default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-")
    assert len(scripts) == 2
    for script in scripts:
        assert f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'" in policy[1]
    assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(|fetch\(|XMLHttp", "".join(scripts))


def commit(root: Path, subject: str, date: str) -> None:
    names = {f"GIT_{role}_{part}": value for role in ("AUTHOR", "COMMITTER")
             for part, value in (("NAME", "The maintainers"), ("EMAIL", "m@example.org"), ("DATE", date))}  # fmt: skip
    for arguments in (("add", "requirements"), ("commit", "-q", "-m", subject)):
        subprocess.run(["git", "-C", str(root), "-c", "commit.gpgsign=false", *arguments], check=True, env={"PATH": "/usr/bin:/bin", **names})


@pytest.mark.verifies("SWR-TRC-063", technique="requirements_based", polarity="nominal")
def test_each_item_tells_the_commits_that_changed_it_the_newest_first(sample: Sample, page: Callable[[], str]) -> None:
    subprocess.run(["git", "init", "-q", str(sample.root)], check=True)
    commit(sample.root, "Write all", "2026-01-02T03:04:05+00:00")
    sample.replace("requirements/software/software.md", "shall report a late entity", "shall report each late entity")
    commit(sample.root, "Say <each>", "2026-02-03T04:05:06+00:00")

    data = read_data(page())

    history = {data["items"]["id"][int(number)]: [data["commits"][at][1:] for at in rows] for number, rows in data["history"].items()}
    assert history["SWR-SUP-002"] == [["2026-02-03", "Say <each>"], ["2026-01-02", "Write all"]]
    assert history["SWR-SUP-001"] == history["SWR-TLS-001"] == history["STK-001"] == [["2026-01-02", "Write all"]]


@pytest.mark.verifies("SWR-TRC-063", technique="error_guessing", polarity="nominal")
def test_without_git_there_is_no_history_and_no_complaint(sample: Sample, page: Callable[[], str]) -> None:
    assert read_item_history(sample.root / "absent") == {}
    assert read_data(page())["history"] == {}


@pytest.mark.verifies("SWR-TRC-063", technique="boundary_values", polarity="nominal")
def test_the_history_of_an_item_is_bounded_and_odd_lines_do_no_harm() -> None:
    lines = ["noise", "+## SYS-001 before any commit", "\x1eonly a hash", "@@ -1 +1 @@", "+text above every item"]
    for number in range(CHANGES_MAX + 5):
        lines += [f"\x1e{number}\x1f2026-01-01\x1fsubject", "diff --git a/x b/x", "--- a/x", "+++ b/x",
                  "@@ -1 +1 @@ ## SYS-001 Title", "-a", "+b", "+", "+## SYS-002 X"]  # fmt: skip

    changes = find_changes(lines)

    assert list(changes) == ["SYS-001", "SYS-002"]
    assert [change.commit for change in changes["SYS-001"]] == [str(number) for number in range(CHANGES_MAX)]


@pytest.mark.verifies("SWR-TRC-060", technique="interface", polarity="nominal")
def test_waived_findings_stand_on_the_page_with_their_reasons(sample: Sample, page: Callable[[], str]) -> None:
    sample.replace("requirements/software/software.md", "Parents: SYS-001, HAZ-001", "Parents: SYS-001, HAZ-009")
    (sample.root / "requirements" / "waivers.toml").write_text(
        'schema = "mamori.waivers/1"\n[[waiver]]\nrule = "unknown-id"\nfile = "requirements/software/software.md"\nreason = "the hazard is being <written>"\n'
        'by = "the maintainers"\n')  # fmt: skip

    text = page()

    assert "<p>the hazard is being &lt;written&gt;</p>" in text and "Accepted by the maintainers: " in text
    assert "unknown-id" not in read_data(text)["findings"]["rule"]


@pytest.mark.verifies("SWR-TRC-064", technique="interface", polarity="nominal")
def test_coverage_and_techniques_stand_on_the_page_where_the_project_offers_them(sample: Sample) -> None:
    project = read_project(sample.root, None, list_rule_ids())
    owners = ("SWR-SUP-001", "SWR-OLD-001")
    project.functions = [Function("safety/src/alive.cpp", "step", 7, 9, 7, owners), Function("safety/src/alive.cpp", "stop", 11, 12, 11, owners)]
    covered = FileCoverage({7: 1, 8: 0, 9: 1, 11: 0}, branches={8: (3, 4)}, conditions={(8, 1): Condition("late", True), (8, 2): Condition("silent", False)})
    project.evidence.coverage_runs = [CoverageRun(Place("coverage.json", 1), "", {"safety/src/alive.cpp": covered})]
    project.techniques = [Technique("Limits on both sides", "Annex Z", "unit test", (), ("interface",), (), Place("techniques.toml", 1))]

    write_report(project, sample.root / "page.html")

    text = (sample.root / "page.html").read_text()
    data = read_data(text)
    number = data["items"]["id"].index("SWR-SUP-001")
    file = data["files"].index("safety/src/alive.cpp")
    assert data["coverage"] == {str(number): [["stop", file, 11, False, [0, 1], [0, 0], [0, 0], [], ""],
                                              ["step", file, 7, True, [2, 3], [3, 4], [1, 2], [[8, "silent", ""]], ""]]}  # fmt: skip
    assert "<td>Limits on both sides</td><td>Annex Z; unit test</td><td>interface: 2 passed results</td>" in text


@pytest.mark.verifies("SWR-TRC-064", technique="equivalence_classes", polarity="nominal")
def test_techniques_are_counted_from_results_where_the_project_offers_none(page: Callable[[], str]) -> None:
    text = page()

    assert "<td>requirements based</td><td>3 passed results</td>" in text
    assert "<td>interface</td><td>2 passed results</td>" in text


@pytest.mark.verifies("SWR-TRC-064", technique="error_guessing", polarity="violation")
def test_a_technique_whose_test_failed_says_how_many_and_is_not_passed(sample: Sample, page: Callable[[], str]) -> None:
    sample.replace("build/host-release/evidence/junit/tools.xml", 'name="test_no_connection[b]" time="0.001">',
                   'name="test_no_connection[b]" time="0.001"><failure message="no"/>')  # fmt: skip

    text = page()

    assert '<td>interface</td><td>1 passed result, 1 failed</td><td><span class="badge failed">failed</span></td>' in text


@pytest.mark.verifies("SWR-TRC-065", technique="fault_injection", polarity="violation")
def test_without_a_browser_one_line_says_so_and_nothing_is_written(sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")

    outcome = trace("report", "--root", sample.root, "--pdf", sample.root / "paper.pdf")

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert "install the Debian package chromium" in outcome.err
    assert not (sample.root / "report").exists()
    assert not (sample.root / "paper.pdf").exists()


@pytest.mark.verifies("SWR-TRC-065", technique="fault_injection", polarity="violation")
def test_a_browser_that_fails_leaves_the_old_report(sample: Sample, page: Callable[[], str]) -> None:
    before = page()
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", "## SYS-003 Other")

    def fail(_: str) -> None:
        raise WorkError("chromium ended by itself")

    with pytest.raises(WorkError):
        write_report(read_project(sample.root, None, list_rule_ids()), sample.root / "report" / "index.html", fail)

    assert (sample.root / "report" / "index.html").read_text() == before


@pytest.mark.verifies("SWR-TRC-065", technique="requirements_based", polarity="nominal")
def test_paper_has_overview_findings_matrix_and_items_and_no_script(sample: Sample) -> None:
    papers: list[str] = []

    write_report(read_project(sample.root, None, list_rule_ids()), sample.root / "page.html", papers.append)

    (paper,) = papers
    assert re.findall(r'<section id="(\w+)"', paper) == ["overview", "findings", "matrix", "items", "techniques", "glossary"]
    assert "<script" not in paper
    assert "noscript" not in paper
    assert 'id="item/SWR-SUP-001"' in paper


@pytest.mark.verifies("SWR-TRC-067", technique="boundary_values", polarity="nominal")
def test_ten_thousand_items_and_six_thousand_results_fit_in_thirty_megabytes(tmp_path: Path) -> None:
    write_report(make_large_project(tmp_path), tmp_path / "page.html")

    assert 5_000_000 < (tmp_path / "page.html").stat().st_size <= SIZE_BYTES_MAX
