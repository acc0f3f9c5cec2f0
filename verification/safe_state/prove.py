# SPDX-License-Identifier: Apache-2.0
"""Proves the properties with z3 and spin, and tells a counterexample as steps that a person can follow.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#proofs
"""

from __future__ import annotations

import builtins
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import WorkError
from verification.safe_state import promela, smt
from verification.safe_state.machine import Machine, Past, describe_letter
from verification.safe_state.properties import PROPERTIES, Property

SCHEMA = "mamori.safe_state_proof/1"
PROVED, REFUTED = "proved", "refuted"


@dataclass(frozen=True)
class Result:
    """One property. `verdicts`: by prover. `steps`: how it is broken, in words; empty where all provers have proved it."""

    property: Property
    verdicts: Mapping[str, str]
    steps: tuple[str, ...]

    @builtins.property
    def is_proved(self) -> bool:
        return all(verdict == PROVED for verdict in self.verdicts.values())


def prove(machine: Machine, folder: Path, properties: Sequence[Property] = PROPERTIES) -> list[Result]:
    """Runs both provers; their models and working files stay in `folder`. @raise WorkError when a prover is missing or fails."""
    steps: dict[str, dict[str, list[str]]] = {one.name: {} for one in properties}
    _run_z3(machine, properties, folder, steps)
    _run_spin(machine, properties, folder, steps)
    results = []
    for one in properties:
        told = steps[one.name]
        verdicts = {prover: REFUTED if prover in told else PROVED for prover in one.provers}
        # A run from power-up tells more than a single step that z3 could choose freely.
        words = told.get("spin") or told.get("z3") or []
        results.append(Result(one, verdicts, tuple(words)))
    return results


def _run_z3(machine: Machine, properties: Sequence[Property], folder: Path, steps: dict[str, dict[str, list[str]]]) -> None:
    queries = smt.list_history_queries(machine)
    for one in properties:
        queries += smt.list_queries(machine, one)
    for query, refutation in zip(queries, smt.check(machine, queries, folder), strict=True):
        if refutation is None:
            continue
        if not query.owner:
            raise WorkError("z3 does not find the past of the machine closed under its steps; the model is not that of the machine")
        steps[query.owner].setdefault("z3", describe_refutation(machine, refutation))


def _run_spin(machine: Machine, properties: Sequence[Property], folder: Path, steps: dict[str, dict[str, list[str]]]) -> None:
    runs = promela.check(machine, properties, folder)
    for one in properties:
        word = one.name.replace("-", "_")
        if one.always and (run := runs[word]).moves is not None:
            steps[one.name]["spin"] = describe_run(machine, run)
        missed = [condition for number, condition in enumerate(one.possible) if runs[f"{word}_{number}"].moves is None]
        if missed:
            steps[one.name]["spin"] = [f"no run from power-up has: {condition}" for condition in missed]


def describe_step(machine: Machine, source: int, past: Past, letter: tuple[int, ...], target: int) -> str:
    """One step in words."""
    before, after = machine.labels[source], machine.labels[target]
    torque = f"torque {'on' if after.get('torque_enable') else 'off'}, brakes {'open' if after.get('brake_release') else 'closed'}"
    name = before.state if before.is_consistent else f"{before.state} (corrupted)"
    words = describe_letter(letter, past, before.limit)
    return f"{name} -> {after.state}: {words}; {torque}"


def describe_refutation(machine: Machine, found: smt.Refutation) -> list[str]:
    """A shortest way from power-up to the situation, and the step that breaks the property."""
    place = (found.situation, found.past)
    lines: list[str] = []
    road = machine.roads.get(place)
    here = place
    while road is not None:
        before, letter = road
        lines.insert(0, describe_step(machine, before[0], before[1], letter, here[0]))
        here, road = before, machine.roads.get(before)
    lines.append(describe_step(machine, *place, found.letter, int(machine.next[(found.situation, *found.letter)])))
    if found.worse != found.letter:
        target = int(machine.next[(found.situation, *found.worse)])
        lines.append("but also " + describe_step(machine, *place, found.worse, target))
    return lines


def describe_run(machine: Machine, run: promela.Run) -> list[str]:
    """The run in words. @raise WorkError when the machine does not step as the run says: the model would not be its model."""
    lines = []
    moves = promela.list_moves(machine)
    here, past = machine.first, Past()
    for place, number in enumerate(run.moves or ()):
        move = moves[number]
        target = int(machine.next[(here, *move.letter)]) if move.letter else machine.corrupted
        if (move.source, move.target) != (here, target):
            raise WorkError(f"spin steps from {move.source} to {move.target}, the machine from {here} to {target}")
        if place == run.loop:
            lines.append("from here on again and again:")
        lines.append(describe_step(machine, here, past, move.letter, target))
        past = machine.advance(past, here, target, move.letter) if move.letter else past
        here = target
    return lines


def make_record(results: Sequence[Result], facts: Mapping[str, Any]) -> dict[str, Any]:
    """What `--json` prints and the evidence keeps."""
    rows = [
        {"name": result.property.name, "requirement": result.property.requirement, "sentence": result.property.sentence,
         "provers": dict(result.verdicts), "proved": result.is_proved, "steps": list(result.steps)}
        for result in results
    ]  # fmt: skip
    return {"schema": SCHEMA, **facts, "properties": rows}
