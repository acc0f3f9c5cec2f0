# SPDX-License-Identifier: Apache-2.0
# Goal: the command checks everything before the run, keeps and marks the measured data, and its exit status is correct.
# Method: a program that writes prepared measurements (timing_run.py), also one that fails, hangs or is stopped.
from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from timing_run import make_program, prepare

from mamori_tools.command.main import main
from mamori_tools.host.project import Project
from mamori_tools.timing import command
from mamori_tools.timing.command import RESULTS
from mamori_tools.timing.environment import calc_steal_share, collect_setting, collect_state, find_preemption, read_ticks
from mamori_tools.timing.system import find_system

TIMEOUT_S = 30.0
RUNNER = """
import sys
from mamori_tools.command.main import main
from mamori_tools.timing import run
run.GRACE_S = float(sys.argv[1])
sys.exit(main(sys.argv[2:]))
"""


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program for calls without pictures, which dominate the run time and have their own tests."""
    monkeypatch.setattr("mamori_tools.timing.picture.draw_report", lambda report, folder: [])
    return make_program(tmp_path)


def measure(program: Path, *words: str, own: tuple[str, ...] = (), **measured: Any) -> int:
    """Runs the command on a program with the arguments `words`. @param measured see prepare()."""
    prepare(program.parent, **measured)
    return main(["timing", str(program), "--cycles", "100", "--out", str(program.parent / "out"), *own, *(("--", *words) if words else ())])


def load_record(program: Path) -> dict[str, Any]:
    record: dict[str, Any] = json.loads((program.parent / "out" / "timing.json").read_text(encoding="utf-8"))
    return record


@pytest.mark.verifies("SWR-TIM-025")
def test_clean_run_ends_with_0_and_all_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = make_program(tmp_path)
    assert measure(program) == 0

    assert all((program.parent / "out" / name).stat().st_size > 0 for name in RESULTS)
    assert "findings: 0" in capsys.readouterr().out


@pytest.mark.verifies("SWR-TIM-026")
def test_record_tells_figures_with_the_machine_they_come_from(program: Path) -> None:
    measure(program)

    record = load_record(program)
    assert record["schema"] == "mamori.timing/1"
    assert record["cycles"] == {"asked": 100, "run": 100}
    assert {"commit", "cpu", "cores"} <= set(record["environment"])
    assert {"preemption", "governor", "clock_source", "idle_state"} <= set(record["host"]["setting"])
    assert "\nprocessor: deepest idle state " in (program.parent / "out" / "timing.txt").read_text(encoding="utf-8")
    assert record["components"][0]["execution"]["count"] == 100
    assert record["chains"][0]["virtual"]["max_ns"] == 900_000
    assert "too few" in record["components"][0]["extreme_values"]["refusal"]
    assert record["ratios"][0]["ratio"] == pytest.approx(10.0, rel=0.1)


@pytest.mark.verifies("SWR-TIM-025", polarity="violation")
@pytest.mark.parametrize(
    ("words", "measured", "said"),
    [((), {"fault": "overrun"}, "window 'control': 1 overran, first in cycle 13 by 'controller'"),
     ((), {"slower": 6.0}, "component 'reader': declared worst case 40 us"),
     (("fail",), {}, "the program ended with status 1")],
)  # fmt: skip
def test_finding_ends_with_1(program: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], measured: dict[str, Any], said: str
                                ) -> None:  # fmt: skip
    assert measure(program, *words, **measured) == 1

    assert said in capsys.readouterr().out
    assert any(said in text for text in load_record(program)["findings"])


@pytest.mark.verifies("SWR-TIM-025", technique="equivalence_classes")
def test_late_release_is_told_with_the_steal_and_is_no_finding(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, fault="missed") == 0

    said = capsys.readouterr().out
    assert "lost outside the program: 1 windows skipped and 0 overruns, late by up to 450 us, steal" in said
    assert load_record(program)["misses"][0]["outcome"] == "missed"


@pytest.mark.verifies("SWR-TIM-045")
def test_run_within_the_limits_of_the_user_ends_with_0(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, own=("--max-missed", "1", "--max-late", "450"), fault="missed") == 0

    assert "findings: 0" in capsys.readouterr().out


@pytest.mark.verifies("SWR-TIM-045", polarity="violation")
@pytest.mark.parametrize(("own", "status", "said"), [
    (("--max-missed", "0"), 1, "--max-missed: 1 windows were skipped or overran, at most 0 are permitted; first in cycle 13, window 'control'"),
    (("--max-late", "449.999"), 1, "--max-late: window 'control' was late by up to 450 us, at most 449.999 us are permitted"),
])  # fmt: skip
def test_limits_of_the_user_end_with_1(program: Path, capsys: pytest.CaptureFixture[str], own: tuple[str, ...], status: int, said: str) -> None:
    assert measure(program, own=own, fault="missed") == status

    assert said in capsys.readouterr().out


@pytest.mark.verifies("SWR-TIM-045", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("words", "said"), [
    (["--max-missed", "-1"], "'-1' is not an integer of at least 0"),
    (["--max-missed", "1.5"], "'1.5' is not an integer of at least 0"), (["--max-missed", "1" * 13], "at most 12 digits"),
    (["--max-late", "0"], "'0' is not a positive number of microseconds"), (["--max-late", "nan"], "'nan' is not a positive number"),
    (["--max-late", "1e3"], "'1e3' is not a positive number"), (["--max-late", "1.0005"], "at most three decimals"),
])  # fmt: skip
def test_limits_that_are_no_numbers_end_with_2(program: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str) -> None:
    assert measure(program, own=tuple(words)) == 2

    told = capsys.readouterr().err
    assert said in told and len(told.splitlines()) == 1


@pytest.mark.verifies("SWR-TIM-025", polarity="violation")
def test_run_without_rights_ends_with_4_and_is_marked(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, refused=("priority", "memory")) == 4

    mark = "WITHOUT REAL-TIME PRIVILEGES: denied: priority (Operation not permitted), memory (Operation not permitted)"
    assert mark in capsys.readouterr().out
    assert load_record(program)["marks"] == [mark]
    assert mark in (program.parent / "out" / "timing.txt").read_text(encoding="utf-8")
    assert load_record(program)["rights"]["memory"] == {"is_granted": False, "errno": 1}


@pytest.mark.verifies("SWR-TIM-025", technique="boundary_values", polarity="violation")
def test_finding_counts_more_than_a_missing_right(program: Path) -> None:
    assert measure(program, fault="overrun", refused=("priority",)) == 1


@pytest.mark.verifies("SWR-PRT-039", technique="interface")
def test_requests_are_made_and_their_shift_is_shown(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, own=("--requests",)) == 0

    assert "requests: 1000, steady (1,000 per second) and in bursts of 100; rounds of 3 x 20 cycles: 1" in capsys.readouterr().out
    assert load_record(program)["requests"]["windows"][0]["burst"]["count"] == 1
    assert load_record(program)["windows"][0]["drift"]["planned_ns"] == 0


@pytest.mark.verifies("SWR-TIM-022", technique="interface", polarity="violation")
def test_program_that_ignores_the_option_for_requests_ends_with_2(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, "old", own=("--requests",)) == 2
    assert "the program ignored --requests" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-020")
def test_accepted_baseline_is_held_against_the_next_run(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    baseline = program.parent / "baseline.toml"
    assert measure(program, own=("--accept", str(baseline))) == 0
    assert measure(program, own=("--check", str(baseline))) == 0

    assert measure(program, slower=1.6, own=("--check", str(baseline))) == 1
    assert "component 'reader': ratio 16" in capsys.readouterr().out


@pytest.mark.verifies("SWR-TIM-020", polarity="violation")
def test_run_with_a_finding_is_not_accepted(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    baseline = program.parent / "baseline.toml"

    assert measure(program, fault="overrun", own=("--accept", str(baseline))) == 1
    assert not baseline.exists()
    assert "not accepted" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-021", polarity="violation")
def test_baseline_of_another_table_ends_before_the_run(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    baseline = program.parent / "baseline.toml"
    measure(program, own=("--accept", str(baseline)))
    capsys.readouterr()

    assert measure(program, frame_us=2000, own=("--check", str(baseline))) == 2
    said = capsys.readouterr()
    assert "belongs to another table" in said.err
    assert "measuring" not in said.out


@pytest.mark.verifies("SWR-TIM-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("words", "said"),
    [(["nowhere"], "there is no system 'nowhere'"), (["{folder}"], "has no timing.toml"), (["{folder}/plain"], "is not an executable program"),
     (["{program}", "--cycles", "0"], "'0' is not an integer of at least 1"), (["{program}", "--cycles", "-5"], "not an integer"),
     (["{program}", "--cycles", "1.5"], "not an integer"), (["{program}", "--check", "{folder}/none"], "baseline not found"),
     (["{program}", "--check", "a", "--accept", "b"], "exclude each other"), (["{program}", "--accept", "{folder}"], "is a folder"),
     (["{program}", "--out", "{folder}/plain/deeper"], "not writable"), (["{program}", "--fast"], "has no option '--fast'"),
     (["{program}", "other"], "does not take 'other'"), ([], "SYSTEM")],
)  # fmt: skip
def test_wrong_words_end_with_2_and_one_line(program: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str) -> None:
    (program.parent / "plain").write_text("no program", encoding="utf-8")
    places = {"program": str(program), "folder": str(program.parent)}

    assert main(["timing", *(word.format(**places) for word in words)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


@pytest.mark.verifies("SWR-TIM-022", technique="interface", polarity="violation")
def test_arguments_that_the_program_refuses_end_with_2_and_its_words(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert measure(program, "usage") == 2
    assert "fake_system rejects its arguments: fake_system: there is no such joint" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-011", technique="fault_injection", polarity="violation")
def test_program_that_writes_nothing_ends_with_2(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    measure(program)
    assert measure(program, "nothing") == 2

    assert "table not found" in capsys.readouterr().err
    assert not (program.parent / "out" / "timing.json").exists(), "results of an earlier run"


@pytest.mark.verifies("SWR-TIM-022", technique="fault_injection", polarity="violation")
def test_load_without_its_tool_ends_with_2(program: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(program.parent))

    assert measure(program, own=("--load",)) == 2
    assert "install the package stress-ng" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-023")
def test_load_runs_beside_the_program_with_an_end_of_its_own(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tool = program.parent / "stress-ng"
    tool.write_text(f'#!/bin/sh\necho $$ >{program.parent}/pid\necho "$*" >{program.parent}/load\nexec sleep 60\n', encoding="utf-8")
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}:{os.environ['PATH']}")

    assert measure(program, "await-load", own=("--load",)) == 0
    assert "--timeout 90s" in (program.parent / "load").read_text(encoding="utf-8")
    assert not Path("/proc", (program.parent / "pid").read_text().strip()).exists()
    assert load_record(program)["with_load"] is True


@pytest.mark.verifies("SWR-TIM-023", technique="fault_injection", polarity="violation")
def test_load_that_ends_early_is_a_finding(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tool = program.parent / "stress-ng"
    tool.write_text(f"#!/bin/sh\ntouch {program.parent}/load\nexit 3\n", encoding="utf-8")
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}:{os.environ['PATH']}")

    assert measure(program, "await-load", own=("--load",)) == 1
    assert "the load ended before the run, with status 3" in load_record(program)["findings"]


@pytest.mark.parametrize("name", ["run", "timing.json/full", "program.log/full"])
@pytest.mark.verifies("SWR-TIM-026", technique="error_guessing", polarity="violation")
def test_what_is_in_the_way_of_a_result_is_named(program: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    obstacle = program.parent / "out" / name
    obstacle.parent.mkdir(parents=True)
    obstacle.write_text("mine", encoding="utf-8")

    assert measure(program) == 2
    assert "prevents the output of a result" in capsys.readouterr().err
    assert obstacle.read_text(encoding="utf-8") == "mine"


def stop_while_measuring(program: Path, number: signal.Signals, grace_s: float, *words: str) -> tuple[int, str]:
    """@return exit status and output of a command that received the signal `number` while its program measured."""
    out = program.parent / "out"
    prepare(program.parent, 60_000)
    argv = [sys.executable, "-P", "-c", RUNNER, str(grace_s), "timing", str(program), "--out", str(out), "--", "wait", *words]
    runner = subprocess.Popen(argv, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    deadline = time.monotonic() + TIMEOUT_S
    while not (out / "run" / "begun").exists():
        assert time.monotonic() < deadline and runner.poll() is None, "the program did not start"
        time.sleep(0.02)
    runner.send_signal(number)
    said, _ = runner.communicate(timeout=TIMEOUT_S)
    return runner.returncode, said


@pytest.mark.verifies("SWR-TIM-024")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_stopped_run_is_kept_and_marked_partial(program: Path, number: signal.Signals) -> None:
    status, said = stop_while_measuring(program, number, 10.0)

    assert status == 130
    assert "PARTIAL: stopped after 100 of 60000 cycles" in said
    record = load_record(program)
    assert (record["is_partial"], record["exit_status"], record["components"][0]["execution"]["count"]) == (True, 130, 100)
    assert all((program.parent / "out" / name).exists() for name in RESULTS)  # including the pictures


@pytest.mark.verifies("SWR-TIM-024", technique="fault_injection", polarity="violation")
def test_program_that_does_not_stop_is_ended_and_nothing_is_invented(program: Path) -> None:
    status, said = stop_while_measuring(program, signal.SIGINT, 0.3, "deaf")

    assert status == 130
    assert "nothing to analyse" in said
    assert not (program.parent / "out" / "timing.json").exists()


@pytest.mark.verifies("SWR-TIM-024", technique="fault_injection", polarity="violation")
def test_program_that_never_ends_is_stopped_and_is_a_finding(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mamori_tools.timing.run.OVERTIME_S", 2.0)
    monkeypatch.setattr("mamori_tools.timing.run.OVERTIME_FACTOR", 0.0)
    prepare(program.parent, 60_000)

    assert main(["timing", str(program), "--out", str(program.parent / "out"), "--", "wait"]) == 1
    record = load_record(program)
    assert "did not end and was stopped after" in record["findings"][0]
    assert record["is_partial"] is True


@pytest.mark.verifies("SWR-TIM-024", technique="error_guessing", polarity="violation")
def test_results_are_finished_when_ctrl_c_comes_while_they_are_written(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def draw(report: Any, folder: Path) -> list[Path]:
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGTERM)
        return []

    monkeypatch.setattr("mamori_tools.timing.picture.draw_report", draw)
    assert measure(program) == 0


CMAKE = """#!/bin/sh
case "$*" in
  *--build*) mkdir -p {root}/build/host-release/examples && cp {program} {root}/build/host-release/examples/fake_system;;
esac
"""


@pytest.fixture
def project(program: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project whose example is built by a fake cmake that copies the program. @return its root."""
    root = program.parent / "project"
    (root / "examples" / "arm").mkdir(parents=True)
    (root / "examples" / "arm" / "timing.toml").write_text(
        'program = "examples/fake_system"\ntarget = "fake_system"\narguments = ["--model", "{root}/x"]\n', encoding="utf-8"
    )
    cmake = program.parent / "cmake"
    cmake.write_text(CMAKE.format(root=root, program=program), encoding="utf-8")
    cmake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{program.parent}:{os.environ['PATH']}")
    monkeypatch.setattr(command, "ROOT", root)
    return root


@pytest.mark.verifies("SWR-TIM-022")
def test_folder_is_built_and_run_with_its_arguments(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    prepare(project.parent)

    assert main(["timing", "examples/arm", "--cycles", "100"]) == 0

    folder = project / "build" / "host-release" / "evidence" / "timing" / "arm"
    assert f"--model {project}/x" in (folder / "program.log").read_text(encoding="utf-8")
    assert (folder / "timing.json").exists()
    shown = capsys.readouterr()
    assert "build fake_system" in shown.err and "build fake_system" not in shown.out


@pytest.mark.verifies("SWR-TIM-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("text", "said"),
    [("program = 1", "has no 'program'"), ('program = "a"', "has no 'target'"), ('program = "../../x"\ntarget = "x"', "is outside the build folder"),
     ('programm = "a"', "unknown key 'programm'; nearest: program"),
     ('program = "a\\u0000"\ntarget = "x"', "without NUL"), ('program = "a"\ntarget = "x"\narguments = ["\\u0000"]', "without NUL"),
     ("program", "invalid TOML"),
     ('program = "a"\ntarget = "b"\narguments = [1]', "must be a list of strings")],
)  # fmt: skip
def test_wrong_description_ends_before_the_build(project: Path, capsys: pytest.CaptureFixture[str], text: str, said: str) -> None:
    (project / "examples" / "arm" / "timing.toml").write_text(text, encoding="utf-8")

    assert main(["timing", "examples/arm"]) == 2
    assert said in capsys.readouterr().err
    assert not (project / "build" / "host-release" / "examples").exists()


@pytest.fixture
def users(project: Path) -> Path:
    """A user project outside Mamori, with its arm in a separate folder. @return its root."""
    root = project.parent / "robot"
    (root / "arm").mkdir(parents=True)
    (root / "CMakeLists.txt").write_text("project(robot)\nfind_package(mamori 0.1 CONFIG REQUIRED)\n", encoding="utf-8")
    (root / "arm" / "CMakeLists.txt").write_text("add_executable(arm main.cpp)\n", encoding="utf-8")
    (root / "arm" / "timing.toml").write_text('program = "arm/fake_system"\ntarget = "fake_system"\narguments = ["--root", "{root}"]\n', encoding="utf-8")
    return root


@pytest.mark.verifies("SWR-TIM-029")
@pytest.mark.parametrize("command_name", ["timing", "cost"])
def test_folder_of_the_users_belongs_to_the_project_that_finds_the_package(users: Path, project: Path, command_name: str) -> None:
    system = find_system(str(users / "arm"), Project(project), command_name)

    assert system.project == Project(users)
    assert system.program == users / "build" / "host-release" / "arm" / "fake_system"
    assert system.arguments == ("--root", str(users))


@pytest.mark.verifies("SWR-TIM-029")
def test_users_project_is_built_against_the_package_and_keeps_its_results(
    users: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    prepare(users.parent)
    calls = users.parent / "calls"
    cmake = users.parent / "cmake"
    target = users / "build" / "host-release" / "arm"
    cmake.write_text(f'#!/bin/sh\necho "$*" >>{calls}\ncase "$*" in *fake_system*) mkdir -p {target} && cp {users.parent / "fake_system"} '
                     f"{target}/fake_system;; esac\n", encoding="utf-8")  # fmt: skip

    assert main(["timing", str(users / "arm"), "--cycles", "100"]) == 0

    lines = calls.read_text(encoding="utf-8").splitlines()
    assert any("--install" in line for line in lines)
    assert any(f"-S {users} " in line and "-DCMAKE_PREFIX_PATH=" in line for line in lines)
    assert any(f"--build {users}/build/host-release --target fake_system" in line for line in lines)
    assert (users / "build" / "host-release" / "evidence" / "timing" / "arm" / "timing.json").exists()
    shown = capsys.readouterr()
    assert shown.out.startswith("arm: 100 cycles") and shown.out.rstrip().endswith("findings: 0")


@pytest.mark.verifies("SWR-TIM-029", technique="interface")
def test_json_is_the_record_and_nothing_else_also_when_something_is_built_first(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    prepare(project.parent)

    assert main(["timing", "examples/arm", "--cycles", "100", "--json"]) == 0

    shown = capsys.readouterr()
    assert json.loads(shown.out)["schema"] == "mamori.timing/1"
    assert "build fake_system" in shown.err


@pytest.mark.verifies("SWR-TIM-029", technique="error_guessing", polarity="violation")
def test_folder_that_no_project_builds_is_told(users: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (users / "CMakeLists.txt").write_text("project(robot)\n# find_package(mamori)\n", encoding="utf-8")

    assert main(["timing", str(users / "arm")]) == 2

    shown = capsys.readouterr()
    assert shown.err.count("\n") == 1 and "CMakeLists.txt that calls find_package(mamori)" in shown.err and shown.out == ""


@pytest.mark.verifies("SWR-TIM-022", technique="fault_injection", polarity="violation")
def test_unknown_system_is_answered_with_the_nearest(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["timing", "examples/army"]) == 2
    assert "nearest: examples/arm" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-019", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("version", "realtime", "mode"),
    [("#1 SMP PREEMPT_DYNAMIC Debian 6.1", "", "PREEMPT_DYNAMIC"), ("#1 SMP PREEMPT_RT Debian", "1", "PREEMPT_RT"), ("#1 SMP", "", "not known"),
     ("#1 SMP PREEMPT RT", "1", "PREEMPT_RT"), ("#1 SMP PREEMPT", "", "PREEMPT")],
)  # fmt: skip
def test_preemption_mode_is_read_from_the_kernel(version: str, realtime: str, mode: str) -> None:
    assert find_preemption(version, realtime) == mode


@pytest.mark.verifies("SWR-TIM-019")
def test_steal_is_a_share_of_all_processor_time() -> None:
    before, after = (read_ticks(f"cpu  10 0 10 {idle} 0 0 0 {steal} 5 0\ncpu0 1") for idle, steal in ((100, 4), (180, 24)))

    assert (before.total, before.steal) == (124, 4)
    states = [{"ticks": one.total, "steal_ticks": one.steal} for one in (before, after)]
    assert calc_steal_share(states[0], states[1]) == pytest.approx(0.2)
    assert calc_steal_share(states[0], states[0]) == 0.0


@pytest.mark.verifies("SWR-TIM-019", technique="interface")
def test_machine_tells_what_it_can() -> None:
    assert set(collect_setting()) == {"kernel", "kernel_version", "preemption", "governor", "clock_source", "virtual_machine", "isolated_cores",
                                      "turbo", "idle_state", "cpu_dma_latency_us", "rt_throttling", "advice"}  # fmt: skip
    assert set(collect_state()) == {"load_1_min", "frequency_khz", "ticks", "steal_ticks"}
    assert read_ticks("nothing").total == 0
