# SPDX-License-Identifier: Apache-2.0
"""Machine and brake sequence in one cycle, in the order of the contract of the sequence. confirm() gets the state before the step and
returns the standstill that the step uses. apply() gets the state after the step. At the end, the safety cycle may keep torque that the
sequence does not give. All parts are compiled code; the program of the safety cycle shows that it couples them in this way.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from verification.safe_state.brakes.sequence import Answer, Brakes, Call, Memory, advance
from verification.safe_state.brakes.torque import BRAKES_FIRST, OTHER, Hold, Torque
from verification.safe_state.graph import walk
from verification.safe_state.machine import Machine
from verification.safe_state.relation import INPUTS, VALUES

STANDSTILL = INPUTS.index("standstill")
STO = VALUES["demand"].index("Sto")

Letter = tuple[int, ...]


@dataclass(frozen=True, order=True)
class Node:
    """Situations of machine and sequence between two cycles, with what an external observer remembers of the brakes. `is_kept`: the cycle
    kept torque that the sequence did not give."""

    machine: int
    brakes: int
    memory: Memory
    is_kept: bool = False


@dataclass(frozen=True)
class Cycle:
    """`letter`: inputs of the machine, with the confirmed standstill. For a bit flip, it is empty and `call` is None."""

    letter: Letter
    call: Call | None


@dataclass(frozen=True)
class Pair:
    """The machine with its brakes in the safety cycle."""

    machine: Machine
    brakes: Brakes
    torque: Torque

    @cached_property
    def roads(self) -> Mapping[Node, tuple[Node, Cycle] | None]:
        """For each node, the previous one on a shortest path from power-up, and the cycle in between."""
        return walk([Node(self.machine.first, first, Memory()) for first in self.brakes.firsts], self._list_cycles)

    def step(self, node: Node, letter: Letter, standing: bool, contacts: bool, time: int, hold: Hold = (0, 0)) -> tuple[Node, Call, Answer]:
        """@param letter whose standstill is replaced by the confirmed one."""
        before = self.machine.labels[node.machine].state
        is_confirmed = self.confirms(node, standing, contacts, time)
        target = int(self.machine.next[(node.machine, *with_standstill(letter, is_confirmed))])
        call = Call(before, standing, contacts, self.machine.labels[target].state, time, hold)
        answer = self.brakes.take(node.brakes, call)
        had_torque = node.memory.torque or node.is_kept
        is_kept = not answer.torque and self.torque.calc(call.after, answer.torque, answer.closing, had_torque, hold)
        return Node(target, answer.next, advance(node.memory, call, answer), is_kept), call, answer

    def confirms(self, node: Node, standing: bool, contacts: bool, time: int) -> bool:
        before = self.brakes.states.index(self.machine.labels[node.machine].state)
        return bool(self.brakes.confirmed[node.brakes, before, int(standing), int(contacts), time])

    @cached_property
    def _letters(self) -> Mapping[tuple[int, bool], tuple[Letter, ...]]:
        """One letter without and one with a demand of STO for each next situation of the machine, by situation and standstill."""
        letters = {}
        for number, level in product(range(len(self.machine.labels)), (False, True)):
            answers = np.take(self.machine.next[number], [int(level)], axis=STANDSTILL)
            places = []
            for first, part in ((0, answers[:STO]), (STO, answers[STO:])):
                for target in np.unique(part):
                    place = np.argwhere(part == target)[0].tolist()
                    places.append(with_standstill((place[0] + first, *place[1:]), level))
            letters[number, level] = tuple(places)
        return letters

    def _list_cycles(self, node: Node) -> Iterator[tuple[Cycle, Node]]:
        for standing, contacts, time in product((False, True), (False, True), range(4)):
            is_confirmed = self.confirms(node, standing, contacts, time)
            for letter in self._letters[node.machine, is_confirmed]:
                for hold in list_holds(letter):
                    there, call, _ = self.step(node, letter, standing, contacts, time, hold)
                    yield Cycle(letter, call), there
        if node.machine != self.machine.corrupted:
            yield Cycle((), None), Node(self.machine.corrupted, node.brakes, node.memory, node.is_kept)


def list_holds(letter: Letter) -> Sequence[Hold]:
    """For the letter, one that keeps no torque and one that may keep it."""
    return ((0, OTHER), (1, BRAKES_FIRST)) if letter[0] >= STO else ((0, 0),)


def with_standstill(letter: Letter, level: bool) -> Letter:
    return (*letter[:STANDSTILL], int(level), *letter[STANDSTILL + 1 :])
