# SPDX-License-Identifier: Apache-2.0
"""Running a campaign. Method: a small program that replaces the simulated arm; see campaign_bench."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
from campaign_bench import Bench

from mamori_tools.campaign import CaseResult
from mamori_trace.base.errors import InputError


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


@pytest.mark.verifies("SWR-CMP-005")
def test_every_case_is_run_and_written_in_the_order_of_the_plan(bench: Bench) -> None:
    seen: list[tuple[str, int, int]] = []

    def note(result: CaseResult, done: int, total: int) -> None:
        seen.append((result.case.id, done, total))

    result = bench.run(progress=note)

    assert result.passed
    content = bench.read_json()
    assert content["schema"] == "mamori.campaign/1"
    assert content["environment"] == {"commit": "abc"}
    assert [case["id"] for case in content["cases"]] == ["none-1", "message_late-1", "message_late-2"]
    assert sorted(seen) == sorted((case, place, 3) for place, (case, _, _) in enumerate(seen, start=1))


@pytest.mark.verifies("SWR-CMP-005", technique="interface")
def test_a_case_in_campaign_json_keeps_the_contract(bench: Bench) -> None:
    bench.run()
    case = bench.read_json()["cases"][1]

    assert case["title"] == "Late & <quoted>"
    assert case["requirements"] == ["SYS-023", "SYS-026"]
    assert case["polarity"] == "violation"
    assert case["expected"] == {"state": "Safe", "reaction": ["Sto"], "detected_fault": ["CommandStale"], "within_s": 0.02}
    assert case["run"] == json.loads((bench.evidence / "campaign" / case["folder"] / "run.json").read_text())
    assert {"name": "final state", "wanted": "Safe", "measured": "Safe", "passed": True} in case["checks"]
    assert case["verdict"] == "pass"
    assert bench.read_json()["cases"][0]["polarity"] == "nominal"


@pytest.mark.verifies("SWR-CMP-005", technique="interface")
def test_junit_has_each_case_once_per_requirement_with_its_properties(bench: Bench) -> None:
    bench.run()
    cases = bench.read_testcases()

    assert [(case.get("classname"), case.get("name")) for case in cases] == [
        ("none", "none-1[SYS-020]"), ("none", "none-1[SYS-027]"),
        ("message_late", "message_late-1[SYS-023]"), ("message_late", "message_late-1[SYS-026]"),
        ("message_late", "message_late-2[SYS-023]"), ("message_late", "message_late-2[SYS-026]")]
    properties = [{each.get("name"): each.get("value") for each in case.iter("property")} for case in cases]
    assert properties[2] == {"requirement": "SYS-023", "technique": "fault_injection", "polarity": "violation"}
    assert properties[3] == {"requirement": "SYS-026", "technique": "fault_injection", "polarity": "nominal"}
    assert not [case for case in cases if case.find("failure") is not None]


@pytest.mark.parametrize(("mode", "words"), [
    (1, "program ended with exit status 2: last words"),
    (2, "program ended with signal 11: it said nothing"),
    (4, "is not whole JSON"),
    (5, "holds NaN"),
    (6, "holds 1e999"),
    (7, "run record not found"),
    (8, "program ended with exit status 1"),
])
@pytest.mark.verifies("SWR-CMP-004", technique="fault_injection", polarity="violation")
def test_a_run_that_went_wrong_is_a_failed_case_with_its_reason(bench: Bench, mode: int, words: str) -> None:
    bench.write_plan(mode)
    result = bench.run()

    assert [each.case.id for each in result.failed_cases] == ["message_late-1", "message_late-2"]
    assert words in result.failed_cases[0].failure
    case = bench.read_json()["cases"][1]
    assert case["verdict"] == "fail"
    failures = [each for each in bench.read_testcases() if each.find("failure") is not None]
    assert len(failures) == 4
    assert words in failures[0].find("failure").get("message")  # type: ignore[union-attr, operator]


@pytest.mark.verifies("SWR-CMP-004")
def test_a_whole_run_counts_and_keeps_what_the_program_said(bench: Bench) -> None:
    result = bench.run(timeout_s=30.0)

    assert [each.checks[0].passed for each in result.cases] == [True, True, True]
    assert all((bench.evidence / "campaign" / each.case.id / "program.log").exists() for each in result.cases)


@pytest.mark.verifies("SWR-CMP-004", technique="fault_injection", polarity="violation")
def test_a_run_that_hangs_is_ended_and_fails(bench: Bench) -> None:
    bench.write_plan(3)
    result = bench.run(timeout_s=3.0)

    assert "no end after 3 s" in result.failed_cases[0].failure
    for each in result.failed_cases:
        pid = int((bench.evidence / "campaign" / each.case.id / "pid").read_text())
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.verifies("SWR-CMP-006")
def test_a_failed_case_names_the_command_that_runs_it_again(bench: Bench) -> None:
    bench.write_plan(8)
    failure = bench.run().failed_cases[0]
    head, _, again = failure.reproduction.partition(": ")

    assert head == "at commit abc"
    assert again.startswith(f"./mamori campaign {bench.plan} --replay message_late-1 --program {bench.program} ")
    command = bench.read_json()["cases"][1]["command"]
    assert "--seed 7" in command and "--fault kind=message_late,at=1.0,magnitude=8.0" in command
    shutil.rmtree(bench.evidence / "campaign/message_late-1")
    words = [sys.executable, "-P", "-m", "mamori_tools.command", *shlex.split(again)[1:]]
    done = subprocess.run(words, env={**os.environ, "MAMORI_COMMIT": "abc"}, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert "FAILED  run  expected a whole run, measured program ended with exit status 1" in done.stdout
    assert (bench.evidence / "campaign/replay/message_late-1/run.json").exists()
    texts = [element.text for element in ElementTree.parse(bench.evidence / "junit/campaign.xml").iter("failure")]
    assert all("at commit abc: " in (text or "") for text in texts)


@pytest.mark.verifies("SWR-CMP-007")
def test_evidence_of_an_earlier_campaign_cannot_be_taken_for_this_one(bench: Bench) -> None:
    assert bench.run().passed
    keep = bench.evidence / "campaign" / "notes.txt"
    keep.write_text("of the user")
    (bench.evidence / "campaign/old_scenario-3").mkdir()
    bench.write_plan(7)  # writes no run.json; the folder contains one of the previous campaign

    assert len(bench.run().failed_cases) == 2
    assert not (bench.evidence / "campaign/old_scenario-3").exists()
    assert keep.exists()


@pytest.mark.verifies("SWR-CMP-007", technique="fault_injection", polarity="violation")
def test_an_interrupted_campaign_ends_its_processes_and_leaves_no_verdict(bench: Bench) -> None:
    assert bench.run().passed
    bench.write_plan(3)
    process = subprocess.Popen(bench.make_command("--restart", "--jobs", "2"), stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    pids: list[str] = []
    deadline = time.monotonic() + 30.0
    while not any(pids) and time.monotonic() < deadline:
        time.sleep(0.05)
        pids = [path.read_text() for path in bench.evidence.glob("campaign/.attempt-*/message_late-1/pid")]
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=30.0)

    assert (process.returncode, output) == (130, "")
    assert errors.splitlines()[-1] == "mamori: stopped; no report was written"
    assert not (bench.evidence / "campaign/campaign.json").exists()
    assert not (bench.evidence / "junit/campaign.xml").exists()
    with pytest.raises(ProcessLookupError):
        os.kill(int(pids[0]), 0)


@pytest.mark.parametrize(("options", "words"), [
    ({"program": Path("/nowhere/safe_arm")}, "build it first"),
    ({"files": {"model": Path("/nowhere/model.yaml"), "motion": Path("/nowhere/motion.txt")}}, "model file not found"),
    ({"jobs": 0}, "0 jobs"),
    ({"timeout_s": 0.0}, "time-out of 0 s"),
    ({"timeout_s": float("nan")}, "time-out of nan s"),
    ({"evidence": Path("/proc/none")}, "evidence cannot be written"),
])
@pytest.mark.verifies("SWR-CMP-002", technique="equivalence_classes", polarity="violation")
def test_a_campaign_that_cannot_run_is_refused(bench: Bench, options: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        bench.run(**options)


@pytest.mark.verifies("SWR-CMP-002", technique="error_guessing", polarity="violation")
def test_a_program_that_cannot_be_started_is_refused(bench: Bench) -> None:
    bench.program.write_text("#!/nowhere/interpreter\n")

    with pytest.raises(InputError, match="cannot be started"):
        bench.run()


@pytest.mark.verifies("SWR-CMP-005", technique="interface")
def test_the_environment_record_beside_the_campaign_is_taken(bench: Bench) -> None:
    bench.evidence.mkdir()
    (bench.evidence / "environment.json").write_text('{"schema": "mamori.environment/1", "commit": "def"}')
    result = bench.run(environment=None)

    assert [case.run["commit"] for case in result.cases] == ["def", "def", "def"]
    assert bench.read_json()["environment"] == {"schema": "mamori.environment/1", "commit": "def"}
