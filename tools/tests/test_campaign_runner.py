# SPDX-License-Identifier: Apache-2.0
"""Running a campaign. Method: a small program in the place of the simulated arm; it keeps the same contract and can be
told by the fault plan to crash, to hang, or to write something broken."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.campaign import CampaignResult, CaseResult, load_plan, run_campaign, select
from mamori_tools.campaign import __main__ as command
from mamori_trace.base.errors import InputError

PLAN = """\
schema: mamori.fault_plan/1
seed: 7
instants: [0.25, 0.5]
motion_begins_at_s: 0.1
observe_s: 1.0
bounds: {hold_drift_rad: 0.002, hold_observed_s: 0.5, tracking_error_rad: 0.02}
scenarios:
  - name: none
    title: No fault
    fault: {kind: none}
    expected: {state: Operational, reaction: [None], detected_fault: [None]}
    requirements: {SYS-020: nominal, SYS-027: nominal}
  - name: message_late
    title: Late & <quoted>
    fault: {kind: message_late, magnitude: 0.0}
    expected: {state: Safe, reaction: [Sto], detected_fault: [CommandStale], within_s: 0.02}
    requirements: {SYS-023: violation, SYS-026: nominal}
"""

# The magnitude of message_late says how the program misbehaves.
PROGRAM = """\
#!{python}
import json, os, sys, time
arguments = dict(zip(sys.argv[2::2], sys.argv[3::2]))
assert sys.argv[1] == "run" and os.path.exists(arguments["--model"]) and os.path.exists(arguments["--motion"])
pairs = dict(pair.split("=") for pair in arguments["--fault"].split(",")) if "--fault" in arguments else None
mode = int(float(pairs["magnitude"])) if pairs else 0
at = 0.1 + float(pairs["at"]) if pairs else None
out = arguments["--out"]
simulated = int(arguments["--frames"]) / 1000 if "--frames" in arguments else 4.2
run = {{"schema": "mamori.run/1", "commit": os.environ.get("MAMORI_COMMIT", "none"), "seed": int(arguments["--seed"]), "simulated_s": simulated,
       "fault": pairs and {{"kind": pairs["kind"], "joint": None, "channel": None, "at_s": at, "motion_at_s": float(pairs["at"]), "magnitude": mode}},
       "final_state": "Safe" if pairs else "Operational", "operational_at_s": 0.05,
       "detected_fault": "CommandStale" if pairs else None, "detected_at_s": at and at + 0.01,
       "reaction": "Sto" if pairs else None, "reacted_at_s": at and at + 0.01,
       "standstill_at_s": at and at + 0.2, "watchdog_bitten": False,
       "physics": {{"max_speed_rad_s": [0.1], "speed_limit_rad_s": [1.0], "min_position_margin_rad": 0.4,
                   "stop_travel_rad": [0.0], "hold_drift_rad": 0.0, "max_tracking_error_rad": 0.001}}}}
text = json.dumps(run)
if mode == 1:
    sys.stderr.write("first\\nlast words \\x01\\n"); sys.exit(2)
if mode == 2:
    os.kill(os.getpid(), 11)
if mode == 3:
    open(out + "/pid", "w").write(str(os.getpid())); time.sleep(60)
if mode == 4:
    text = text[:len(text) // 2]
if mode == 5:
    text = text.replace("0.4", "NaN")
if mode == 6:
    text = text.replace('"stop_travel_rad": [0.0]', '"stop_travel_rad": [1e999]')
if mode != 7:
    open(out + "/run.json", "w").write(text)
if mode == 8:
    sys.exit(1)
"""


class Bench:
    """A folder with plan, program and model, and one call that runs a campaign in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.motion = folder / "motion.txt"
        self.motion.write_text("0.0 0.0\n4.0 0.4\n")
        self.evidence = folder / "evidence"
        self.program = folder / "program"
        self.program.write_text(PROGRAM.format(python=sys.executable))
        self.program.chmod(0o755)
        self.model = folder / "model.yaml"
        self.model.write_text("joints: [{name: J1, position_range_rad: [-1, 1], speed_limit_rad_s: 1}]\n")
        self.plan = folder / "faults.yaml"
        self.write_plan(0)

    def write_plan(self, mode: int) -> None:
        self.plan.write_text(PLAN.replace("magnitude: 0.0", f"magnitude: {mode}.0"))

    def run(self, **options: object) -> CampaignResult:
        settings: dict[str, object] = {"program": self.program, "files": {"model": self.model, "motion": self.motion},
                                       "evidence": self.evidence, "jobs": 2,
                                       "environment": {"commit": "abc"}} | options  # fmt: skip
        return run_campaign(select(load_plan(self.plan)), **settings)  # type: ignore[arg-type]

    def read_json(self) -> dict[str, Any]:
        return json.loads((self.evidence / "campaign/campaign.json").read_text())

    def read_testcases(self) -> list[ElementTree.Element]:
        return list(ElementTree.parse(self.evidence / "junit/campaign.xml").iter("testcase"))


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
    assert "--seed 7" in again and "--fault kind=message_late,at=1.0,magnitude=8.0" in again
    (bench.evidence / "campaign/message_late-1/run.json").unlink()
    assert subprocess.run(again, shell=True, check=False).returncode == 1
    assert (bench.evidence / "campaign/message_late-1/run.json").exists()
    texts = [element.text for element in ElementTree.parse(bench.evidence / "junit/campaign.xml").iter("failure")]
    assert all("at commit abc: " in (text or "") for text in texts)


@pytest.mark.verifies("SWR-CMP-007")
def test_evidence_of_an_earlier_campaign_cannot_be_taken_for_this_one(bench: Bench) -> None:
    assert bench.run().passed
    keep = bench.evidence / "campaign" / "notes.txt"
    keep.write_text("of the user")
    (bench.evidence / "campaign/old_scenario-3").mkdir()
    bench.write_plan(7)  # writes no run.json; one of the campaign before lies there

    assert len(bench.run().failed_cases) == 2
    assert not (bench.evidence / "campaign/old_scenario-3").exists()
    assert keep.exists()


@pytest.mark.verifies("SWR-CMP-007", technique="fault_injection", polarity="violation")
def test_an_interrupted_campaign_ends_its_processes_and_leaves_no_verdict(bench: Bench) -> None:
    assert bench.run().passed
    bench.write_plan(3)
    code = (f"import sys; sys.path[:0] = {sys.path!r}; from mamori_tools.campaign.__main__ import main; sys.exit(main(["
            f"'--plan', {str(bench.plan)!r}, '--program', {str(bench.program)!r}, '--model', {str(bench.model)!r}, "
            f"'--motion', {str(bench.evidence / 'campaign/motion.txt')!r}, '--evidence', {str(bench.folder / 'new')!r}, "
            "'--jobs', '2']))")
    process = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    pid_file = bench.folder / "new/campaign/message_late-1/pid"
    deadline = time.monotonic() + 30.0
    while not (pid_file.exists() and pid_file.read_text()) and time.monotonic() < deadline:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30.0)

    assert process.returncode == 130
    assert errors == "interrupted; the runs were ended and no campaign was written\n"
    assert not (bench.folder / "new/campaign/campaign.json").exists()
    assert not (bench.folder / "new/junit/campaign.xml").exists()
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid_file.read_text()), 0)


@pytest.mark.parametrize(("options", "words"), [
    ({"program": Path("/nowhere/safe_arm")}, "build it first"),
    ({"files": {"model": Path("/nowhere/model.yaml"), "motion": Path("/nowhere/motion.txt")}}, "model file not found"),
    ({"jobs": 0}, "0 jobs"),
    ({"timeout_s": 0.0}, "time-out of 0 s"),
    ({"timeout_s": float("nan")}, "time-out of nan s"),
    ({"evidence": Path("/proc/none")}, "evidence cannot be written"),
])
@pytest.mark.verifies("SWR-CMP-002", technique="equivalence_classes", polarity="violation")
def test_a_campaign_that_cannot_run_is_refused(bench: Bench, options: dict[str, object], words: str) -> None:
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


@pytest.mark.verifies("SWR-CMP-006", technique="interface")
def test_the_command_shows_verdicts_and_ends_with_their_status(bench: Bench, capsys: pytest.CaptureFixture[str],
                                                               monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MAMORI_COMMIT", raising=False)
    bench.run()
    table = bench.folder / "table.txt"
    table.write_text((bench.evidence / "campaign/motion.txt").read_text())
    arguments = ["--plan", str(bench.plan), "--program", str(bench.program), "--model", str(bench.model), "--motion",
                 str(table), "--evidence", str(bench.evidence)]  # fmt: skip

    assert command.main([*arguments, "--scenario", "none"]) == 0
    assert "1 passed, 0 failed" in capsys.readouterr().out
    bench.write_plan(8)
    assert command.main([*arguments, "--instants", "1"]) == 1
    shown = capsys.readouterr().out
    assert "1 passed, 1 failed" in shown
    assert "at commit none: " in shown and "--fault kind=message_late" in shown


@pytest.mark.verifies("SWR-CMP-002", technique="interface", polarity="violation")
def test_the_command_answers_bad_input_with_one_line_and_status_2(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["--plan", str(bench.plan), "--list"]) == 0
    assert "message_late" in capsys.readouterr().out
    assert command.main(["--plan", str(bench.plan)]) == 2
    assert capsys.readouterr().err == "give --program, --model, --motion, --evidence\n"
    assert command.main(["--plan", str(bench.folder / "none.yaml"), "--list"]) == 2
    assert capsys.readouterr().err == f"{bench.folder / 'none.yaml'}: fault plan not found; check the path\n"
