# SPDX-License-Identifier: Apache-2.0
# Goal: relation, merged machine, z3's diagram and spin's branches agree, and incomplete data is rejected. Method: random runs in all of
# them in parallel; texts with one fault each; provers that return invalid output.
from __future__ import annotations

import json
import random
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mamori_trace.base.errors import InputError, WorkError
from verification.safe_state import promela, smt
from verification.safe_state.machine import Machine
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.prove import prove
from verification.safe_state.relation import INPUTS, SHAPE, VALUES, Relation, read_relation, run_program

LETTERS = 500


def make_letter(chance: random.Random) -> tuple[int, ...]:
    return tuple(chance.randrange(size) for size in SHAPE)


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_merged_machine_looks_like_the_relation_in_random_runs(relation: Relation, machine: Machine) -> None:
    chance = random.Random(1)
    for start in range(len(relation.labels)):
        here, merged = 0, machine.first
        for _ in range(start + 20):
            letter = make_letter(chance)
            here, merged = int(relation.next[(here, *letter)]), int(machine.next[(merged, *letter)])
            assert relation.labels[here] == machine.labels[merged]


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_situations_of_the_relation_are_all_that_lead_from_power_up(relation: Relation, machine: Machine) -> None:
    reached = {0}
    while len(grown := reached | set(np.unique(relation.next[sorted(reached)]).tolist())) > len(reached):
        reached = grown

    assert reached == {number for number, label in enumerate(relation.labels) if label.is_consistent}
    assert {machine.labels[number].state for number in range(len(machine.labels))} == set(relation.states)


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_diagram_of_z3_answers_like_the_machine(machine: Machine, tmp_path: Path) -> None:
    chance = random.Random(2)
    rows = []
    for number in range(LETTERS):
        here, letter = number % len(machine.labels), make_letter(chance)
        values = [f"(= s {here})"]
        for name, digit in zip(INPUTS, letter, strict=True):
            values.append(f"(= {name} {digit})" if smt.SORTS[name] == "Int" else smt.write_literal(name, bool(digit)))
        rows.append(f"(and {' '.join(values)} (not (= t {machine.next[(here, *letter)]})))")

    query = smt.Query("", f"(assert (or {' '.join(rows)}))")
    assert smt.ask_all(smt.write_model(machine), [query], tmp_path / "machine.smt2") == [True]


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_branches_of_spin_are_the_steps_of_the_machine(machine: Machine) -> None:
    moves = promela.list_moves(machine)
    for source in range(len(machine.labels)):
        targets = {move.target for move in moves if move.source == source and move.letter}
        assert targets == set(np.unique(machine.next[source]).tolist())
    for move in moves:
        if move.letter:
            assert machine.next[(move.source, *move.letter)] == move.target
            values = {name: VALUES[name][digit] for name, digit in zip(INPUTS, move.letter, strict=True)}
            seen = (values["standstill"] == "yes", values["reset_button"] == "yes", values["demand"] == "Ss1")
            assert seen == (bool(move.sees & 1), bool(move.sees & 2), bool(move.sees & 4))


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_random_runs_of_spin_are_runs_of_the_machine(machine: Machine, tmp_path: Path) -> None:
    (tmp_path / "machine.pml").write_text(promela.write_model(machine, ()), encoding="utf-8")
    for seed in range(1, 6):
        told = subprocess.run(("spin", f"-n{seed}", "-u3000", "machine.pml"), cwd=tmp_path, capture_output=True, text=True, check=True)
        moves = tuple(int(number) for number in re.findall(r"MOVE (\d+)", told.stdout))

        assert len(moves) > 50
        assert len(MachineSubject(machine).describe_run(promela.Run("random", moves))) == len(moves)


@pytest.mark.verifies("SWR-FSM-022", technique="fault_injection", polarity="violation")
def test_run_that_the_machine_does_not_take_is_refused(machine: Machine) -> None:
    with pytest.raises(WorkError, match="spin steps from"):
        MachineSubject(machine).describe_run(promela.Run("wrong", (len(promela.list_moves(machine)) - 1,)))


def drop(document: dict[str, Any], *place: str | int) -> None:
    for step in place[:-1]:
        document = document[step]  # type: ignore[index]
    del document[place[-1]]  # type: ignore[arg-type]


FAULTS = {
    "has no 'table'": lambda document: drop(document, "table"),
    "has 9 rows for 10 states": lambda document: drop(document, "table", 3),
    "has 12 cells for 13 events": lambda document: drop(document, "table", 3, 1),
    "has 12287 answers for 12288 combinations": lambda document: drop(document, "situations", 5, "next", 17),
    "has no 'brake_release'": lambda document: drop(document, "situations", 5, "outputs", "brake_release"),
    "the properties speak about": lambda document: drop(document, "inputs", 2),
    "beyond the 81 rows it points into": lambda document: drop(document, "situations", 81),
    "is 'Sofa'": lambda document: document["table"][0].__setitem__(0, "Sofa"),
    "is 'mamori.safe_state/0'": lambda document: document.__setitem__("schema", "mamori.safe_state/0"),
}


@pytest.mark.verifies("SWR-FSM-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("complaint", FAULTS)
def test_incomplete_relation_is_refused_in_one_line(text: str, complaint: str) -> None:
    document = json.loads(text)
    if complaint.startswith("beyond"):
        document["situations"][0]["next"][0] = 81  # of 82, before the last one is dropped
    FAULTS[complaint](document)

    with pytest.raises(InputError) as error:
        read_relation(json.dumps(document), Path("relation.json"))

    assert complaint in str(error.value)
    assert "print it again with mamori_safe_state_relation" in str(error.value)


@pytest.mark.verifies("SWR-FSM-022", technique="error_guessing", polarity="violation")
def test_program_that_is_missing_fails_or_prints_no_relation_is_refused(tmp_path: Path) -> None:
    failing = tmp_path / "failing"
    failing.write_text("#!/bin/sh\necho 'situation 3: no' >&2\nexit 1\n", encoding="utf-8")
    failing.chmod(0o755)

    with pytest.raises(InputError, match=r"run ./mamori build"):
        run_program(tmp_path / "missing")
    with pytest.raises(InputError, match="ended with status 1: situation 3: no"):
        run_program(failing)
    with pytest.raises(InputError, match="not valid JSON"):
        read_relation("", Path("relation.json"))


@pytest.mark.verifies("SWR-FSM-025", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("tool", "words", "complaint"),
    [("z3", "echo maybe", "z3 gave no answer"), ("z3", "exit 1", "z3 refuses"), ("z3", "echo sat", "z3 gave no answer"),
     ("spin", "echo 'syntax error' >&2; exit 1", "spin -a machine.pml ended with status 1: syntax error"),
     # Spin calls gcc as its preprocessor as well.
     ("gcc", "case \"$*\" in *pan.c) printf '#!/bin/sh\\necho nothing\\n' >pan; chmod +x pan;; *) exec cc \"$@\";; esac",
      "spin did not search everything")],
)  # fmt: skip
def test_prover_that_answers_nonsense_proves_nothing(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tool: str,
                                                     words: str, complaint: str) -> None:  # fmt: skip
    fakes = tmp_path / "bin"
    fakes.mkdir()
    (fakes / tool).write_text(f"#!/bin/sh\n{words}\n", encoding="utf-8")
    (fakes / tool).chmod(0o755)
    monkeypatch.setenv("PATH", str(fakes), prepend=":")

    with pytest.raises(WorkError, match=complaint):
        prove(MachineSubject(machine), tmp_path)
