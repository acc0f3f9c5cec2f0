# SPDX-License-Identifier: Apache-2.0
"""The brake sequence as a subject of proofs, alone and under the machine, and its counterexamples as readable cycles.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from mamori_trace.base.errors import WorkError
from verification.safe_state.brakes import promela, smt
from verification.safe_state.brakes.coupling import Letter, Node, Pair
from verification.safe_state.brakes.properties import BRAKE_PROPERTIES
from verification.safe_state.brakes.relation import TIMES
from verification.safe_state.brakes.sequence import Answer, Call, Memory
from verification.safe_state.brakes.torque import CAUSES
from verification.safe_state.graph import list_road
from verification.safe_state.machine import Past, describe_letter
from verification.safe_state.promela import Run
from verification.safe_state.properties import Property
from verification.safe_state.prove import Subject
from verification.safe_state.relation import INPUTS
from verification.safe_state.smt import Query


@dataclass(frozen=True)
class BrakeSubject(Subject):
    """The properties of the brakes; some of them are about machine and brakes together."""

    pair: Pair
    name = "brakes"
    properties = BRAKE_PROPERTIES
    constants = ("s", "b", "last", *smt.MEMORY, "kept", *smt.CALL, *INPUTS)

    @cached_property
    def model(self) -> promela.Model:
        return promela.Model(self.pair)

    def write_smt(self) -> str:
        return smt.write_model(self.pair)

    def list_history_queries(self) -> list[str]:
        return smt.list_history_queries(self.pair)

    def list_queries(self, wanted: Property) -> list[str]:
        return smt.list_queries(wanted)

    def write_promela(self, properties: Sequence[Property]) -> str:
        return self.model.write(properties)

    def describe_values(self, query: Query, values: Mapping[str, int]) -> list[str]:
        states = dict(enumerate(self.pair.brakes.states, start=1))
        memory = Memory(states[values["last"]], *(bool(values[name]) for name in smt.MEMORY))
        # Values that the query does not constrain may be any number.
        call = Call(states[values["q"]], bool(values["standing"]), bool(values["contacts"]), states[values["r"]], values["brake_time"],
                    (values["can_hold"], values["cause"]))  # fmt: skip
        node = Node(values["s"], values["b"], memory, bool(values["kept"]))
        if next(one for one in BRAKE_PROPERTIES if one.name == query.owner).is_coupled:
            road = [(here, cycle.letter, cycle.call) for here, cycle in list_road(self.pair.roads, node)]
            return self._describe_cycles([*road, (node, tuple(values[name] for name in INPUTS), call)])
        brakes = self.pair.brakes
        cycles = [*((here[0], made) for here, made in list_road(brakes.roads, (node.brakes, memory))), (node.brakes, call)]
        return [f"{made.before} -> {made.after}: {describe_answer(made, brakes.take(number, made), brakes.fitted[number])}"
                for number, made in cycles]  # fmt: skip

    def describe_run(self, run: Run) -> list[str]:
        moves = [self.model.moves[number] for number in run.moves or ()]
        for move, following in pairwise(moves):
            if following.source != move.target:
                raise WorkError(f"spin steps from {move.target} to {following.source} without a cycle in between")
        lines = self._describe_cycles([(self.model.views[move.source], move.letter, move.call) for move in moves])
        if run.loop is not None:
            lines.insert(run.loop, "from here on again and again:")
        return lines

    def _describe_cycles(self, cycles: Sequence[tuple[Node, Letter, Call | None]]) -> list[str]:
        """@raise WorkError if a cycle does not lead to the state that it names."""
        machine = self.pair.machine
        past = Past()
        lines = []
        for node, letter, call in cycles:
            before = machine.labels[node.machine]
            words = describe_letter(letter, past, before.limit)
            if call is None:
                lines.append(f"{before.name} -> {machine.labels[machine.corrupted].state}: {words}")
                continue
            there, made, answer = self.pair.step(node, letter, call.standing, call.contacts, call.time, call.hold)
            if made != call:
                raise WorkError(f"spin and z3 step from {call.before} to {call.after}, the machine from {made.before} to {made.after}")
            past = machine.advance(past, node.machine, there.machine, letter)
            lines.append(f"{before.name} -> {made.after}: {words}; {describe_answer(call, answer, self.pair.brakes.fitted[node.brakes])}"
                         + describe_torque(made, answer, there))  # fmt: skip
        return lines


def describe_torque(call: Call, answer: Answer, there: Node) -> str:
    """What the safety cycle does with torque that the brake sequence does not give, if STO is demanded."""
    can_hold, cause = call.hold
    if answer.torque or not cause:
        return ""
    return f"; STO by {CAUSES[cause]}, {'can hold' if can_hold else 'cannot hold'}, torque {'kept' if there.is_kept else 'not kept'}"


def describe_answer(call: Call, answer: Answer, is_fitted: bool) -> str:
    """One cycle of the brakes in words. `is_fitted`: the brakes have contacts."""
    contacts = f"contacts {'closed' if call.contacts else 'silent'}" if is_fitted else "no contacts"
    confirmed = f"standstill {'confirmed' if answer.confirmed else 'not confirmed'}"
    words = ["stands" if call.standing else "moves", contacts, f"closing time {TIMES[call.time]}", confirmed]
    outputs = f"torque {'on' if answer.torque else 'off'}, brakes {'open' if answer.open else 'closed'}"
    return ", ".join(words) + f"; {outputs}" + (", overdue" if answer.overdue else "")
