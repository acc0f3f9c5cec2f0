# SPDX-License-Identifier: Apache-2.0
# Goal: each step has the count of its own call, and inconsistent runs are rejected. Method: prepared files and callgrind output;
# verification/proofs/test_cost.py proves that real counts are exact.
from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from cost_run import COUNTS, EMPTY, load_table, make_class, make_dumps, make_steps, write_files
from timing_run import make_table

from mamori_tools.cost import run
from mamori_tools.cost.run import ClassRun, run_class
from mamori_tools.host.callgrind import list_totals
from mamori_tools.timing.run import Ending
from mamori_tools.timing.system import System
from mamori_trace.base.errors import InputError, WorkError

ONE = make_class()
REFERENCE = 10_000


class FakeRuns:
    """Writes the files of both runs without running a program. Tests change their content."""

    def __init__(self, folder: Path) -> None:
        self.document = make_table()
        self.steps, instructions = make_steps(load_table(folder), ONE, COUNTS)
        self.steps["end_ns"] = 120
        self.timed = self.steps.copy()
        self.totals: list[int] = [EMPTY, REFERENCE + EMPTY, *(int(count) + EMPTY for count in instructions)]
        self.facts: dict[str, Any] = {}
        self.ending = Ending(0, 1.0)
        self.argvs: list[Sequence[str]] = []

    def __call__(self, argv: Sequence[str], log: Path, expected_s: float, tick: Callable[[float], None]) -> Ending:
        words = list(argv)
        self.argvs.append(words)
        tick(expected_s)
        is_clock = words[words.index("--by") + 1] == "clock"
        write_files(Path(words[words.index("--out") + 1]), self.document, ONE, self.timed if is_clock else self.steps, **self.facts)
        if not is_clock:
            out = next(word for word in words if word.startswith("--callgrind-out-file=")).partition("=")[2]
            Path(out).write_text(make_dumps(self.totals), encoding="utf-8")
        return self.ending


@pytest.fixture
def runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> FakeRuns:
    fake = FakeRuns(tmp_path)
    monkeypatch.setattr(run, "run_program", fake)
    return fake


def count(folder: Path) -> ClassRun:
    return run_class(System("subject", Path("/bin/subject"), arguments=("--model", "m")), ONE, folder / "log", lambda text: None)


@pytest.mark.verifies("SWR-TIM-032")
def test_each_step_has_the_count_of_its_own_call_without_those_of_counting(tmp_path: Path, runs: FakeRuns) -> None:
    result = count(tmp_path)

    assert result.instructions.tolist() == [values[cycle] for cycle in range(4) for values in COUNTS.values()]
    assert result.reference_instructions == REFERENCE
    assert result.facts.notes == ("a note",)
    assert result.facts.build.flags == "-O2"


@pytest.mark.verifies("SWR-TIM-033")
def test_times_are_those_between_the_readings_less_the_readings(tmp_path: Path, runs: FakeRuns) -> None:
    runs.timed["end_ns"][3] = 5
    assert count(tmp_path).times_ns.tolist()[:4] == [100, 100, 100, 0]


@pytest.mark.verifies("SWR-TIM-032")
def test_both_runs_get_the_same_arguments(tmp_path: Path, runs: FakeRuns) -> None:
    count(tmp_path)

    under, by_clock = ([word for word in argv if "--out" not in word and "/" not in word] for argv in runs.argvs)
    assert "--toggle-collect=mamori_counted_step" in under
    start = under.index("cost")
    assert under[start:] == ["cost", "--by", "count", "--cycles", "14", "--first", "10", "--every", "1", "--model", "m"]
    assert by_clock == [word.replace("count", "clock") for word in under[start:]]


@pytest.mark.verifies("SWR-TIM-032", technique="fault_injection", polarity="violation")
def test_count_with_another_number_of_calls_is_refused(tmp_path: Path, runs: FakeRuns) -> None:
    runs.totals.append(100)
    with pytest.raises(WorkError, match=r"callgrind saw 19 calls of mamori_counted_step\(\), the program noted 16 steps and 2 other"):
        count(tmp_path)


@pytest.mark.parametrize("text", ["", "totals: 3\n", make_dumps([3]).replace("totals: 0", "totals: 5"), make_dumps([3]).partition("part: 9")[0],
                                  make_dumps([3]).replace("totals: 3", "totals: x"),
                                  make_dumps([3, 4]).replace("--dump-after=mamori_counted_step", "Client Request", 1)])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-032", technique="equivalence_classes", polarity="violation")
def test_output_of_callgrind_that_is_cut_off_or_of_something_else_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "out"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(WorkError, match="the output of callgrind"):
        list_totals(path)
    with pytest.raises(WorkError, match="cannot be read"):
        list_totals(tmp_path / "absent")


@pytest.mark.verifies("SWR-TIM-032")
def test_totals_are_listed_call_by_call(tmp_path: Path) -> None:
    path = tmp_path / "out"
    path.write_text(make_dumps([9, 100, 100]), encoding="utf-8")
    assert list_totals(path) == [9, 100, 100]


@pytest.mark.parametrize("key", ["release_ns", "component", "pass"])
@pytest.mark.verifies("SWR-TIM-033", technique="fault_injection", polarity="violation")
def test_runs_that_did_not_do_the_same_are_refused(tmp_path: Path, runs: FakeRuns, key: str) -> None:
    runs.timed[key][5] += 1
    with pytest.raises(WorkError, match=r"step 5 was of 'monitor'.*must do the same again"):
        count(tmp_path)


@pytest.mark.verifies("SWR-TIM-033", technique="fault_injection", polarity="violation")
def test_runs_of_another_length_are_refused(tmp_path: Path, runs: FakeRuns) -> None:
    runs.timed = runs.timed[:-1]
    with pytest.raises(WorkError, match="16 steps under callgrind, 15 in real time"):
        count(tmp_path)


@pytest.mark.parametrize(("key", "value", "complaint"), [
    ("schema", "mamori.timing_run/1", "this command reads 'mamori.cost_run/1'"), ("cycles", 13, "is 13, must be 14"),
    ("first", 0, "is 0, must be 10"), ("every", 2, "must be 1"), ("frame_ns", 5, "must be 1000000"), ("lost_rows", 3, "is 3, must be 0"),
    ("calibration_count", 0, "must be positive"), ("empty_ns", -1, "must not be negative"), ("compiler", 3, "must be a text"),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-032", technique="equivalence_classes", polarity="violation")
def test_files_of_something_else_are_refused(tmp_path: Path, runs: FakeRuns, key: str, value: object, complaint: str) -> None:
    runs.facts = {key: value}
    with pytest.raises(InputError, match=complaint):
        count(tmp_path)


@pytest.mark.verifies("SWR-TIM-032", technique="fault_injection", polarity="violation")
def test_step_of_a_component_that_is_not_there_is_refused(tmp_path: Path, runs: FakeRuns) -> None:
    runs.steps["component"][0] = 99
    with pytest.raises(InputError, match=r"have a component index outside the table \(4 components\)"):
        count(tmp_path)


@pytest.mark.verifies("SWR-TIM-032", technique="fault_injection", polarity="violation")
def test_table_that_breaks_a_rule_is_refused(tmp_path: Path, runs: FakeRuns) -> None:
    runs.document["findings"] = ["windows overlap"]
    with pytest.raises(InputError, match="breaks a rule: windows overlap"):
        count(tmp_path)


@pytest.mark.parametrize(("ending", "error", "text"), [
    (Ending(2, 1.0), InputError, "refuses its arguments"), (Ending(1, 1.0), WorkError, "ended with status 1"),
    (Ending(-11, 1.0), WorkError, "SIGSEGV"), (Ending(0, 99.0, was_late=True), WorkError, "did not end"),
    (Ending(130, 1.0), WorkError, "was stopped"), (Ending(0, 1.0, was_interrupted=True), KeyboardInterrupt, ""),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-032", technique="error_guessing", polarity="violation")
def test_program_that_does_not_end_well_is_told(tmp_path: Path, runs: FakeRuns, ending: Ending, error: type[BaseException], text: str) -> None:
    runs.ending = ending
    with pytest.raises(error, match=text or None):
        count(tmp_path)


@pytest.mark.verifies("SWR-TIM-039", technique="error_guessing", polarity="violation")
def test_nothing_is_left_of_the_runs(tmp_path: Path, runs: FakeRuns, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "scratch"))
    (tmp_path / "scratch").mkdir()
    runs.ending = Ending(0, 1.0, was_interrupted=True)
    with pytest.raises(KeyboardInterrupt):
        count(tmp_path)

    assert list((tmp_path / "scratch").iterdir()) == []
