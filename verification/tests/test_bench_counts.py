# SPDX-License-Identifier: Apache-2.0
# Goal: callgrind output is read correctly, and counts are compared with limit and baseline. Method: recorded output.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.callgrind import Profile, parse_profile
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context
from mamori_trace.base.errors import InputError, WorkError
from verification.bench import command
from verification.bench.bars import CountBar, load_bars
from verification.bench.baseline import Baseline, CountResult, calc_count, judge_count, load_baseline, write_baseline
from verification.bench.command import SEALED, Request, Work, describe_calls
from verification.bench.judge import FAILED, PASSED
from verification.bench.programs import Programs
from verification.bench.record import Run, collect_host

RECORDED = """# callgrind format
version: 1
creator: callgrind-3.19.0
positions: line
events: Ir
summary: 27000

ob=(3) /usr/lib/libc.so.6
fl=(154) malloc.c
fn=(900) malloc
3281 5000
+7 2000

fn=(1190) measured_seeded
20 16000
cfn=(900)
calls=1000 3281
+1 7000
cfn=(77) free
calls=1000 40
* 4000

fn=(78) operator new(unsigned long)
12 0

fn=(77)
40 4000
totals: 27040
"""
BAR = CountBar("P8", "port_64", "port", ("port_64",), 75)
BASELINE = Baseline("GNU 12.2.0", "glibc 2.36", {"port_64": 64})


def judge(count: int, bar: CountBar = BAR, compiler: str = "GNU 12.2.0") -> CountResult:
    return judge_count(bar, count, BASELINE, compiler, "glibc 2.36")


@pytest.mark.verifies("SWR-BEN-006")
def test_count_is_the_summary_over_the_repetitions() -> None:
    assert parse_profile(RECORDED).instructions == 27000
    assert parse_profile(RECORDED).calc_count(1000) == 27


@pytest.mark.verifies("SWR-BEN-006", technique="fault_injection", polarity="violation")
def test_repetitions_that_differ_have_no_exact_count() -> None:
    with pytest.raises(WorkError, match="27001 instructions are not 1000 times the same number"):
        Profile(27001, frozenset()).calc_count(1000)


@pytest.mark.verifies("SWR-BEN-006", technique="fault_injection", polarity="violation")
def test_output_without_summary_is_refused() -> None:
    with pytest.raises(WorkError, match="no summary"):
        parse_profile("events: Ir\n")


@pytest.mark.verifies("SWR-BEN-006")
def test_second_operation_is_taken_off() -> None:
    profiles = {"twenty": Profile(50_000, frozenset()), "ten": Profile(30_000, frozenset())}

    assert calc_count(CountBar("P8", "ten_more", "ten more", ("twenty", "ten")), profiles) == 20


@pytest.mark.verifies("SWR-BEN-007")
def test_functions_are_those_that_ran_and_not_those_that_were_zeroed() -> None:
    profile = parse_profile(RECORDED)

    assert profile.functions == {"malloc", "measured_seeded", "free"}
    assert profile.heap_functions == ["free", "malloc"]


@pytest.mark.verifies("SWR-BEN-007", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("name", ["malloc", "malloc'2", "calloc@@GLIBC_2.2.5", "operator new(unsigned long)", "operator delete[](void*)",
                                  "_Znwm", "_ZdlPv", "posix_memalign", "mmap64", "realloc"])  # fmt: skip
def test_each_function_of_the_heap_is_known(name: str) -> None:
    assert Profile(1, frozenset({name, "measured_port_64", "mamori::freeze()"})).heap_functions == [name]


@pytest.mark.verifies("SWR-BEN-007")
def test_what_an_operation_did_is_said_in_words() -> None:
    assert describe_calls([], False) == ""
    assert describe_calls(["free", "malloc"], True) == "uses the heap (free, malloc) and makes system calls"
    assert Run(proofs={"port_64": "makes system calls", "port_8": ""}).failed == ["port_64: makes system calls"]


@pytest.mark.verifies("SWR-BEN-006", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("count", "verdict", "note"),
    [
        (63, PASSED, "1 fewer than the baseline; lower it with ./mamori bench --accept"),
        (64, PASSED, ""),
        (65, FAILED, "1 more than the baseline; if that is meant, say why in the commit and ./mamori bench --accept"),
        (76, FAILED, "over the limit of 75"),
    ],
)
def test_count_is_judged_at_both_sides_of_baseline_and_limit(count: int, verdict: str, note: str) -> None:
    result = judge(count)

    assert (result.verdict, result.note) == (verdict, note)
    assert len(Run(counts=[result]).failed) == (verdict == FAILED)


@pytest.mark.verifies("SWR-BEN-006", technique="state_transition", polarity="violation")
@pytest.mark.parametrize(("count", "is_known_miss"), [(64, True), (65, False), (50, False)])
def test_marked_miss_may_not_grow_and_its_mark_may_not_outlive_it(count: int, is_known_miss: bool) -> None:
    result = judge(count, CountBar("P8", "port_64", "port", ("port_64",), 50, missed=True))

    assert result.verdict == FAILED
    assert result.is_known_miss == is_known_miss


@pytest.mark.verifies("SWR-BEN-006", technique="error_guessing", polarity="violation")
def test_count_without_baseline_is_not_taken_for_granted() -> None:
    result = judge(1, CountBar("P8", "other", "other", ("other",)))

    assert (result.verdict, result.note) == (FAILED, "is not in the baseline; take it in with ./mamori bench --accept")


@pytest.mark.verifies("SWR-BEN-008", technique="equivalence_classes")
def test_other_compiler_is_held_to_limits_only_and_told_why() -> None:
    more, over = judge(70, compiler="Clang 19.1.7"), judge(76, compiler="Clang 19.1.7")

    assert (more.verdict, over.verdict) == (PASSED, FAILED)
    assert more.note == "not compared: the baseline belongs to GNU 12.2.0, glibc 2.36, this is Clang 19.1.7, glibc 2.36"


@pytest.mark.verifies("SWR-BEN-008")
def test_accepted_baseline_is_read_back(tmp_path: Path) -> None:
    write_baseline(BASELINE, tmp_path / "baseline.toml")

    assert load_baseline(tmp_path / "baseline.toml") == BASELINE
    assert [entry.name for entry in tmp_path.iterdir()] == ["baseline.toml"]


@pytest.mark.verifies("SWR-BEN-008", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("text", ["[belongs_to", "[instructions]\nport_64 = 1\n", "instructions = 3\n",
                                  "[belongs_to]\ncompiler='a'\nc_library='b'\n[instructions]\nport_64 = 'x'\n"])  # fmt: skip
def test_broken_baseline_says_how_to_write_it_anew(tmp_path: Path, text: str) -> None:
    path = tmp_path / "baseline.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(InputError, match=r"write it anew with ./mamori bench --accept"):
        load_baseline(path)


@pytest.mark.verifies("SWR-BEN-008", technique="interface")
def test_shipped_baseline_has_every_count_that_the_bars_name() -> None:
    assert set(load_baseline().counts) == {bar.name for bar in load_bars().counts}
    assert set(SEALED) <= {name for bar in load_bars().counts for name in bar.operations}


def finish(request: Request, run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch) -> int:
    """Ends a call of `bench` with the result `run`; its baseline is in `folder`."""
    monkeypatch.setattr(command, "write_baseline", lambda baseline: write_baseline(baseline, folder / "baseline.toml"))
    project = Project(ROOT)
    work = Work(request, load_bars(), BASELINE, Programs(project), folder / "samples.json", run=run)
    return command.show(work, Context(project, 1), folder, collect_host())


@pytest.mark.verifies("SWR-BEN-003", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("count", "gates", "status"), [(76, True, 1), (76, False, 0), (64, True, 0), (64, False, 0)])
def test_failed_gate_gives_status_1_when_gates_are_asked_for(
    count: int, gates: bool, status: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert finish(Request(gates=gates), Run(counts=[judge(count)]), tmp_path, monkeypatch) == status

    assert f"gates: {int(count == 76)} of 1 failed" in capsys.readouterr().out


@pytest.mark.verifies("SWR-BEN-008", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("accepts", [True, False])
def test_baseline_is_written_only_when_told_to(accepts: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    finish(Request(accepts=accepts), Run(counts=[judge(65)]), tmp_path, monkeypatch)

    assert (tmp_path / "baseline.toml").exists() == accepts
