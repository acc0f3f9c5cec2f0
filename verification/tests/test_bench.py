# SPDX-License-Identifier: Apache-2.0
# Goal: samples are evaluated by the medians of their ratios, missing parts are named, and invalid input is rejected early.
# Method: handwritten samples with figures that are easy to check.
from __future__ import annotations

import copy
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.command.main import main
from mamori_tools.host.console import Screen
from mamori_tools.host.project import Project
from mamori_trace.base.errors import InputError, WorkError
from verification.bench import grid
from verification.bench.bars import Bars, GrowthBar, RatioBar, load_bars
from verification.bench.command import BENCHES, list_benches, name_reason
from verification.bench.judge import ABSENT, FAILED, PASSED, RatioResult, judge
from verification.bench.picture import draw_run
from verification.bench.programs import NORMAL, QUICK, Programs
from verification.bench.record import Run, collect_host, make_record, write_record
from verification.bench.samples import parse_samples, read_samples
from verification.bench.table import format_ratio, format_time, show_run


def make_case(size: int, subjects: dict[str, list[float]], metric: str = "port") -> dict[str, Any]:
    series = [{"name": name, "batch_count": 8, "rounds_ns": times} for name, times in subjects.items()]
    return {"metric": metric, "size": size, "unit": "ns per write and read", "absent": [], "subjects": series}


RECORDED: dict[str, Any] = {
    "schema": "mamori.bench.samples/1", "compiler": "GNU 12.2.0", "flags": "-O2",
    "effort": {"rounds": 5, "batches": 3, "batch_ns": 1000},
    "absent": [{"name": "LCM memq", "reason": "its library was not found; install liblcm-dev"}],
    "cases": [make_case(8, {"mamori port": [2.0, 2.0, 8.0, 2.0, 2.0], "seqlock": [1.0, 1.0, 4.0, 1.0, 0.1]}),
              make_case(64, {"mamori port": [4.0, 4.0, 5.0, 4.0, 4.0], "seqlock": [2.0] * 5})],
}  # fmt: skip
GROWTH = GrowthBar("P5", "cost", "port", "mamori port", "seqlock", 8, 64, 1.5, "gate")


def make_bars(limit: float, kind: str = "gate", against: str = "seqlock") -> Bars:
    return Bars((RatioBar("P1", "port", "port", "mamori port", against, {8: limit, 64: limit}, kind),), (), ())


def judge_recorded(bars: Bars, **changes: Any) -> list[RatioResult]:
    return judge(parse_samples({**RECORDED, **changes}), bars)


@pytest.mark.verifies("SWR-BEN-001")
def test_ratio_is_the_median_of_the_ratios_of_the_rounds() -> None:
    result = judge_recorded(make_bars(3.0))[0]

    assert (result.ratio, result.lowest, result.highest) == (2.0, 2.0, 20.0)
    assert (result.ours_ns, result.against_ns) == (2.0, 1.0)


@pytest.mark.verifies("SWR-BEN-001", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("rounds", "verdict"), [(5, PASSED), (4, FAILED)])
def test_fewer_than_five_rounds_pass_nothing(rounds: int, verdict: str) -> None:
    cases = [make_case(8, {"mamori port": [2.0] * rounds, "seqlock": [1.0] * rounds})]

    result = judge_recorded(make_bars(3.0), cases=cases, effort={"rounds": rounds})[0]

    assert result.verdict == verdict


@pytest.mark.verifies("SWR-BEN-003", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("limit", "verdict"), [(2.0, PASSED), (1.999, FAILED)])
def test_bar_is_met_up_to_its_limit(limit: float, verdict: str) -> None:
    results = judge_recorded(make_bars(limit))

    assert [one.verdict for one in results] == [verdict, verdict]
    assert len(Run(ratios=results).failed) == (0 if verdict == PASSED else 2)


@pytest.mark.verifies("SWR-BEN-003", technique="equivalence_classes")
def test_advisory_bar_fails_no_gate() -> None:
    results = judge_recorded(make_bars(1.0, "advisory"))

    assert results[0].verdict == FAILED
    assert Run(ratios=results).failed == []


@pytest.mark.verifies("SWR-BEN-003")
def test_growth_is_judged_round_by_round() -> None:
    result = judge_recorded(Bars((), (GROWTH,), ()))[0]

    assert (result.ratio, result.size, result.against) == (2.0, 64, "itself at 8")
    assert result.verdict == FAILED


@pytest.mark.verifies("SWR-BEN-003")
def test_growth_of_the_floor_stands_beside_that_of_ours() -> None:
    cases = [make_case(8, {"mamori port": [2.0] * 5, "seqlock": [1.0, 1.0, 4.0, 1.0, 0.1]}),
             make_case(64, {"mamori port": [4.0] * 5, "seqlock": [3.0] * 5})]  # fmt: skip

    shown = judge_recorded(Bars((), (GROWTH,), ()), cases=cases)[0]
    alone = judge_recorded(Bars((), (replace(GROWTH, floor="no such subject"),), ()), cases=cases)[0]

    assert shown.note == "seqlock itself: 3.00"
    assert (alone.note, alone.ratio) == ("", 2.0)


@pytest.mark.verifies("SWR-BEN-003")
def test_bars_of_what_was_not_measured_are_left_out() -> None:
    bars = load_bars()

    assert {one.metric for one in judge_recorded(bars)} == {"port"}
    assert set(bars.metrics) < set(BENCHES)


@pytest.mark.verifies("SWR-BEN-002", technique="fault_injection", polarity="violation")
def test_absent_peer_has_its_row_and_its_reason() -> None:
    result = judge_recorded(make_bars(0.15, against="LCM memq"))[0]

    assert (result.verdict, result.note) == (ABSENT, "its library was not found; install liblcm-dev")
    assert Run(ratios=[result]).failed == []


@pytest.mark.verifies("SWR-BEN-002", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("missing", ["seqlock", "mamori port"])
def test_absent_floor_or_ours_is_a_failure(missing: str) -> None:
    cases = copy.deepcopy(RECORDED["cases"])
    cases[0]["subjects"] = [one for one in cases[0]["subjects"] if one["name"] != missing]

    assert judge_recorded(make_bars(3.0), cases=cases)[0].verdict == FAILED


def judge_protected(subjects: dict[str, list[float]]) -> list[RatioResult]:
    cases = [make_case(size, subjects, "e2e") for size in (8, 64, 1024)]
    return judge(parse_samples({**RECORDED, "cases": cases}), load_bars())


@pytest.mark.verifies("SWR-BEN-010")
def test_protected_exchange_is_compared_with_one_that_does_the_same_job_and_with_a_frame_of_the_same_checksum() -> None:
    results = judge_protected({"mamori protected port": [6.0] * 5, "hand-written exchange": [5.0] * 5, "CRC-32 frame": [4.0] * 5})

    assert [(one.id, one.size, one.ratio, one.limit, one.kind, one.verdict) for one in results] == [
        ("P2", 8, 1.2, 1.5, "gate", PASSED),
        ("P2", 64, 1.2, 1.3, "gate", PASSED),
        ("P2", 1024, 1.2, 1.1, "gate", FAILED),
        ("P2", 8, 1.5, 1.5, "advisory", PASSED),
        ("P2", 64, 1.5, 1.3, "advisory", FAILED),
        ("P2", 1024, 1.5, 1.15, "advisory", FAILED),
    ]


@pytest.mark.verifies("SWR-BEN-010", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("left", ["mamori protected port", "hand-written exchange", "CRC-32 frame"])
def test_protected_exchange_without_its_floor_fails(left: str) -> None:
    assert [one.verdict for one in judge_protected({left: [5.0] * 5})] == [FAILED] * 6


def judge_fifo(subjects: dict[str, list[float]]) -> list[RatioResult]:
    cases = [make_case(size, subjects, "fifo") for size in (8, 64, 1024)]
    return judge(parse_samples({**RECORDED, "cases": cases}), load_bars())


@pytest.mark.verifies("SWR-BUF-020")
def test_fifo_across_cores_is_compared_with_a_lamport_ring() -> None:
    subjects = {"mamori FIFO": [6.5] * 5, "mamori FIFO, overwriting": [7.0] * 5, "padded Lamport ring": [5.0] * 5}

    results = judge_fifo(subjects)

    assert [(one.size, one.ratio, one.limit, one.kind, one.verdict) for one in results] == [
        *((size, 1.3, 1.3, "gate", PASSED) for size in (8, 64, 1024)),
        *((size, 1.4, 1.3, "advisory", FAILED) for size in (8, 64, 1024)),
    ]


@pytest.mark.verifies("SWR-BUF-020", technique="fault_injection", polarity="violation")
def test_fifo_without_its_lower_bound_fails() -> None:
    results = judge_fifo({"mamori FIFO": [6.5] * 5})

    assert [one.verdict for one in results if one.kind == "gate"] == [FAILED] * 3


@pytest.mark.verifies("SWR-BEN-002")
def test_reason_of_the_build_replaces_that_of_the_configuration() -> None:
    samples = parse_samples({**RECORDED, "absent": [{"name": "iceoryx2 local", "reason": "not built"}]})

    assert name_reason(samples, "cargo is not installed").absent == {"iceoryx2 local": "cargo is not installed"}
    assert name_reason(samples, "") == samples


@pytest.mark.verifies("SWR-BEN-002")
def test_absent_peer_is_on_the_screen(capsys: pytest.CaptureFixture[str]) -> None:
    show_run(Run(samples=parse_samples(RECORDED), ratios=judge_recorded(make_bars(3.0))), Screen())

    said = capsys.readouterr().out
    assert "LCM memq: not available: its library was not found; install liblcm-dev" in said
    assert "mamori port" in said
    assert "\x1b" not in said


@pytest.mark.verifies("SWR-BEN-004")
def test_record_holds_environment_figures_and_verdicts(tmp_path: Path) -> None:
    samples = parse_samples(RECORDED)
    run = Run(samples=samples, ratios=judge(samples, make_bars(1.0)))

    path = write_record(make_record(run, {"commit": "abc"}, collect_host(), collect_host(), QUICK), tmp_path)

    record = json.loads(path.read_text(encoding="utf-8"))
    assert record["schema"] == "mamori.bench/1"
    assert record["environment"]["commit"] == "abc"
    assert {"governor", "load_1_min", "clock_source"} <= set(record["host"]["before"])
    assert record["cases"][0]["subjects"][0] == {"name": "mamori port", "p50_ns": 2.0, "rounds_ns": [2.0, 2.0, 8.0, 2.0, 2.0]}
    assert len(record["failed_gates"]) == 2
    assert record["absent"] == {"LCM memq": "its library was not found; install liblcm-dev"}
    assert [entry.name for entry in tmp_path.iterdir()] == ["bench.json"]


@pytest.mark.verifies("SWR-BEN-004")
def test_picture_is_drawn_in_both_formats(tmp_path: Path) -> None:
    samples = parse_samples(RECORDED)

    paths = draw_run(Run(samples=samples, ratios=judge(samples, make_bars(3.0))), tmp_path, "a machine")

    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["bench.png", "bench.svg"]
    assert paths[1].read_bytes().startswith(b"\x89PNG")
    assert draw_run(Run(), tmp_path, "nothing measured") == []


@pytest.mark.verifies("SWR-BEN-004", technique="boundary_values")
def test_figures_are_short() -> None:
    assert [format_time(value) for value in (0.374, 9.994, 10.0, 99.94, 100.2, 38978.0)] == ["0.37", "9.99", "10.0", "99.9", "100",
                                                                                             "38978"]  # fmt: skip
    assert [format_ratio(value) for value in (0.0134, 0.15, 1.6, 10.0)] == ["0.013", "0.15", "1.60", "10.0"]


@pytest.mark.verifies("SWR-BEN-005", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("bench", "--only", "prot"), "bench has no benchmark 'prot'; nearest: port"),
        (("bench", "--only", "port", "--accept"), "leave --only out, or name 'exact' with it"),
        (("bench", "--out", "/proc/nowhere"), "/proc/nowhere: results cannot be written there"),
        (("bench", "--qick"), "bench has no option '--qick'; nearest: --quick"),
        (("bench", "extra"), "bench does not take 'extra'"),
    ],
)
def test_wrong_word_ends_before_anything_is_built(words: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
                                                  ) -> None:  # fmt: skip
    assert main(words) == 2

    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1


@pytest.mark.verifies("SWR-BEN-005")
def test_list_names_every_benchmark_and_bar(capsys: pytest.CaptureFixture[str]) -> None:
    assert list_benches() == 0

    said = capsys.readouterr().out
    assert all(name in said for name in BENCHES)
    bars = load_bars()
    titles = [*(bar.title for bar in bars.ratios), *(bar.title for bar in bars.growths), *(bar.title for bar in bars.counts)]
    assert all(title in said for title in titles)


@pytest.mark.verifies("SWR-BEN-005", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"schema": "other/1"}, "schema is 'other/1'"),
        ({"cases": [make_case(8, {"seqlock": [1.0]})]}, "seqlock has 1 rounds, the run had 5"),
        ({"cases": [make_case(8, {"seqlock": [1.0, 1.0, 1.0, 1.0, 0.0]})]}, "no positive number"),
        ({"cases": [make_case(8, {"seqlock": [1.0, 1.0, 1.0, 1.0, float("nan")]})]}, "no positive number"),
        ({"cases": [{}]}, "is no file of samples"),
    ],
)
def test_samples_of_another_form_are_refused(tmp_path: Path, change: dict[str, Any], sentence: str) -> None:
    path = tmp_path / "samples.json"
    path.write_text(json.dumps({**RECORDED, **change}), encoding="utf-8")

    with pytest.raises(InputError, match=sentence):
        read_samples(path)


@pytest.mark.verifies("SWR-BEN-005", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("ratio = 1 2", "is no TOML"),
        ("growth = []\ncount = []", "a bar lacks its 'ratio'"),
        ("ratio = []\ncount = []\n[[growth]]\nid='P5'\ntitle='t'\nmetric='m'\nours='o'\nfloor='f'\nfrom=1\nto=2\nlimit=0\nkind='gate'",
         "must be greater than 0"),
        ("ratio = []\ngrowth = []\n[[count]]\nid='P8'\nname='n'\ntitle='t'\noperations=[]", "not one or two"),
    ],
)  # fmt: skip
def test_bars_of_another_form_are_refused(tmp_path: Path, text: str, sentence: str) -> None:
    path = tmp_path / "bars.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(InputError, match=sentence):
        load_bars(path)


@pytest.mark.verifies("SWR-BEN-001", technique="boundary_values")
def test_every_effort_has_rounds_enough() -> None:
    assert min(NORMAL.rounds, QUICK.rounds) >= 5


class GridBox:
    """Simulated programs of a wake-up benchmark: each call returns the next of its outputs."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, answers: dict[str, list[str | int]]) -> None:
        self.calls: list[str] = []
        self.folder = folder
        self.answers = answers
        monkeypatch.setattr(grid, "run_logged", self.run)
        monkeypatch.setattr(grid.shutil, "which", lambda name: name if name in answers else None)

    def run(self, argv: list[str], log: Path, cwd: Path, tick: Any) -> int:
        name = Path(argv[0]).name
        self.calls.append(name)
        answer = self.answers[name].pop(0)
        if isinstance(answer, int):
            log.write_text("the machine grants no fixed priority\n", encoding="utf-8")
            return answer
        (self.folder / "grid.json").write_text(answer, encoding="utf-8")
        return 0

    def measure(self, rounds: int) -> tuple[dict[str, list[grid.Turn]], dict[str, str]]:
        effort = replace(QUICK, rounds=rounds, grid_cycles=4)
        with (self.folder / "log").open("a", encoding="utf-8") as log:
            return grid.measure_grid(Programs(Project(self.folder)), effort, self.folder, lambda _: None, log)


def ours_says(*lateness: int) -> str:
    return json.dumps({"schema": "mamori.bench.grid/1", "lateness_ns": lateness})


def peer_says(histogram: dict[str, int], cycles: int, resolution: int = 1) -> str:
    return json.dumps({"resolution_in_ns": resolution, "thread": {"0": {"histogram": histogram, "cycles": cycles}}})


@pytest.mark.verifies("SWR-BEN-009")
def test_grid_takes_turns_and_compares_percentiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    box = GridBox(tmp_path, monkeypatch, {"mamori_bench": [ours_says(30, 10, 20, 90), ours_says(20, 20, 20, 20)],
                                          "cyclictest": [peer_says({"10": 2, "20": 2}, 4), peer_says({"10": 4}, 4)]})  # fmt: skip

    turns, absent = box.measure(2)

    assert box.calls == ["cyclictest", "mamori_bench", "mamori_bench", "cyclictest"]
    assert absent == {}
    samples = grid.add_grid(parse_samples(RECORDED), turns, absent)
    assert samples.cases["grid", 50].series["mamori grid"].rounds_ns == (20.0, 20.0)
    assert samples.cases["grid", 50].series["cyclictest"].rounds_ns == (10.0, 10.0)
    assert samples.cases["port", 8].size == 8, "what was measured before stays"
    results = [one for one in judge(samples, load_bars()) if one.id == "P7"]
    assert [(one.size, one.ratio, one.limit, one.kind) for one in results] == [(50, 2.0, 1.3, "advisory"),
                                                                               (99, 1.75, 1.5, "advisory")]  # fmt: skip


@pytest.mark.verifies("SWR-BEN-009", technique="boundary_values")
def test_percentile_counts_what_was_too_long_for_the_histogram() -> None:
    turn = grid.Turn({5: 50, 7: 48}, 100)

    assert [turn.calc_percentile(percent) for percent in (0, 49, 50, 51, 98, 99)] == [5.0, 5.0, 5.0, 7.0, 7.0, 1e6]
    assert grid.Turn({0: 1}, 1).calc_percentile(50) == 1.0, "a time of nothing has no ratio"


@pytest.mark.verifies("SWR-BEN-009", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("answers", "missing", "reason"),
    [({"mamori_bench": [ours_says(10)] * 5}, "cyclictest", "install rt-tests"),
     ({"mamori_bench": [ours_says(10)] * 5, "cyclictest": [1]}, "cyclictest", "grants no fixed priority"),
     ({"mamori_bench": [1], "cyclictest": [peer_says({"10": 1}, 1)] * 5}, "mamori grid", "grants no fixed priority")],
)  # fmt: skip
def test_grid_without_a_program_or_its_rights_is_not_available(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answers: dict[str, list[str | int]], missing: str, reason: str
) -> None:
    turns, absent = GridBox(tmp_path, monkeypatch, answers).measure(5)

    assert list(absent) == [missing] and missing not in turns
    results = [one for one in judge(grid.add_grid(parse_samples(RECORDED), turns, absent), load_bars()) if one.id == "P7"]
    assert {one.verdict for one in results} == {ABSENT}
    assert all(reason in one.note for one in results)
    assert Run(ratios=results).failed == []


@pytest.mark.verifies("SWR-BEN-009", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("answer", ["", "{}", peer_says({"10": 1}, 1, resolution=0), peer_says({"x": 1}, 1)])
def test_words_of_cyclictest_that_are_no_figures_end_the_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str
                                                              ) -> None:  # fmt: skip
    box = GridBox(tmp_path, monkeypatch, {"mamori_bench": [ours_says(10)] * 5, "cyclictest": [answer]})

    with pytest.raises(WorkError, match="cyclictest wrote no figures"):
        box.measure(5)
