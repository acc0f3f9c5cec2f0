# SPDX-License-Identifier: Apache-2.0
# Goal: 100 components at four rates on two cores give one hash: after a million cycles, in repeated runs, on a busy host, with and without
# an observing tool, from g++ and clang++ at -O0, -O2 and -Os. Method: pinned hashes; speed is recorded, not checked.
from __future__ import annotations

import dataclasses
import json
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from mamori_tools.host.project import Project
from mamori_trace.base.errors import WorkError
from verification.proofs.determinism import Variant, build_variant, find_differences
from verification.proofs.scale import OPTIONS, PROGRAM, TARGET, VARIANTS, Run, busy_machine, run_scale, write_record

LONG_CYCLES = 1_000_000
LONG_HASH = "3bebefdc2d11f998"
CYCLES = 20_000
HASH = "9c6680aca52b6f7d"
RUNS = 20
GATE_VARIANTS = ("gcc-Os", "clang-O2")

Runs = list[tuple[str, Run]]


@pytest.fixture(scope="module")
def program(project: Project) -> Path:
    return project.build / PROGRAM


@pytest.fixture(scope="module")
def runs(project: Project) -> Iterator[Runs]:
    """The runs of this file, for the evidence."""
    runs: Runs = []
    yield runs
    if runs:
        write_record(project.evidence / "scale.json", runs)


@pytest.mark.verifies("SWR-INS-006")
def test_a_million_cycles_give_the_pinned_hash(program: Path, runs: Runs) -> None:
    run = run_scale(program, LONG_CYCLES)
    runs.append(("a million cycles", run))

    assert (run.trace_hash, run.overruns) == (LONG_HASH, 0)
    assert run.lost > 0, "the slow readers are not slow"


@pytest.mark.verifies("SWR-INS-006")
def test_twenty_runs_give_one_hash_half_of_them_on_a_busy_machine(program: Path, runs: Runs) -> None:
    found = [run_scale(program, CYCLES) for _ in range(RUNS // 2)]
    with busy_machine():
        found += [run_scale(program, CYCLES) for _ in range(RUNS // 2)]
    runs += [("alone", found[0]), ("on a busy machine", found[-1])]

    assert find_differences(HASH, [run.trace_hash for run in found]) == []


@pytest.mark.verifies("SWR-INS-006", technique="back_to_back")
def test_a_tool_that_reads_1000_times_per_second_changes_no_hash(program: Path, runs: Runs) -> None:
    run = run_scale(program, CYCLES, "--watched")
    runs.append(("watched", run))

    assert run.trace_hash == HASH
    assert run.rows_read >= CYCLES * run.components


@pytest.mark.parametrize(
    "variant", [pytest.param(each, marks=() if each.name in GATE_VARIANTS else pytest.mark.long) for each in VARIANTS],
    ids=lambda variant: variant.name,
)
@pytest.mark.verifies("SWR-INS-006", technique="back_to_back")
def test_compilers_and_levels_give_one_hash(project: Project, runs: Runs, variant: Variant) -> None:
    other = dataclasses.replace(project, preset=f"scale-{variant.name}")
    build_variant(project.root, other.build, variant, TARGET, os.cpu_count() or 1, OPTIONS)

    run = run_scale(other.build / PROGRAM, CYCLES)
    runs.append((variant.name, run))

    assert run.trace_hash == HASH


@pytest.mark.verifies("SWR-INS-006", technique="boundary_values", polarity="violation")
def test_one_frame_less_gives_another_hash(program: Path) -> None:
    assert run_scale(program, CYCLES - 10).trace_hash != HASH


@pytest.mark.parametrize(
    ("words", "message"),
    [(["--cycles", "15"], "multiple of 10"), (["--cycles", "0"], "multiple of 10"), (["--cycles", "-10"], "multiple of 10"),
     (["--cycles", "10x"], "multiple of 10"), (["--cycles", "99999999999999999999990"], "multiple of 10"),
     (["--cycles"], "a number must follow"), (["--cycle"], "there is no option '--cycle'")],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)  # fmt: skip
@pytest.mark.verifies("SWR-INS-006", technique="equivalence_classes", polarity="violation")
def test_bad_words_are_refused(program: Path, words: list[str], message: str) -> None:
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False)

    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr


@pytest.mark.parametrize(
    ("script", "message"),
    [("exit 3", "status 3"), ("echo '{\"cycles\": 20}'", "no whole record"), ("echo nothing", "no whole record")],
    ids=["fails", "half a record", "no record"],
)
@pytest.mark.verifies("SWR-INS-006", technique="fault_injection", polarity="violation")
def test_a_run_without_a_result_is_no_hash(tmp_path: Path, script: str, message: str) -> None:
    program = tmp_path / "scale_run"
    with pytest.raises(WorkError, match="is missing"):
        run_scale(program, CYCLES)
    program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    program.chmod(0o755)

    with pytest.raises(WorkError, match=message):
        run_scale(program, CYCLES)


@pytest.mark.verifies("SWR-INS-007")
def test_the_record_holds_cycles_seconds_ratio_and_hash_of_each_run(tmp_path: Path) -> None:
    path = tmp_path / "evidence" / "scale.json"
    run = Run(100, 2, 5000, 5.0, 0.02, 0, 1, 0, HASH)

    write_record(path, [("short", run), ("too short to measure", dataclasses.replace(run, wall_s=0.0))])

    first, second = json.loads(path.read_text(encoding="utf-8"))["runs"]
    assert (first["name"], first["cycles"], first["wall_s"], first["trace_hash"]) == ("short", 5000, 0.02, HASH)
    assert (first["times_real_time"], second["times_real_time"]) == (250.0, 0.0)
    assert list(path.parent.iterdir()) == [path]
