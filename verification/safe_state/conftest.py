# SPDX-License-Identifier: Apache-2.0
"""What the tests of the prover share: the built program, what it prints, and the machine in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori.verification.command.project import ROOT, Project
from mamori.verification.safe_state.command import TARGET
from mamori.verification.safe_state.machine import Machine, merge
from mamori.verification.safe_state.relation import Relation, read_relation, run_program


@pytest.fixture(scope="session")
def text() -> str:
    program = Project(ROOT).build / "verification" / "safe_state" / TARGET
    assert program.exists(), f"{program} is missing; run ./mamori build"
    return run_program(program)


@pytest.fixture(scope="session")
def relation(text: str) -> Relation:
    return read_relation(text, Path("relation.json"))


@pytest.fixture(scope="session")
def machine(relation: Relation) -> Machine:
    return merge(relation)
