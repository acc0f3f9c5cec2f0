# SPDX-License-Identifier: Apache-2.0
"""The step relation after merging the situations that no inputs distinguish, and the known past of each situation.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#models
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from verification.safe_state.graph import merge_alike, walk
from verification.safe_state.relation import INPUTS, SHAPE, VALUES, Array, Label, Relation

RUNNING = VALUES["self_test"].index("Running")


@dataclass(frozen=True, order=True)
class Past:
    """What an external observer remembers: both button levels of the last cycle, and whether a self test was running at any time since the
    entry into the current state. The buttons before power-up are unknown and therefore treated as held."""

    start: bool = True
    reset: bool = True
    has_run: bool = False


@dataclass(frozen=True)
class Machine:
    """Like Relation, with the fewest situations. `first`: the situation after power-up. `corrupted`: the situation after a bit flip."""

    states: tuple[str, ...]
    table: Mapping[tuple[str, str], str]
    labels: tuple[Label, ...]
    next: Array
    first: int
    corrupted: int

    @cached_property
    def pasts(self) -> tuple[frozenset[Past], ...]:
        """All pasts that lead to each situation. A bit may flip at any time."""
        return tuple(frozenset(past for number, past in self.roads if number == place) for place in range(len(self.labels)))

    @cached_property
    def roads(self) -> Mapping[tuple[int, Past], tuple[tuple[int, Past], tuple[int, ...]] | None]:
        """For each situation with a past, the previous one on a shortest path from power-up, and the letter between them."""
        return walk([(self.first, Past())], lambda here: self._list_moves(*here))

    def _list_moves(self, number: int, past: Past) -> Iterator[tuple[tuple[int, ...], tuple[int, Past]]]:
        """One letter for each next situation and past."""
        answers = self.next[number]
        for start in (0, 1):
            for reset in (0, 1):
                for running in (True, False):
                    tests = [RUNNING] if running else [i for i in range(SHAPE[1]) if i != RUNNING]
                    part = answers[..., start, reset, :, :][:, tests]
                    for target in np.unique(part):
                        at = [int(index) for index in np.argwhere(part == target)[0]]
                        letter = (at[0], tests[at[1]], *at[2:6], start, reset, *at[6:])
                        yield letter, (int(target), self.advance(past, number, int(target), letter))
        if number != self.corrupted:
            yield (), (self.corrupted, past)

    def advance(self, past: Past, number: int, target: int, letter: tuple[int, ...]) -> Past:
        """@return what an external observer remembers after the step."""
        is_same = self.labels[number].state == self.labels[target].state
        return Past(bool(letter[6]), bool(letter[7]), is_same and (past.has_run or letter[1] == RUNNING))

    def find(self, state: str, past: Past) -> int:
        """The situation of `state` with this past. @raise KeyError if there is none."""
        for number, label in enumerate(self.labels):
            if label.state == state and label.is_consistent and past in self.pasts[number]:
                return number
        raise KeyError(f"{state} with {past}")

    def with_next(self, new: Array) -> Machine:
        return replace(self, next=new)


def merge(relation: Relation) -> Machine:
    """Merges situations with equal labels if each letter leads to merged situations. Checks the result against the relation, letter by
    letter."""
    kinds = list(dict.fromkeys(relation.labels))
    group, members = merge_alike([np.array([kinds.index(label) for label in relation.labels])], relation.next)
    labels = tuple(relation.labels[member] for member in members)
    merged = group[relation.next[members]]
    if not (all(relation.labels[i] == labels[number] for i, number in enumerate(group))
            and np.array_equal(group[relation.next], merged[group])):  # fmt: skip
        raise AssertionError("merged situations differ from those of the relation")
    corrupted = [number for number, label in enumerate(labels) if not label.is_consistent]
    if len(corrupted) != 1:
        raise AssertionError(f"{len(corrupted)} kinds of corrupted situations, the models know one")
    return Machine(relation.states, relation.table, labels, merged, int(group[0]), corrupted[0])


def describe_letter(letter: tuple[int, ...], past: Past, limit: str) -> str:
    """The inputs of a step in words: demands, active levels and button pushes. `limit`: the bound that applies, or "none"."""
    if not letter:
        return "a bit of the stored state flips"
    values = {name: VALUES[name][digit] for name, digit in zip(INPUTS, letter, strict=True)}
    words = [f"demand {values['demand']}", f"self test {values['self_test']}"]
    for name, before in (("start_button", past.start), ("reset_button", past.reset)):
        if values[name] == "yes":
            words.append(f"{name.removesuffix('_button')} {'held' if before else 'pushed'}")
    words += [name.replace("_", " ") if values[name] == "yes" else f"no {name.replace('_', ' ')}"
              for name in ("standstill", "faults_cleared", "start_permitted")]  # fmt: skip
    words += ["brakes failed"] if values["brakes_failed"] == "yes" else []
    words += ["lock out"] if values["lock_out"] == "yes" else []
    words += [f"time {values['time']} ({limit})"] if limit != "none" else []
    return ", ".join(words)
