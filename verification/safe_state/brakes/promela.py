# SPDX-License-Identifier: Apache-2.0
"""The machine with its brakes as a Promela model for spin, with one branch for each cycle that the formulas distinguish.

@satisfies SWR-FSM-022, SWR-FSM-023      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from verification.safe_state import promela
from verification.safe_state.brakes.coupling import STO, Letter, Node, Pair, list_holds
from verification.safe_state.brakes.sequence import SS1, Call, Memory
from verification.safe_state.promela import WITHIN
from verification.safe_state.properties import Property
from verification.safe_state.relation import VALUES

CLOSES_WITHIN = 2
"""In cycles; shorter than the bound of an SS1, as applications must configure it."""
START, BY_BRAKES, KEEPS_AGE, KEEPS_COMMAND, FLIPS = 1, 2, 4, 8, 16

HEAD = """\
/* Generated from the compiled safe-state machine and brake sequence; see docs/design/safe_state.md#brakes-in-the-models. */
{states}
#define SS2_WITHIN {ss2_within}
#define SS1_WITHIN {ss1_within}
#define CLOSES_WITHIN {closes_within}

byte to = 0;                /* situation after the cycle */
hidden byte sees = 0;       /* 1 start pushed or held, 2 an SS1 ended by its brakes, 4 and 8 which time goes on: age, closing;
                               16 a bit flipped between two cycles: no time passed */
byte age = 0;               /* cycles since the state was entered, while a bound counts */
byte closing = 0;           /* cycles since the command to close */

/* What an external observer sees between two cycles. */
byte situation = 0;
byte state = SelfTest;      /* that apply() was given */
bool torque = 0;            /* that the sequence gives */
bool kept = 0;              /* torque that the safety cycle keeps */
bool open = 0;
bool fitted = 0;
bool start = 1;
bool by_brakes = 0;
byte handover_cycles = 0;   /* with torque in standby */
byte kept_cycles = 0;

inline look_up(n) {{
  if
{views}
  fi
}}

inline settle() {{
  d_step {{
    look_up(to);
    start = (sees & 1) != 0;
    by_brakes = by_brakes || (sees & 2) != 0;
    age = ((sees & 4) != 0 -> age + (age <= SS2_WITHIN + SS1_WITHIN) : 0);
    if
    :: (sees & 16) != 0 -> skip
    :: else ->
      closing = ((sees & 8) != 0 -> closing + (closing <= CLOSES_WITHIN) : 0);
      handover_cycles = (state == Standby && torque -> handover_cycles + (handover_cycles <= CLOSES_WITHIN) : 0);
      kept_cycles = (kept -> kept_cycles + (kept_cycles <= CLOSES_WITHIN) : 0)
    fi;
    situation = to;
    to = 0
  }}
}}

active proctype machine() {{
  if  /* brakes with contacts, or without */
{firsts}
  fi;
  do
  :: atomic {{
    if
{moves}
    fi;
    settle()
  }}
  od
}}

{formulas}
"""


@dataclass(frozen=True, order=True)
class View:
    """What spin distinguishes between two cycles."""

    machine: int
    brakes: int
    state: str
    torque: bool
    open: bool
    kept: bool


@dataclass(frozen=True)
class Move:
    """A branch of the model: represents all cycles from `source` to `target` that look the same. `call`: None for a bit flip. `guards`:
    conditions under which both times are possible."""

    source: View
    target: View
    sees: int
    guards: tuple[str, ...]
    letter: Letter
    call: Call | None


Half = tuple[Letter, bool, str]
"""A letter of the machine, whether it is within the bound without STO, and the guard of its time."""


class Model:
    """The numbered branches of a pair, and the Promela text made from them. A run begins with or without contacts."""

    def __init__(self, pair: Pair) -> None:
        self.pair = pair

    @cached_property
    def views(self) -> Mapping[View, Node]:
        """One node for each view: the cycles that follow depend only on the two situations."""
        views: dict[View, Node] = {}
        for node in sorted(self.pair.roads):
            views.setdefault(look_at(node), node)
        return views

    @cached_property
    def moves(self) -> list[Move]:
        return [move for view, node in self.views.items() for move in self._list_moves_of(view, node)]

    def _list_moves_of(self, view: View, node: Node) -> Iterator[Move]:
        ways: dict[tuple[View, int, str], dict[int, tuple[Letter, Call]]] = {}
        for standing, contacts, time in product((False, True), (False, True), range(4)):
            is_confirmed = self.pair.confirms(node, standing, contacts, time)
            for letter, is_quiet, guard in self._halves[node.machine, is_confirmed]:
                for hold in list_holds(letter):
                    there, call, answer = self.pair.step(node, letter, standing, contacts, time, hold)
                    sees = self._list_sights(node, there, letter, is_quiet)
                    sees += KEEPS_COMMAND if not answer.open and not answer.told_now else 0
                    ways.setdefault((look_at(there), sees, guard), {}).setdefault(time, (letter, call))
        moves = []
        for (target, sees, guard), by_time in ways.items():
            for closing_guard, times in promela.list_guards("closes_within", set(by_time), "closing"):
                letter, call = by_time[max(times)]
                moves.append(Move(view, target, sees, tuple(word for word in (guard, closing_guard) if word), letter, call))
        # A cycle that needs no start is possible with one, and no formula distinguishes them otherwise: a start counts like a guard.
        rows = (((one.target, one.sees & ~START), {*one.guards, *(("start",) if one.sees & START else ())}, one) for one in moves)
        yield from (move for _, _, move in promela.drop_guarded(rows))
        if node.machine != self.pair.machine.corrupted:
            # The outputs keep their values until the next cycle.
            flipped = View(self.pair.machine.corrupted, view.brakes, view.state, view.torque, view.open, view.kept)
            yield Move(view, flipped, 0, (), (), None)

    def _list_sights(self, node: Node, there: Node, letter: Letter, is_quiet: bool) -> int:
        before, after = self.pair.machine.labels[node.machine], self.pair.machine.labels[there.machine]
        is_by_brakes = is_quiet and (before.state, after.state) == (SS1, "Safe")
        keeps_age = after.limit != "none" and before.state == after.state
        return START * letter[6] + BY_BRAKES * is_by_brakes + KEEPS_AGE * keeps_age

    @cached_property
    def _halves(self) -> Mapping[tuple[int, bool], tuple[Half, ...]]:
        """One letter for each possible step of the machine, by situation and standstill."""
        levels = product(range(len(self.pair.machine.labels)), (False, True))
        return {(number, level): tuple(self._list_halves(number, level)) for number, level in levels}

    def _list_halves(self, number: int, standstill: bool) -> Iterator[Half]:
        limit = self.pair.machine.labels[number].limit
        for start, is_sto in product((0, 1), (False, True)):
            demands = list(range(STO, len(VALUES["demand"]))) if is_sto else list(range(STO))
            part = self.pair.machine.next[number][demands][:, :, :, int(standstill), :, :, start]
            for target in np.unique(part):
                places = np.argwhere(part == target).tolist()
                for guard, times in promela.list_guards(limit, {place[-1] for place in places}):
                    at = max((place for place in places if place[-1] in times), key=lambda place: place[-1])
                    letter = (demands[at[0]], at[1], at[2], int(standstill), at[3], at[4], start, *at[5:])
                    yield letter, not is_sto and letter[-1] == WITHIN, guard

    def write(self, properties: Sequence[Property]) -> str:
        """The Promela text, with one named formula for each claim of `properties`."""
        machine, brakes = self.pair.machine, self.pair.brakes
        numbers = {view: number for number, view in enumerate(self.views)}
        firsts = [look_at(node) for node, road in self.pair.roads.items() if road is None]
        branches: dict[View, list[str]] = {view: [] for view in self.views}
        for number, move in enumerate(self.moves):
            guard = " && ".join(move.guards) or "true"
            # A bit flip changes neither buttons nor times.
            sees = str(move.sees) if move.call else f"(start -> {START} : 0) + {FLIPS}"
            branches[move.source].append(
                f"      :: d_step {{ ({guard}) -> to = {numbers[move.target]}; sees = {sees}; printf(\"MOVE {number}\\n\") }}")  # fmt: skip
        moves = [f"    :: situation == {numbers[view]} ->\n      if\n" + "\n".join(rows) + "\n      fi" for view, rows in branches.items()]
        starts = [f"  :: situation = {numbers[view]}; fitted = {int(brakes.fitted[view.brakes])}" for view in firsts]
        views = [f"  :: n == {number} -> state = {view.state}; torque = {int(view.torque)}; open = {int(view.open)};"
                 f" kept = {int(view.kept)};"
                 f" fitted = {int(brakes.fitted[view.brakes])}" for view, number in numbers.items()]  # fmt: skip
        return promela.fill(HEAD, machine, properties, closes_within=CLOSES_WITHIN, firsts="\n".join(starts), views="\n".join(views),
                            moves="\n".join(moves))  # fmt: skip


def look_at(node: Node) -> View:
    is_before_first_cycle = node.memory == Memory()
    return View(node.machine, node.brakes, node.memory.last, node.memory.torque, not node.memory.closed and not is_before_first_cycle,
                node.is_kept)  # fmt: skip
