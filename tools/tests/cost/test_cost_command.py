# SPDX-License-Identifier: Apache-2.0
# Goal: invalid arguments are rejected before the work, results are complete, and the exit status is correct. Method: the command with given
# runs instead of counted ones.
from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from cost_run import BUILD, COUNTS, Counts, load_table, make_class, make_run
from timing_run import make_table

from mamori_tools.command.main import main
from mamori_tools.cost import command
from mamori_tools.cost.classes import InputClass
from mamori_tools.cost.report import SCHEMA
from mamori_tools.cost.run import Build
from mamori_tools.host.project import Project
from mamori_tools.timing.system import System
from mamori_trace.base.errors import WorkError

TOML = """program = "CMakeCache.txt"
target = "nothing"
[cost]
margin_percent = 50
[[cost.class]]
name = "still"
cycles = 14
first = 10
[[cost.class]]
name = "other"
cycles = 4
"""


class Bench:
    """A folder with a system, and simulated counts for it; the tests change both."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder / "arm"
        self.folder.mkdir()
        (self.folder / "timing.toml").write_text(TOML, encoding="utf-8")
        (self.folder / "CMakeLists.txt").write_text("find_package(mamori CONFIG REQUIRED)\n", encoding="utf-8")
        self.out = folder / "out"
        self.baseline = folder / "baseline.toml"
        self.document = make_table()
        self.counts: Counts = COUNTS
        self.build: Build = BUILD
        self.refused: tuple[str, ...] = ()
        self.counted: list[str] = []
        self.error: BaseException | None = None
        monkeypatch.setattr(command, "build_system", lambda system, context: True)
        monkeypatch.setattr(command, "run_class", self.run_class)
        monkeypatch.setattr(command.os, "access", lambda path, mode: True)
        monkeypatch.setattr(command.shutil, "which", lambda name: f"/usr/bin/{name}")

    def run_class(self, system: System, one: InputClass, log: Path, tell: Callable[[str], None]) -> Any:
        self.counted.append(one.name)
        if self.error is not None:
            raise self.error
        log.write_text("the program said this\n", encoding="utf-8")
        cycles = make_class(one.name, one.cycles, one.first, one.every)
        return make_run(load_table(self.folder, self.document), cycles, self.counts, refused=self.refused, build=self.build)

    def call(self, *words: str) -> int:
        return main(["cost", str(self.folder), "--out", str(self.out), *words])

    def load_record(self) -> dict[str, Any]:
        record: dict[str, Any] = json.loads((self.out / "cost.json").read_text(encoding="utf-8"))
        return record


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    return Bench(tmp_path, monkeypatch)


@pytest.mark.verifies("SWR-TIM-039")
def test_figures_and_their_origin_are_in_one_record_and_one_text(bench: Bench, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["mamori", "cost", "arm"])
    assert bench.call() == 0

    record = bench.load_record()
    assert record["schema"] == SCHEMA
    assert (record["system"], record["exit_status"], record["findings"], record["marks"]) == ("arm", 0, [], [])
    assert record["build"] == {"compiler": "GNU 12.2.0", "flags": "-O2", "c_library": "glibc 2.36"}
    assert [one["name"] for one in record["classes"]] == ["still", "other"]
    assert record["environment"]["command"] == "./mamori cost arm"
    assert record["pace"]["component"] == "drive"
    assert record["steps"][0]["instructions"] == {"count": 4, "min": 500, "median": 500, "max": 510, "cycle": 11}
    assert record["limits"][0]["name"] == "sense" and record["limits"][0]["is_kept"]
    text = (bench.out / "cost.txt").read_text(encoding="utf-8")
    shown = capsys.readouterr()
    assert shown.out == text  # only the requested output
    assert "results: " in shown.err
    assert "not a worst-case execution time" in text and "findings: 0" in text
    assert re.search(r"^still +controller +execute +4 +9000 +9000 +12000 +13 +24$", text, re.MULTILINE)


@pytest.mark.verifies("SWR-TIM-029", technique="interface")
def test_json_is_the_record_and_nothing_else(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.call("--json") == 0

    assert json.loads(capsys.readouterr().out) == bench.load_record()


@pytest.mark.verifies("SWR-TIM-039", polarity="violation")
def test_refused_rights_are_marked_at_the_top(bench: Bench) -> None:
    bench.refused = ("priority",)
    assert bench.call() == 0

    assert bench.load_record()["marks"] == ["TIMES WITHOUT REAL-TIME PRIVILEGES: denied: priority (Operation not permitted)"]
    assert (bench.out / "cost.txt").read_text(encoding="utf-8").startswith("*** TIMES WITHOUT")


@pytest.mark.verifies("SWR-TIM-039", technique="error_guessing", polarity="violation")
def test_stopped_count_leaves_no_result_and_no_earlier_one(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.call() == 0
    bench.error = KeyboardInterrupt()

    assert bench.call("--accept", str(bench.baseline)) == 130
    assert not any((bench.out / name).exists() for name in command.RESULTS)
    assert not bench.baseline.exists()
    assert "stopped" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-039", technique="fault_injection", polarity="violation")
def test_program_that_fails_is_told_with_its_log_and_status_1(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.error = WorkError("class 'still', by count: the program ended with status 1")

    assert bench.call() == 1
    assert "failed: class 'still', by count: the program ended with status 1" in capsys.readouterr().err
    assert not (bench.out / "cost.json").exists()


@pytest.mark.verifies("SWR-TIM-039", technique="boundary_values", polarity="violation")
def test_classes_in_which_nothing_ran_are_no_result(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.counts = {}
    assert bench.call() == 1
    assert "no step was counted in any class" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-035", polarity="violation")
def test_budget_that_is_too_low_ends_with_status_1_and_stands_in_the_record(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.document["windows"][1]["budget_ns"] = 35_000
    assert bench.call("--accept", str(bench.baseline)) == 1

    (finding,) = bench.load_record()["findings"]
    assert finding.startswith("window 'control': budget 35 us, but 12000 instructions (class 'still', cycle 13, most of them by 'controller')")
    shown = capsys.readouterr()
    assert f"finding: {finding}" in shown.out and "not accepted" in shown.err
    assert not bench.baseline.exists()


@pytest.mark.verifies("SWR-TIM-037")
def test_accepted_maxima_are_checked_against(bench: Bench) -> None:
    assert bench.call("--accept", str(bench.baseline)) == 0
    assert bench.call("--check", str(bench.baseline)) == 0


@pytest.mark.verifies("SWR-TIM-037", polarity="violation")
def test_growth_ends_with_status_1_and_names_the_component(bench: Bench) -> None:
    assert bench.call("--accept", str(bench.baseline)) == 0
    bench.counts = {**COUNTS, 3: (100, 100, 100, 103)}

    assert bench.call("--check", str(bench.baseline)) == 1
    assert [line.partition(":")[0] for line in bench.load_record()["findings"]] == [
        f"component 'drive', execute, class '{name}'" for name in ("still", "other")]  # fmt: skip


@pytest.mark.verifies("SWR-TIM-037")
def test_one_class_is_checked_against_its_part_of_the_baseline(bench: Bench) -> None:
    assert bench.call("--accept", str(bench.baseline)) == 0
    bench.counted.clear()

    assert bench.call("--check", str(bench.baseline), "--class", "other") == 0
    assert bench.counted == ["other"]


@pytest.mark.verifies("SWR-TIM-038", polarity="violation")
def test_baseline_of_another_compiler_ends_with_status_2_and_no_result(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert bench.call("--accept", str(bench.baseline)) == 0
    bench.build = Build("Clang 19.1.0", "-O2", "glibc 2.36")

    assert bench.call("--check", str(bench.baseline)) == 2
    assert "was made with the compiler 'GNU 12.2.0', this program with 'Clang 19.1.0'" in capsys.readouterr().err
    assert not (bench.out / "cost.json").exists()


@pytest.mark.parametrize(("words", "complaint"), [
    (("--class", "stil"), "cost: there is no class of inputs 'stil'; nearest: still"),
    (("--check", "a", "--accept", "b"), "--check and --accept exclude each other"),
    (("--check", "/absent.toml"), "/absent.toml: baseline not found"),
    (("--accept", "/"), "'/' is a folder"),
    (("--accept", "/proc/none/b.toml"), "not writable"),
    (("--class", "still", "--accept", "b"), "--accept takes all classes of inputs"),
    (("--out", "/proc/none"), "cost: /proc/none: not writable"),
    (("--clas", "still"), "cost has no option '--clas'; nearest: --class"),
    (("--jobs", "0"), "'0' is not an integer of at least 1"),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-036", technique="equivalence_classes", polarity="violation")
def test_wrong_words_end_with_one_line_and_status_2_before_anything_runs(
    bench: Bench, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], complaint: str
) -> None:
    assert bench.call(*words) == 2

    error = capsys.readouterr().err
    assert complaint in error and error.count("\n") == 1
    assert bench.counted == []


@pytest.mark.verifies("SWR-TIM-036", polarity="violation")
def test_unknown_system_is_answered_with_those_that_there_are(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cost", "examples/safe_leg"]) == 2
    assert "cost: there is no system 'examples/safe_leg'; nearest: examples/safe_arm" in capsys.readouterr().err


@pytest.mark.verifies("SWR-TIM-036", technique="fault_injection", polarity="violation")
def test_missing_valgrind_is_told_with_its_package(bench: Bench, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(command.shutil, "which", lambda name: None)

    assert bench.call() == 2
    assert "valgrind is missing" in capsys.readouterr().err
    assert bench.counted == []


@pytest.mark.verifies("SWR-TIM-036", technique="fault_injection", polarity="violation")
def test_program_that_was_not_built_is_told(bench: Bench, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(command.os, "access", lambda path, mode: False)
    assert bench.call() == 2
    assert "was not built; correct 'program'" in capsys.readouterr().err

    monkeypatch.setattr(command, "build_system", lambda system, context: False)
    assert bench.call() == 1


@pytest.mark.verifies("SWR-TIM-036")
def test_results_of_the_project_go_to_its_evidence(bench: Bench) -> None:
    job = command.check(command.Request(str(bench.folder)), 1)

    assert job.folder == Project(bench.folder).evidence / "cost" / "arm"
    assert [one.name for one in job.classes] == ["still", "other"]
