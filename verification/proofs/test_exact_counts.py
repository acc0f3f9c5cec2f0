# SPDX-License-Identifier: Apache-2.0
# Goal: no operation exceeds its baseline or its instruction limit, and none uses the heap or a system call after start. Method: callgrind
# over the release build; a process in which a system call is fatal. Seeded violations must be found.
from __future__ import annotations

import warnings
from pathlib import Path

import pytest

from mamori_tools.host.callgrind import ask_about, makes_system_calls, run_callgrind
from mamori_tools.host.project import Project
from verification.bench.bars import CountBar, load_bars
from verification.bench.baseline import calc_count, judge_count, load_baseline
from verification.bench.command import SEALED
from verification.bench.judge import PASSED
from verification.bench.programs import Programs

COUNTS = load_bars().counts


@pytest.fixture(scope="module")
def program(project: Project) -> Path:
    program = Programs(project).exact
    assert program.exists(), f"{program} is missing; run ./mamori bench --only exact"
    return program


@pytest.mark.parametrize("bar", COUNTS, ids=lambda bar: bar.name)
@pytest.mark.verifies("SWR-BEN-006")
def test_count_is_within_its_limit_and_not_above_its_baseline(program: Path, bar: CountBar) -> None:
    about = ask_about(program)
    profiles = {name: run_callgrind(program, name) for name in bar.operations}

    result = judge_count(bar, calc_count(bar, profiles), load_baseline(), str(about["compiler"]), str(about["c_library"]))

    assert result.verdict == PASSED or result.is_known_miss, f"{bar.title}: {result.count} instructions: {result.note}"
    if result.note:
        warnings.warn(f"{bar.title}: {result.count} instructions: {result.note}", stacklevel=1)


@pytest.mark.verifies("SWR-BEN-006", technique="back_to_back")
def test_count_is_the_same_again(program: Path) -> None:
    assert run_callgrind(program, "port_64") == run_callgrind(program, "port_64")


@pytest.mark.parametrize("operation", SEALED)
@pytest.mark.verifies("SWR-BEN-007")
def test_operation_uses_no_heap_after_start(program: Path, operation: str) -> None:
    profile = run_callgrind(program, operation)

    assert f"measured_{operation}" in profile.functions
    assert profile.heap_functions == []


@pytest.mark.parametrize("operation", SEALED)
@pytest.mark.verifies("SWR-BEN-007")
def test_operation_makes_no_system_call_after_start(program: Path, operation: str) -> None:
    assert not makes_system_calls(program, operation)


@pytest.mark.verifies("SWR-BEN-007", technique="fault_injection", polarity="violation")
def test_seeded_use_of_the_heap_is_found(program: Path) -> None:
    assert {"malloc", "free"} <= set(run_callgrind(program, "seeded_heap").heap_functions)


@pytest.mark.verifies("SWR-BEN-007", technique="fault_injection", polarity="violation")
def test_seeded_system_call_is_found(program: Path) -> None:
    assert makes_system_calls(program, "seeded_system_call")
