# SPDX-License-Identifier: Apache-2.0
"""Shared fixtures of the prover tests: the built programs, their output, and the machine and brakes read from it."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import BrakeRelation, read_brakes
from verification.safe_state.brakes.sequence import Brakes, make_cycles
from verification.safe_state.command import BRAKE_TARGET, TARGET
from verification.safe_state.machine import Machine, merge
from verification.safe_state.relation import Relation, read_relation, run_program


def run_built(target: str) -> str:
    program = Project(ROOT).build / "verification" / "safe_state" / target
    assert program.exists(), f"{program} is missing; run ./mamori build"
    return run_program(program)


@pytest.fixture(scope="session")
def text() -> str:
    return run_built(TARGET)


@pytest.fixture(scope="session")
def relation(text: str) -> Relation:
    return read_relation(text, Path("relation.json"))


@pytest.fixture(scope="session")
def machine(relation: Relation) -> Machine:
    return merge(relation)


@pytest.fixture(scope="session")
def brake_text() -> str:
    return run_built(BRAKE_TARGET)


@pytest.fixture(scope="session")
def brake_relation(brake_text: str) -> BrakeRelation:
    return read_brakes(brake_text, Path("brakes.json"))


@pytest.fixture(scope="session")
def brakes(brake_relation: BrakeRelation) -> Brakes:
    return make_cycles(brake_relation)


@pytest.fixture(scope="session")
def pair(machine: Machine, brakes: Brakes) -> Pair:
    return Pair(machine, brakes)
