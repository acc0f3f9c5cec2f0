# SPDX-License-Identifier: Apache-2.0
# Goal: equal inputs give equal port-trace hashes: in repeated runs, with -O0 and -O2, g++ and clang++. Different inputs give a different
# hash. Method: a short part of the shipped motion with a fault, so that the hash includes the reaction.
from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.host.project import SANITIZED, Project
from mamori_tools.motion import load_limits, read_motion, write_canonical
from verification.proofs.determinism import VARIANTS, Inputs, Variant, build_variant, find_differences, get_trace_hash

RUNS = 20
FRAMES = 2500
FAULT = "kind=encoder_freeze,joint=2,channel=a,at=1.5"


@pytest.fixture(scope="module")
def inputs(project: Project, tmp_path_factory: pytest.TempPathFactory) -> Inputs:
    table = tmp_path_factory.mktemp("motion") / "motion.txt"
    write_canonical(read_motion(project.motion, load_limits(project.model)), table)
    return Inputs(project.model, table, FAULT, seed=1, frames=FRAMES)


@pytest.fixture(scope="module")
def wanted(project: Project, inputs: Inputs, tmp_path_factory: pytest.TempPathFactory) -> str:
    return get_trace_hash(project.safe_arm, inputs, tmp_path_factory.mktemp("first"))


@pytest.mark.verifies("SWR-PRF-005")
def test_twenty_runs_give_one_hash(project: Project, inputs: Inputs, wanted: str, tmp_path: Path) -> None:
    hashes = [get_trace_hash(project.safe_arm, inputs, tmp_path / str(run)) for run in range(2, RUNS + 1)]

    assert find_differences(wanted, hashes) == []


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)
@pytest.mark.verifies("SWR-PRF-005")
def test_compilers_and_levels_give_one_hash(
    project: Project, inputs: Inputs, wanted: str, tmp_path: Path, variant: Variant
) -> None:
    other = dataclasses.replace(project, preset=f"determinism-{variant.name}")
    build_variant(project.root, other.build, variant, project.safe_arm.name, os.cpu_count() or 1)

    assert find_differences(wanted, {variant.name: get_trace_hash(other.safe_arm, inputs, tmp_path)}) == []


@pytest.mark.verifies("SWR-PRF-005")
def test_sanitized_build_runs_clean_and_gives_the_same_hash(
    project: Project, inputs: Inputs, wanted: str, tmp_path: Path
) -> None:
    sanitized = dataclasses.replace(project, preset=SANITIZED)

    assert find_differences(wanted, {SANITIZED: get_trace_hash(sanitized.safe_arm, inputs, tmp_path)}) == []


@pytest.mark.parametrize("change", [{"fault": FAULT.replace("at=1.5", "at=1.501")}, {"frames": FRAMES - 1}], ids=str)
@pytest.mark.verifies("SWR-PRF-005", technique="error_guessing", polarity="violation")
def test_other_inputs_give_another_hash(
    project: Project, inputs: Inputs, wanted: str, tmp_path: Path, change: dict[str, Any]
) -> None:
    changed = dataclasses.replace(inputs, **change)

    assert get_trace_hash(project.safe_arm, changed, tmp_path) != wanted
