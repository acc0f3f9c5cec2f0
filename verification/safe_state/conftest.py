# SPDX-License-Identifier: Apache-2.0
"""Shared fixtures of the prover tests: one run of the command, the relations that it stored, and the machine and brakes read from them."""

from __future__ import annotations

import contextlib
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.command.main import main
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import BrakeRelation, read_brakes
from verification.safe_state.brakes.sequence import Brakes, make_cycles
from verification.safe_state.brakes.torque import read_torque
from verification.safe_state.machine import Machine, merge
from verification.safe_state.relation import Relation, read_relation


@dataclass(frozen=True)
class Proved:
    """What the command did: its exit status, the record that it printed, and the folder of its files."""

    status: int
    record: Mapping[str, Any]
    folder: Path


@pytest.fixture(scope="session")
def proved(tmp_path_factory: pytest.TempPathFactory) -> Proved:
    folder = tmp_path_factory.mktemp("proof") / "out"
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        status = main(["prove", "safe-state", "--json", "--out", str(folder), "--jobs", "1"])
    assert printed.getvalue(), "the programs are not built, or a prover is missing"
    return Proved(status, json.loads(printed.getvalue()), folder)


@pytest.fixture(scope="session")
def text(proved: Proved) -> str:
    return (proved.folder / "relation.json").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def relation(text: str) -> Relation:
    return read_relation(text, Path("relation.json"))


@pytest.fixture(scope="session")
def machine(relation: Relation) -> Machine:
    return merge(relation)


@pytest.fixture(scope="session")
def brake_text(proved: Proved) -> str:
    return (proved.folder / "brakes.json").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def brake_relation(brake_text: str) -> BrakeRelation:
    return read_brakes(brake_text, Path("brakes.json"))


@pytest.fixture(scope="session")
def brakes(brake_relation: BrakeRelation) -> Brakes:
    return make_cycles(brake_relation)


@pytest.fixture(scope="session")
def torque_text(proved: Proved) -> str:
    return (proved.folder / "torque.json").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def pair(machine: Machine, brakes: Brakes, torque_text: str) -> Pair:
    return Pair(machine, brakes, read_torque(torque_text, machine.states, Path("torque.json")))
