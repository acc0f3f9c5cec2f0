# SPDX-License-Identifier: Apache-2.0
# Goal: one command starts a new project; its files are valid, and existing files stay unchanged.
# Method: start in an empty folder, then check, review, name and test the requirement like a new user.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

_RESULT = """<testsuites><testsuite name="stop">
<testcase classname="tests.test_stop" name="test_open_input_demands_the_stop"/>
</testsuite></testsuites>
"""
_TEST = "# @verifies SWR-APP-001\ndef test_open_input_demands_the_stop(): ...\n"


@pytest.mark.verifies("SWR-TRC-096", technique="requirements_based", polarity="nominal")
def test_a_new_project_is_sound_once_its_links_were_looked_at(trace: Callable, tmp_path: Path) -> None:
    begun = trace("init", "--root", tmp_path)
    first = trace("check", "--root", tmp_path, "--allow-missing")
    reviewed = trace("review", "--all", "--by", "the maintainers", "--root", tmp_path)
    second = trace("check", "--root", tmp_path, "--allow-missing")

    assert [each.status for each in (begun, first, reviewed, second)] == [0, 1, 0, 0]
    assert "mamori trace review --all" in begun.out
    assert first.out.count("error: ") == 1 and "[suspect-link]" in first.out
    assert "4 items: 4 draft" in second.out


@pytest.mark.verifies("SWR-TRC-096", technique="interface", polarity="nominal")
def test_the_next_steps_lead_to_a_requirement_that_is_judged(trace: Callable, tmp_path: Path) -> None:
    trace("init", "--root", tmp_path)
    software = tmp_path / "requirements" / "software.md"
    software.write_text(software.read_text().replace("Status: draft", "Status: approved").replace("nominal, violation", "nominal"))
    for name, text in {"app/stop.py": '"""Stops.\n\n@satisfies SWR-APP-001\n"""\n', "tests/test_stop.py": _TEST}.items():
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text)
    (tmp_path / "evidence" / "junit").mkdir(parents=True)
    (tmp_path / "evidence" / "junit" / "stop.xml").write_text(_RESULT)
    trace("review", "--all", "--by", "the maintainers", "--root", tmp_path)

    outcome = trace("check", "--root", tmp_path, "--evidence", tmp_path / "evidence", "--allow-missing", "--output", "json")

    verdicts = {row["id"]: row["verdict"] for row in outcome.content["items"]}
    assert verdicts["SWR-APP-001"] == "verified", outcome.out


@pytest.mark.verifies("SWR-TRC-096", technique="error_guessing", polarity="violation")
def test_nothing_that_is_there_is_touched(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "requirements").mkdir()
    (tmp_path / "lost").symlink_to(tmp_path / "nowhere")

    outcomes = [trace("init", "--root", tmp_path), trace("init", "--root", tmp_path / "absent"), trace("init", "--root", tmp_path / "lost")]

    assert [(each.status, each.out, each.err.count("\n")) for each in outcomes] == [(2, "", 1)] * 3
    assert "`new` adds an item" in outcomes[0].err and "is no folder" in outcomes[1].err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["lost", "requirements"]
    assert not list((tmp_path / "requirements").iterdir())
