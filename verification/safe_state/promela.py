# SPDX-License-Identifier: Apache-2.0
"""The machine as a Promela model for spin, with one branch for each step that the formulas distinguish.

@satisfies SWR-FSM-022, SWR-FSM-023      Design: docs/design/safe_state.md#models
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mamori_trace.base.errors import WorkError
from verification.safe_state.machine import Machine
from verification.safe_state.properties import Property
from verification.safe_state.relation import VALUES

BOUNDS = {"ss2_within": 2, "ss1_within": 3}
"""In cycles. Short bounds suffice, because only the comparison with the bound matters; z3 proves the same for all bounds."""
SS1 = VALUES["demand"].index("Ss1")
BEFORE_ENTRY, WITHIN, AT_BOUND, BEYOND = range(4)
COMPILE = ("gcc", "-O0", "-w", "-DNOREDUCE", "-DREACH", "-o", "pan", "pan.c")
DEPTH_MAX = 100_000
SHORT_DEPTHS = (8, 16, 24, 32, 40, 48, 64, 96, 128, 192)
"""A depth-first search finds long paths; with -DREACH it finds a path within a depth if one exists."""
TIMEOUT_S = 120.0

HEAD = """\
/* Generated from the compiled safe-state machine; see docs/design/safe_state.md#models. */
{states}
#define SS2_WITHIN {ss2_within}
#define SS1_WITHIN {ss1_within}

byte to = {first};          /* situation after the step */
hidden byte sees = 0;       /* inputs that the formulas speak about: 1 standstill, 2 reset, 4 demand of SS1 */
byte age = 0;               /* cycles since the state was entered, while a bound counts */

/* What an external observer sees between two cycles. */
byte situation = {first};
byte state = {first_state};
bool torque = {first_torque};
bool corrupted = 0;
bool standstill = 0;
bool reset = 1;
bool was_safe = 0;
byte demand_cycles = 0;     /* since SS1 was demanded under torque; 0 when it was not */
byte stop_cycles = 0;       /* since an SS2 began whose standstill did not come; 0 when there is none */
byte next_state = 0;
bool next_torque = 0;

inline look_up(s, limited) {{
  if
{views}
  fi
}}

inline settle() {{
  d_step {{
    bool is_limited = 0;
    look_up(to, is_limited);
    standstill = (sees & 1) != 0;
    reset = (sees & 2) != 0;
    if
    :: !next_torque || next_state == LockedHold -> demand_cycles = 0
    :: next_torque && next_state != LockedHold && (demand_cycles > 0 || (sees & 4) != 0) -> demand_cycles = demand_cycles + (demand_cycles <= SS1_WITHIN)
    :: else -> skip
    fi;
    if
    :: !next_torque || next_state == LockedHold -> stop_cycles = 0
    :: next_torque && next_state != LockedHold && stop_cycles > 0 && !standstill -> stop_cycles = stop_cycles + (stop_cycles <= SS2_WITHIN + SS1_WITHIN)
    :: next_torque && stop_cycles == 0 && state != ProtectiveStopSs2 && next_state == ProtectiveStopSs2 -> stop_cycles = 1
    :: else -> stop_cycles = 0
    fi;
    if
    :: is_limited && next_state == state -> age = age + (age <= SS2_WITHIN + SS1_WITHIN)
    :: else -> age = 0
    fi;
    situation = to;
    corrupted = to == {corrupted};
    torque = next_torque;
    state = next_state;
    was_safe = was_safe || state == Safe;
    next_state = 0; next_torque = 0; is_limited = 0;
  }}
}}

active proctype machine() {{
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


@dataclass(frozen=True)
class Move:
    """A branch of the model: represents all letters from `source` to `target` that look the same. Empty letter: a bit flip."""

    source: int
    target: int
    sees: int
    guard: str
    letter: tuple[int, ...]


Way = tuple[Hashable, set[str], Any]


@dataclass(frozen=True)
class Run:
    """spin's result for one formula: None, or the moves of a run that violates it; no moves for a possible condition. `loop`: the first move
    of the endless part of the run, if the run is infinite."""

    name: str
    moves: tuple[int, ...] | None
    loop: int | None = None


def list_moves(machine: Machine) -> list[Move]:
    """Each step that the formulas distinguish."""
    moves: list[Move] = []
    for source in range(len(machine.labels)):
        ways = drop_guarded(((move.target, move.sees), {move.guard} - {""}, move) for move in _list_moves_of(machine, source))
        moves += [move for _, _, move in ways]
        if source != machine.corrupted:
            moves.append(Move(source, machine.corrupted, 0, "", ()))
    return moves


def _list_moves_of(machine: Machine, source: int) -> Iterator[Move]:
    limit = machine.labels[source].limit
    for sees in range(8):
        standstill, reset, is_ss1 = sees & 1, sees >> 1 & 1, sees >> 2
        demands = [SS1] if is_ss1 else [digit for digit in range(len(VALUES["demand"])) if digit != SS1]
        part = machine.next[source][demands][:, :, :, standstill, :, :, :, reset, :, :]
        for target in np.unique(part):
            places = np.argwhere(part == target)
            for guard, times in list_guards(limit, {int(time) for time in places[:, -1]}):
                at = max((place for place in places.tolist() if place[-1] in times), key=lambda place: place[-1])
                letter = (demands[at[0]], at[1], at[2], standstill, at[3], at[4], at[5], reset, *at[6:])
                yield Move(source, int(target), sees, guard, letter)


def drop_guarded(ways: Iterable[Way]) -> Iterator[Way]:
    """Without the moves that another one between the same situations makes possible whenever their guards hold. `ways`: what a move leads
    to, its guards, and the move."""
    kept: dict[Hashable, list[Way]] = {}
    for way in sorted(ways, key=lambda way: len(way[1])):
        alike = kept.setdefault(way[0], [])
        if not any(other[1] <= way[1] for other in alike):
            alike.append(way)
    for alike in kept.values():
        yield from alike


def list_guards(limit: str, times: set[int], counter: str = "age") -> Iterator[tuple[str, set[int]]]:
    """When a step at one of `times` is possible. The clock may jump before the entry and beyond the bound in any cycle. `counter`: the
    number of cycles that is compared with the bound."""
    if limit == "none":
        yield "", times
        return
    bound = limit.upper()
    if times & {BEFORE_ENTRY, BEYOND}:
        yield "", times & {BEFORE_ENTRY, BEYOND}
    if WITHIN in times:
        yield f"{counter} + 1 < {bound}", {WITHIN}
    if AT_BOUND in times:
        yield f"{counter} + 1 == {bound}", {AT_BOUND}


def write_model(machine: Machine, properties: Sequence[Property]) -> str:
    """The Promela text, with one named formula for each claim of `properties`."""
    moves = list_moves(machine)
    branches = []
    for number, move in enumerate(moves):
        guard = f"situation == {move.source}" + (f" && {move.guard}" if move.guard else "")
        sees = str(move.sees) if move.letter else "(reset -> 2 : 0)"
        branches.append(f"    :: d_step {{ ({guard}) -> to = {move.target}; sees = {sees}; printf(\"MOVE {number}\\n\") }}")
    views = []
    for number, label in enumerate(machine.labels):
        is_limited = int(label.limit != "none")
        views.append(f"  :: s == {number} -> next_state = {label.state}; next_torque = {int(label.get('torque_enable'))};"
                     f" limited = {is_limited}")  # fmt: skip
    first = machine.labels[machine.first]
    return fill(
        HEAD, machine, properties, first=machine.first, first_state=first.state, first_torque=int(first.get("torque_enable")), corrupted=machine.corrupted,
        views="\n".join(views), moves="\n".join(branches),
    )  # fmt: skip


def fill(head: str, machine: Machine, properties: Sequence[Property], **parts: object) -> str:
    """@return the text of a model: `head` with states, bounds, formulas and `parts`."""
    states = "\n".join(f"#define {name} {number}" for number, name in enumerate(machine.states, start=1))
    formulas = "\n".join(f"ltl {name} {{ {formula} }}" for name, formula in list_formulas(properties))
    return head.format(states=states, formulas=formulas, **BOUNDS, **parts)


def list_formulas(properties: Sequence[Property]) -> list[tuple[str, str]]:
    """A name and a formula for each claim. For a possible condition, the formula claims that it is impossible; spin must refute it."""
    formulas = []
    for one in properties:
        word = one.name.replace("-", "_")
        if one.always:
            formulas.append((word, one.always))
        formulas += [(f"{word}_{number}", f"[] !({condition})") for number, condition in enumerate(one.possible)]
    return formulas


def check_all(text: str, properties: Sequence[Property], folder: Path, name: str) -> dict[str, Run]:
    """Writes the model to the file `name` and checks each formula with spin. @return the results by name. @raise WorkError if spin or gcc
    is missing or fails."""
    (folder / name).write_text(text, encoding="utf-8")
    _call(("spin", "-a", name), folder)
    _call(COMPILE, folder)
    runs = {}
    for one in properties:
        word = one.name.replace("-", "_")
        if one.always:
            runs[word] = _check_one(word, folder)
        for number in range(len(one.possible)):
            formula = f"{word}_{number}"
            runs[formula] = Run(formula, () if _is_broken(formula, DEPTH_MAX, folder) else None)
    return runs


def _check_one(name: str, folder: Path) -> Run:
    if not _is_broken(name, DEPTH_MAX, folder):
        return Run(name, None)
    # The trail is that of the last call: at the smallest depth that shows the violation, otherwise at the full depth.
    if not any(_is_broken(name, depth, folder) for depth in SHORT_DEPTHS):
        _is_broken(name, DEPTH_MAX, folder)
    trail = _call(("./pan", "-S", "-N", name), folder)
    moves: list[int] = []
    loop = None
    for line in trail.splitlines():
        if match := re.search(r"MOVE (\d+)", line):
            moves.append(int(match[1]))
        elif "START OF CYCLE" in line:
            loop = len(moves)
    return Run(name, tuple(moves), loop)


def _is_broken(name: str, depth: int, folder: Path) -> bool:
    words = _call(("./pan", "-a", "-w16", f"-m{depth}", "-N", name), folder)
    found = re.search(r"errors: (\d+)", words)
    if found is None or (depth == DEPTH_MAX and "max search depth too small" in words):
        raise WorkError(f"spin did not search everything for {name}: {words.strip()[-200:]}")
    return found[1] != "0"


def _call(argv: tuple[str, ...], folder: Path) -> str:
    try:
        done = subprocess.run(argv, cwd=folder, capture_output=True, text=True, check=False, timeout=TIMEOUT_S)
    except OSError as error:
        raise WorkError(f"{argv[0]} is missing; install the packages spin and gcc (./mamori prove does)") from error
    except subprocess.TimeoutExpired as error:
        raise WorkError(f"{argv[0]} did not end in {TIMEOUT_S:.0f} s; its files are in {folder}") from error
    if done.returncode != 0 and argv[0] != "./pan":
        raise WorkError(f"{' '.join(argv)} ended with status {done.returncode}: {(done.stdout + done.stderr).strip()[:200]}")
    return done.stdout
