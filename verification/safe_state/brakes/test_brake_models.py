# SPDX-License-Identifier: Apache-2.0
# Goal: relation, merged cycles, z3's diagrams and spin's branches of the brakes agree, and incomplete data is rejected. Method: random runs
# in all of them in parallel; texts with one fault each; a run that is impossible.
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
from verification.safe_state import smt as machine_smt
from verification.safe_state.brakes import promela, smt
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import TIMES, WITHIN, BrakeRelation, read_brakes
from verification.safe_state.brakes.sequence import Brakes, Call
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.brakes.torque import BRAKES_FIRST, UNKNOWN, read_torque
from verification.safe_state.machine import Machine
from verification.safe_state.promela import Run
from verification.safe_state.test_models import drop

QUERIES = 300


def make_call(chance: random.Random, states: tuple[str, ...]) -> Call:
    before, after = chance.choice(states), chance.choice(states)
    return Call(before, chance.random() < 0.5, chance.random() < 0.5, after, chance.randrange(len(TIMES)))


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
@pytest.mark.parametrize("first", [0, 1], ids=["with contacts", "without contacts"])
def test_merged_cycles_answer_like_the_calls_of_the_relation(brake_relation: BrakeRelation, brakes: Brakes, first: int) -> None:
    chance = random.Random(first)
    here, merged = brake_relation.firsts[first], brakes.firsts[first]
    for _ in range(5000):
        call = make_call(chance, brakes.states)
        before, after = brakes.states.index(call.before), brakes.states.index(call.after)
        confirmed, told, middle = brake_relation.confirm[here, before, int(call.standing), int(call.contacts), call.time].tolist()
        torque, opened, _, _, told_later, here = brake_relation.apply[middle, after, WITHIN if told else call.time].tolist()
        told = bool(told or told_later)
        overdue = bool(brake_relation.overdue[here, WITHIN if told else call.time])

        answer = brakes.take(merged, call)
        merged = answer.next
        assert (answer.confirmed, answer.torque, answer.open, answer.told_now, answer.overdue) == (
            bool(confirmed), bool(torque), bool(opened), told, overdue)  # fmt: skip


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_diagrams_of_z3_answer_like_the_brakes(pair: Pair, tmp_path: Path) -> None:
    chance = random.Random(2)
    states = {name: number for number, name in enumerate(pair.brakes.states, start=1)}
    rows = []
    for number in range(QUERIES):
        here = number % len(pair.brakes.fitted)
        call = make_call(chance, pair.brakes.states)
        answer = pair.brakes.take(here, call)
        given = [f"(= b {here})", f"(= q {states[call.before]})", f"(= r {states[call.after]})", f"(= brake_time {call.time})",
                 machine_smt.write_literal("standing", call.standing), machine_smt.write_literal("contacts", call.contacts)]  # fmt: skip
        seen = [f"(= b_t {answer.next})", *(machine_smt.write_literal(name, level) for name, level in (
            ("confirmed", answer.confirmed), ("torque_out", answer.torque), ("open_out", answer.open), ("told_now", answer.told_now),
            ("overdue_out", answer.overdue)))]  # fmt: skip
        rows.append(f"(and {' '.join(given)} (not (and {' '.join(seen)})))")

    query = machine_smt.Query("", f"(assert (or {' '.join(rows)}))")
    assert machine_smt.ask_all(smt.write_model(pair), [query], tmp_path / "brakes.smt2") == [True]


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_random_runs_of_spin_are_runs_of_machine_and_brakes(pair: Pair, tmp_path: Path) -> None:
    subject = BrakeSubject(pair)
    (tmp_path / "brakes.pml").write_text(subject.write_promela(()), encoding="utf-8")
    for seed in range(1, 6):
        told = subprocess.run(("spin", f"-n{seed}", "-u3000", "brakes.pml"), cwd=tmp_path, capture_output=True, text=True, check=True)
        moves = tuple(int(number) for number in re.findall(r"MOVE (\d+)", told.stdout))

        assert len(moves) > 50
        assert len(subject.describe_run(Run("random", moves))) == len(moves)


@pytest.mark.verifies("SWR-FSM-022", technique="back_to_back")
def test_branches_of_spin_lead_wherever_machine_and_brakes_can_go(pair: Pair) -> None:
    model = promela.Model(pair)
    chance = random.Random(3)
    shape = pair.machine.next.shape[1:]
    ways = {(move.source, move.target) for move in model.moves}
    for view, node in model.views.items():
        for _ in range(100):
            letter = tuple(chance.randrange(size) for size in shape)
            there, _, _ = pair.step(node, letter, chance.random() < 0.5, chance.random() < 0.5, chance.randrange(len(TIMES)))
            assert (view, promela.look_at(there)) in ways


@pytest.mark.verifies("SWR-FSM-022", technique="fault_injection", polarity="violation")
def test_run_that_nobody_takes_is_refused(pair: Pair) -> None:
    subject = BrakeSubject(pair)
    model = subject.model
    last = len(model.moves) - 1
    broken = next(number for number, move in enumerate(model.moves) if move.source != model.moves[last].target)

    with pytest.raises(WorkError, match="without a cycle in between"):
        subject.describe_run(Run("wrong", (last, broken)))


def set_cell(document: dict[str, Any], value: object, *place: str | int) -> None:
    for step in place[:-1]:
        document = document[step]  # type: ignore[index]
    document[place[-1]] = value  # type: ignore[index]


FAULTS = {
    "has no 'first'": lambda document: drop(document, "first"),
    "has 175 answers for 176 calls": lambda document: drop(document, "situations", 5, "confirm", 17),
    "has 43 answers for 44 calls": lambda document: drop(document, "situations", 5, "apply", 17),
    "has 5 cells, wanted 6": lambda document: drop(document, "situations", 5, "apply", 17, 0),
    "has 3 answers for 4 times": lambda document: drop(document, "situations", 5, "overdue", 0),
    "the properties speak about": lambda document: drop(document, "times", 2),
    "is 134, beyond the 134 rows it points into": lambda document: set_cell(document, 134, "situations", 5, "apply", 0, 5),
    "is 2, beyond the 2 rows": lambda document: set_cell(document, 2, "situations", 5, "confirm", 0, 0),
    "is 'mamori.brake_sequence/0'": lambda document: set_cell(document, "mamori.brake_sequence/0", "schema"),
}


@pytest.mark.verifies("SWR-FSM-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("complaint", FAULTS)
def test_incomplete_relation_of_the_brakes_is_refused_in_one_line(brake_text: str, complaint: str) -> None:
    document = json.loads(brake_text)
    FAULTS[complaint](document)

    with pytest.raises(InputError) as error:
        read_brakes(json.dumps(document), Path("brakes.json"))

    assert complaint in str(error.value)
    assert "print it again with mamori_brake_sequence_relation" in str(error.value)


@pytest.mark.verifies("SWR-FSM-022", technique="error_guessing", polarity="violation")
def test_brakes_whose_kinds_mix_and_text_that_is_none_are_refused(brake_text: str) -> None:
    document = json.loads(brake_text)
    set_cell(document, document["first"]["without_contacts"], "situations", 0, "apply", 0, 5)

    with pytest.raises(InputError, match="brakes with contacts turn into brakes without"):
        read_brakes(json.dumps(document), Path("brakes.json"))
    with pytest.raises(InputError, match="not valid JSON"):
        read_brakes("", Path("brakes.json"))


CELLS = {
    "has 6 cells, wanted 7": lambda document: drop(document, "rows", 5, 0),
    "the properties speak about": lambda document: drop(document, "letter", 2),
    "is 'Sofa'": lambda document: set_cell(document, "Sofa", "rows", 5, 0),
    "is 3, beyond the 3 rows": lambda document: set_cell(document, 3, "rows", 5, 5),
    "is 2, beyond the 2 rows": lambda document: set_cell(document, 2, "rows", 5, 6),
}


@pytest.mark.verifies("SWR-FSM-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("complaint", CELLS)
def test_incomplete_relation_of_the_cycle_is_refused_in_one_line(torque_text: str, machine: Machine, complaint: str) -> None:
    document = json.loads(torque_text)
    CELLS[complaint](document)

    with pytest.raises(InputError) as error:
        read_torque(json.dumps(document), machine.states, Path("torque.json"))

    assert complaint in str(error.value)
    assert "print it again with mamori_safety_cycle_relation" in str(error.value)


@pytest.mark.verifies("SWR-PRF-052", technique="back_to_back")
def test_executed_cycles_have_the_torque_of_the_sequence_except_while_brakes_close(pair: Pair) -> None:
    torque = pair.torque
    for place, value in np.ndenumerate(torque.after):
        state, (own, *others) = torque.states[place[0]], place[1:]
        if value != UNKNOWN:
            assert value == (own or (state == "Safe" and others == [1, 1, 1, BRAKES_FIRST])), (state, *place[1:])
    assert np.count_nonzero(torque.after[torque.states.index("Safe"), 0] == UNKNOWN) == 0


@pytest.mark.verifies("SWR-FSM-032")
def test_relation_of_the_brakes_knows_both_kinds_of_brakes(brake_relation: BrakeRelation, brakes: Brakes) -> None:
    assert np.count_nonzero(brake_relation.fitted) * 2 == len(brake_relation.fitted)
    assert [brakes.fitted[first] for first in brakes.firsts] == [True, False]
    assert brakes.states[-1] == "Invalid"
