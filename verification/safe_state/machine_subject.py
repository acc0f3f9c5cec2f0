# SPDX-License-Identifier: Apache-2.0
"""The safe-state machine as a subject of proofs, and its counterexamples as readable steps.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#proofs
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mamori_trace.base.errors import WorkError
from verification.safe_state import promela, smt
from verification.safe_state.graph import list_road
from verification.safe_state.machine import Machine, Past, describe_letter
from verification.safe_state.properties import PROPERTIES, Property
from verification.safe_state.prove import Subject
from verification.safe_state.relation import INPUTS


@dataclass(frozen=True)
class MachineSubject(Subject):
    """The properties of the machine without brakes."""

    machine: Machine
    name = "machine"
    properties = PROPERTIES
    constants = ("s", *smt.PASTS, *INPUTS, *(f"worse_{name}" for name in smt.WORSENED))

    def write_smt(self) -> str:
        return smt.write_model(self.machine)

    def list_history_queries(self) -> list[str]:
        return smt.list_history_queries(self.machine)

    def list_queries(self, wanted: Property) -> list[str]:
        return smt.list_queries(self.machine, wanted)

    def write_promela(self, properties: Sequence[Property]) -> str:
        return promela.write_model(self.machine, properties)

    def describe_values(self, query: smt.Query, values: Mapping[str, int]) -> list[str]:
        place = (values["s"], Past(*(bool(values[name]) for name in smt.PASTS)))
        letters = {tuple(values[name] for name in INPUTS): ""}
        if "t_worse" in query.text:
            letters[tuple(values[f"worse_{name}" if name in smt.WORSENED else name] for name in INPUTS)] = "but also "
        road = [*list_road(self.machine.roads, place), (place, ())]
        lines = [self._describe_step(before, letter, after[0]) for (before, letter), (after, _) in pairwise(road)]
        lines += [start + self._describe_step(place, letter, int(self.machine.next[(place[0], *letter)])) for letter, start in letters.items()]
        return lines

    def describe_run(self, run: promela.Run) -> list[str]:
        machine = self.machine
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
            lines.append(self._describe_step((here, past), move.letter, target))
            past = machine.advance(past, here, target, move.letter) if move.letter else past
            here = target
        return lines

    def _describe_step(self, place: tuple[int, Past], letter: tuple[int, ...], target: int) -> str:
        before, after = self.machine.labels[place[0]], self.machine.labels[target]
        torque = f"torque {'on' if after.get('torque_enable') else 'off'}, brakes {'open' if after.get('brake_release') else 'closed'}"
        return f"{before.name} -> {after.state}: {describe_letter(letter, place[1], before.limit)}; {torque}"
