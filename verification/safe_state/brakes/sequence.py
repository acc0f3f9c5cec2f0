# SPDX-License-Identifier: Apache-2.0
"""The brake sequence as one cycle: confirm(), the step of any machine, apply(). Situations that no calls distinguish are merged. Each
situation keeps what an external observer knows of the past.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from verification.safe_state.brakes.relation import WITHIN, BrakeRelation
from verification.safe_state.graph import merge_alike, walk
from verification.safe_state.relation import Array

SS1 = "ProtectiveStopSs1"
HOLD = "StandstillHold"
LOCKED_OUT = "LockedOut"


@dataclass(frozen=True, order=True)
class Memory:
    """What an external observer remembers of the previous cycles: the last state given to apply(), its results for torque and closed
    brakes, and whether standstill was measured since the entry into the current SS1. Before the first cycle no command was given."""

    last: str = "SelfTest"
    torque: bool = False
    closed: bool = False
    stood: bool = False


@dataclass(frozen=True)
class Call:
    """Inputs of the two calls of a cycle. `before`: the state given to confirm(), `after`: the state given to apply(). `hold`: for the cycle
    around the calls (torque.py); the sequence does not see it."""

    before: str
    standing: bool
    contacts: bool
    after: str
    time: int
    hold: tuple[int, int] = (0, 0)


@dataclass(frozen=True)
class Answer:
    """Results of a cycle. `told_now`: the time of the command to close starts in this cycle. `closing`: the brakes may not hold yet."""

    confirmed: bool
    torque: bool
    open: bool
    told_now: bool
    overdue: bool
    closing: bool
    next: int


@dataclass(frozen=True)
class Brakes:
    """`confirmed` has the shape (situations, states, 2, 2, 4): state before, standing, contacts, time. The arrays of `cycle`, named as in
    Answer, have the shape (situations, states, 2, 2, states, 4); the state after precedes the time."""

    states: tuple[str, ...]
    fitted: tuple[bool, ...]
    firsts: tuple[int, ...]
    confirmed: Array
    cycle: Mapping[str, Array]

    def take(self, number: int, call: Call) -> Answer:
        before, after = self.states.index(call.before), self.states.index(call.after)
        middle = (number, before, int(call.standing), int(call.contacts))
        values = {name: int(array[(*middle, after, call.time)]) for name, array in self.cycle.items()}
        return Answer(bool(self.confirmed[(*middle, call.time)]), bool(values["torque"]), bool(values["open"]),
                      bool(values["told_now"]), bool(values["overdue"]), bool(values["closing"]), values["next"])  # fmt: skip

    @cached_property
    def roads(self) -> Mapping[tuple[int, Memory], tuple[tuple[int, Memory], Call] | None]:
        """For each situation with a past, the previous one on a shortest path from power-up, and the calls in between."""
        return walk([(first, Memory()) for first in self.firsts], lambda here: self._list_moves(*here))

    def _list_moves(self, number: int, memory: Memory) -> Iterator[tuple[Call, tuple[int, Memory]]]:
        for call in self.list_calls(memory):
            answer = self.take(number, call)
            yield call, (answer.next, advance(memory, call, answer))

    def list_calls(self, memory: Memory) -> Iterator[Call]:
        """All calls that the contract permits: confirm() gets the state that apply() got last. Or both get LockedOut, because the machine
        is corrupted."""
        ways = [(memory.last, after) for after in self.states] + [(LOCKED_OUT, LOCKED_OUT)]
        for (before, after), standing, contacts, time in product(ways, (False, True), (False, True), range(4)):
            yield Call(before, standing, contacts, after, time)


def advance(memory: Memory, call: Call, answer: Answer) -> Memory:
    """@return what an external observer remembers after the cycle."""
    return Memory(call.after, answer.torque, not answer.open, call.after == SS1 and has_stood(memory, call))


def has_stood(memory: Memory, call: Call) -> bool:
    return call.before == SS1 and (call.standing or memory.stood)


def make_cycles(relation: BrakeRelation) -> Brakes:
    """Joins the calls of a cycle, and merges the situations between cycles that give equal results in all cycles."""
    confirm, apply = relation.confirm, relation.apply
    middle, told_first = confirm[..., 2], confirm[..., 1]
    # At the moment of a command, the time since that command is zero, regardless of earlier calls.
    time = np.where(told_first == 1, WITHIN, np.arange(4))
    states = np.arange(len(relation.states))
    answers = np.moveaxis(apply[middle[..., None], states, time[..., None]], -2, -3)  # time is the last axis again
    told = answers[..., 4] | told_first[..., None, :]
    final = np.where(told == 1, WITHIN, np.arange(4))
    cycle = {"torque": answers[..., 0], "open": answers[..., 1], "told_now": told, "overdue": relation.overdue[answers[..., 5], final],
             "closing": relation.closing[answers[..., 5], final], "next": answers[..., 5]}  # fmt: skip
    return _merge(Brakes(relation.states, relation.fitted, relation.firsts, confirm[..., 0], cycle))


def _merge(brakes: Brakes) -> Brakes:
    following = brakes.cycle["next"]
    answers = [array for name, array in brakes.cycle.items() if name != "next"]
    group, members = merge_alike([np.array(brakes.fitted, dtype=np.int64), brakes.confirmed, *answers], following)
    cycle = {name: array[members] for name, array in brakes.cycle.items()} | {"next": group[following[members]]}
    for name, array in brakes.cycle.items():
        if not np.array_equal(group[array] if name == "next" else array, cycle[name][group]):
            raise AssertionError("merged situations of the brakes differ from those of the relation")
    return Brakes(brakes.states, tuple(brakes.fitted[member] for member in members), tuple(int(group[first]) for first in brakes.firsts),
                  brakes.confirmed[members], cycle)  # fmt: skip
