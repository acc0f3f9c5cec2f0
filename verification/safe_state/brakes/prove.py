# SPDX-License-Identifier: Apache-2.0
"""Proves the properties of the brakes with z3 and spin, and tells a counterexample as cycles that a person can follow.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

from mamori_trace.base.errors import WorkError
from verification.safe_state.brakes import promela, smt
from verification.safe_state.brakes.coupling import Letter, Node, Pair
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES, BrakeProperty
from verification.safe_state.brakes.relation import TIMES
from verification.safe_state.brakes.sequence import Answer, Call
from verification.safe_state.machine import Past, describe_letter
from verification.safe_state.promela import Run
from verification.safe_state.prove import PROVED, REFUTED, Result

Place = TypeVar("Place")
Link = TypeVar("Link")


def prove_brakes(pair: Pair, folder: Path, properties: Sequence[BrakeProperty] = BRAKE_PROPERTIES) -> list[Result]:
    """Runs both provers; their models and working files stay in `folder`. @raise WorkError when a prover is missing or fails."""
    told: dict[str, dict[str, list[str]]] = {one.name: {} for one in properties}
    _run_z3(pair, properties, folder, told)
    _run_spin(pair, properties, folder, told)
    results = []
    for one in properties:
        verdicts = {prover: REFUTED if prover in told[one.name] else PROVED for prover in one.provers}
        words = told[one.name].get("spin") or told[one.name].get("z3") or []
        results.append(Result(one, verdicts, tuple(words)))
    return results


def _run_z3(pair: Pair, properties: Sequence[BrakeProperty], folder: Path, told: dict[str, dict[str, list[str]]]) -> None:
    queries = smt.list_history_queries(pair)
    for one in properties:
        queries += smt.list_queries(one)
    is_coupled = {one.name: one.is_coupled for one in properties}
    for query, found in zip(queries, smt.check(pair, queries, folder), strict=True):
        if found is None:
            continue
        if not query.owner:
            raise WorkError("z3 does not find the past of the brakes closed under their cycles; the model is not that of the brakes")
        describe = describe_coupled if is_coupled[query.owner] else describe_alone
        told[query.owner].setdefault("z3", describe(pair, found))


def _run_spin(pair: Pair, properties: Sequence[BrakeProperty], folder: Path, told: dict[str, dict[str, list[str]]]) -> None:
    model, runs = promela.check(pair, properties, folder)
    for one in properties:
        word = one.name.replace("-", "_")
        if one.always and (run := runs[word]).moves is not None:
            told[one.name]["spin"] = describe_run(model, run)
        missed = [condition for number, condition in enumerate(one.possible) if runs[f"{word}_{number}"].moves is None]
        if missed:
            told[one.name]["spin"] = [f"no run from power-up has: {condition}" for condition in missed]


def describe_answer(call: Call, answer: Answer, is_fitted: bool) -> str:
    """One cycle of the brakes in words. `is_fitted`: they have contacts."""
    contacts = f"contacts {'closed' if call.contacts else 'silent'}" if is_fitted else "no contacts"
    confirmed = f"standstill {'confirmed' if answer.confirmed else 'not confirmed'}"
    words = ["stands" if call.standing else "moves", contacts, f"closing time {TIMES[call.time]}", confirmed]
    outputs = f"torque {'on' if answer.torque else 'off'}, brakes {'open' if answer.open else 'closed'}"
    return ", ".join(words) + f"; {outputs}" + (", overdue" if answer.overdue else "")


def describe_alone(pair: Pair, found: smt.BrakeRefutation) -> list[str]:
    """A shortest way of calls from power-up to the situation, and the cycle that breaks the property."""
    road = _list_road(pair.brakes.roads, (found.node.brakes, found.node.memory))
    cycles = [(here[0], call) for here, call in road] + [(found.node.brakes, found.call)]
    return [f"{call.before} -> {call.after}: {describe_answer(call, pair.brakes.take(number, call), pair.brakes.fitted[number])}"
            for number, call in cycles]  # fmt: skip


def describe_coupled(pair: Pair, found: smt.BrakeRefutation) -> list[str]:
    """The same under the machine, with its inputs."""
    cycles = [(here, cycle.letter, cycle.call) for here, cycle in _list_road(pair.roads, found.node)]
    return _describe_cycles(pair, [*cycles, (found.node, found.letter, found.call)])


def describe_run(model: promela.Model, run: Run) -> list[str]:
    """The run of spin in words. @raise WorkError when machine and brakes do not step as the run says."""
    moves = [model.moves[number] for number in run.moves or ()]
    for move, following in pairwise(moves):
        if following.source != move.target:
            raise WorkError(f"spin steps from {move.target} to {following.source} without a cycle in between")
    lines = _describe_cycles(model.pair, [(model.views[move.source], move.letter, move.call) for move in moves])
    if run.loop is not None:
        lines.insert(run.loop, "from here on again and again:")
    return lines


def _list_road(roads: Mapping[Place, tuple[Place, Link] | None], place: Place) -> list[tuple[Place, Link]]:
    """Each place on the way to `place` with the link that leads on from it."""
    road: list[tuple[Place, Link]] = []
    while (before := roads.get(place)) is not None:
        road.insert(0, before)
        place = before[0]
    return road


def _describe_cycles(pair: Pair, cycles: Sequence[tuple[Node, Letter, Call | None]]) -> list[str]:
    """@raise WorkError when a cycle does not lead where it says."""
    machine = pair.machine
    past = Past()
    lines = []
    for node, letter, call in cycles:
        before = machine.labels[node.machine]
        name = before.state if before.is_consistent else f"{before.state} (corrupted)"
        words = describe_letter(letter, past, before.limit)
        if call is None:
            lines.append(f"{name} -> {machine.labels[machine.corrupted].state}: {words}")
            continue
        there, made, answer = pair.step(node, letter, call.standing, call.contacts, call.time)
        if made != call:
            raise WorkError(f"spin and z3 step from {call.before} to {call.after}, the machine from {made.before} to {made.after}")
        past = machine.advance(past, node.machine, there.machine, letter)
        lines.append(f"{name} -> {made.after}: {words}; {describe_answer(call, answer, pair.brakes.fitted[node.brakes])}")
    return lines
