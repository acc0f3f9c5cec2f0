# SPDX-License-Identifier: Apache-2.0
"""The machine as SMT-LIB for z3. Its step is a decision diagram made from the relation; bounds and times are any integers.

@satisfies SWR-FSM-022, SWR-FSM-023      Design: docs/design/safe_state.md#models
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mamori_trace.base.errors import WorkError
from verification.safe_state.machine import Machine, Past
from verification.safe_state.properties import RANKS, Induction, Property
from verification.safe_state.relation import INPUTS, LEVELS, VALUES, Array, Label

SORTS = {name: "Bool" if VALUES[name] == LEVELS else "Int" for name in INPUTS}
PREFIXES = {"demand": "Demand_", "self_test": "Test_", "time": "Time_"}
WORSENED = ("demand", "self_test", "lock_out")
PASTS = ("last_start", "last_reset", "has_run")
MOVING = ("Operational", "Degraded")
STOPS = ("ProtectiveStopSs2", "ProtectiveStopSs1", "StandstillHold", "LockedHold", "Safe")
TIMEOUT_S = 120.0


@dataclass(frozen=True)
class Query:
    """A condition that must be unsatisfiable. `owner`: the property, or "" for the base of all properties."""

    owner: str
    text: str


def write_model(machine: Machine) -> str:
    """The definitions: the step, what an external observer sees, and one step with its past."""
    lines = ["; Generated from the compiled safe-state machine; see docs/design/safe_state.md#models.", "(set-logic ALL)"]
    lines += [f"(define-fun {name} () Int {number})" for number, name in enumerate(machine.states, start=1)]
    for name, prefix in PREFIXES.items():
        lines += [f"(define-fun {prefix}{value} () Int {digit})" for digit, value in enumerate(VALUES[name])]
    lines += _write_views(machine) + _write_situation(machine)
    return "\n".join(lines) + "\n"


def _write_views(machine: Machine) -> list[str]:
    """What an external observer sees, as lists of situations, because z3 takes minutes to unfold comparisons of nested choices."""

    def view(name: str, is_seen: Callable[[Label], bool]) -> str:
        return f"(define-fun {name} ((s Int)) Bool {_is_one_of(is_seen)})"

    def _is_one_of(is_seen: Callable[[Label], bool]) -> str:
        members = [f"(= s {number})" for number, label in enumerate(machine.labels) if is_seen(label)]
        return f"(or {' '.join(members)})" if members else "false"

    arrows = sorted({(state, target) for (state, _), target in machine.table.items() if state != target})
    def is_wanted(state: str) -> str:
        return f"(and (= wanted {state}) {_is_one_of(lambda label: label.is_consistent and label.state == state)})"

    wanted = [is_wanted(state) for state in machine.states]
    return [
        f"(define-fun state ((s Int)) Int {_choose('s', [label.state for label in machine.labels])})",
        f"(define-fun rank ((s Int)) Int {_choose('s', [str(RANKS[label.state]) for label in machine.labels])})",
        view("consistent", lambda label: label.is_consistent),
        view("torque", lambda label: label.get("torque_enable")),
        view("brake", lambda label: label.get("brake_release")),
        view("limit_ss2", lambda label: label.limit == "ss2_within"),
        view("limit_ss1", lambda label: label.limit == "ss1_within"),
        view("is_moving", lambda label: label.is_consistent and label.state in MOVING),
        view("is_stop", lambda label: label.is_consistent and label.state in STOPS),
        f"(define-fun is ((s Int) (wanted Int)) Bool (or {' '.join(wanted)}))",
        "(define-fun arrow ((a Int) (b Int)) Bool (or "
        + " ".join(f"(and (= a {state}) (= b {target}))" for state, target in arrows) + "))",
    ]  # fmt: skip


def _choose(word: str, values: Sequence[str]) -> str:
    """Nested ite over a number 0 .. count - 1."""
    text = values[-1]
    for number in range(len(values) - 2, -1, -1):
        if values[number] != text:
            text = f"(ite (= {word} {number}) {values[number]} {text})"
    return text


def write_diagram(result: str, root: str, answers: Array, inputs: Sequence[tuple[str, str]]) -> list[str]:
    """The number in `answers` for `root` and the inputs, as the constant `result`. Each node of the decision diagram becomes one constant,
    the deepest first; z3 would expand functions at each use. `inputs`: names and sorts of the axes after the first."""
    lines: list[str] = []
    known: dict[tuple[int, bytes], str] = {}

    def make(part: Array, depth: int) -> str:
        if (part == part.flat[0]).all():
            return str(int(part.flat[0]))
        key = (depth, part.tobytes())
        if key not in known:
            branches = [make(branch, depth + 1) for branch in part]
            name, sort = inputs[depth]
            if all(branch == branches[0] for branch in branches):
                known[key] = branches[0]
            else:
                known[key] = f"{result}{len(lines)}"
                body = f"(ite {name} {branches[1]} {branches[0]})" if sort == "Bool" else _choose(name, branches)
                lines.append(f"(define-fun {known[key]} () Int {body})")
        return known[key]

    roots = [make(np.ascontiguousarray(part), 0) for part in answers]
    return [*lines, f"(define-fun {result} () Int {_choose(root, roots)})"]


def _write_situation(machine: Machine) -> list[str]:
    """One step: its inputs, the same inputs with worse values, the past, and the possible pasts."""
    known = []
    for pasts in machine.pasts:
        words = [f"(and {' '.join(write_literal(*pair) for pair in zip(PASTS, _levels(past), strict=True))})" for past in sorted(pasts)]
        known.append(f"(or {' '.join(words)})" if words else "false")
    names = [(name, SORTS[name]) for name in INPUTS]
    worse = [(f"worse_{name}" if name in WORSENED else name, sort) for name, sort in names]
    return [
        "(declare-const s Int)",
        *(f"(declare-const {name} Bool)" for name in PASTS),
        *(f"(declare-const {name} {SORTS[name]})" for name in INPUTS),
        *(f"(declare-const worse_{name} {SORTS[name]})" for name in WORSENED),
        *(_write_range(name, len(VALUES[name])) for name in PREFIXES),
        *(_write_range(f"worse_{name}", len(VALUES[name])) for name in WORSENED if SORTS[name] == "Int"),
        *write_diagram("t", "s", machine.next, names),
        *write_diagram("t_worse", "s", machine.next, worse),
        f"(define-fun known ((s Int) (last_start Bool) (last_reset Bool) (has_run Bool)) Bool (and (<= 0 s) (< s {len(known)})"
        f" {_choose('s', known)}))",
        "(define-fun has_run_t () Bool (and (= (state s) (state t)) (or has_run (= self_test Test_Running))))",
    ]  # fmt: skip


def _write_range(name: str, count: int) -> str:
    return f"(assert (and (<= 0 {name}) (< {name} {count})))"


def _levels(past: Past) -> tuple[bool, bool, bool]:
    return past.start, past.reset, past.has_run


def write_literal(name: str, level: bool) -> str:
    return name if level else f"(not {name})"


KNOWN = "(known s last_start last_reset has_run)"


def list_history_queries(machine: Machine) -> list[str]:
    """Base of the pasts: power-up has a known past, and each step and each bit flip leads from known pasts to known pasts."""
    return [
        f"(assert (not (known {machine.first} true true false)))",
        f"(assert (and {KNOWN} (not (known t start_button reset_button has_run_t))))",
        f"(assert (and {KNOWN} (not (known {machine.corrupted} last_start last_reset has_run))))",
    ]


def list_queries(machine: Machine, wanted: Property) -> list[str]:
    """Queries that must be unsatisfiable if the property holds."""
    if wanted.induction is not None:
        return _write_induction(machine, wanted.induction)
    return [f"(assert (and {KNOWN} (not {wanted.step})))"] if wanted.step else []


def write_induction(induction: Induction, head: Sequence[str], step: Sequence[str], base: str, situation: str,
                    after: Mapping[str, str]) -> list[str]:  # fmt: skip
    """Base, step and use of the invariant. `head`: definitions for all three queries, `step`: for the step only. `after`: names in the
    invariant, and their names after the step."""
    moved = re.sub(r"\b\w+\b", lambda word: after.get(word[0], word[0]), induction.invariant)
    return [
        "\n".join([*head, f"(assert {base})", f"(assert (not {induction.invariant}))"]),
        "\n".join([*head, *step, f"(assert (and {situation} {induction.invariant} (not {moved})))"]),
        "\n".join([*head, f"(assert (and {situation} {induction.invariant} (not {induction.claim})))"]),
    ]


def write_match(time: str, prefix: str, elapsed: str, bound: str) -> str:
    """The time class of the machine equals the class of `elapsed` relative to the bound."""
    return f"(= {time} (ite (< {elapsed} {bound}) {prefix}Within (ite (= {elapsed} {bound}) {prefix}AtBound {prefix}Beyond)))"


COUNTERS = {"age": "Int", "demanded": "Bool", "since_demand": "Int", "unconfirmed": "Bool", "since_stop": "Int"}
"""Time since the entry into the state; since a demand of SS1 under torque; since the start of an SS2 without standstill."""


def _write_induction(machine: Machine, induction: Induction) -> list[str]:
    """Base, step and use of the invariant. A cycle takes 1 to `cycle`; the clock may also jump to either side of the time of the state."""
    ranges = "(and (> ss2_within 0) (> ss1_within 0) (> cycle 0) (<= 1 tick cycle))"
    elapsed = "(+ age tick)"
    within = {bound: write_match("time", "Time_", elapsed, bound) for bound in ("ss2_within", "ss1_within")}
    head = [f"(declare-const {name} {sort})" for name, sort in COUNTERS.items()]
    head += [f"(declare-const {name} Int)" for name in ("ss2_within", "ss1_within", "cycle", "tick")]
    head += ["(declare-const flips Bool)", f"(assert {ranges})"]
    clock = (f"(or (= time Time_BeforeEntry) (= time Time_Beyond) (ite (limit_ss2 s) {within['ss2_within']}"
             f" (=> (limit_ss1 s) {within['ss1_within']})))")  # fmt: skip
    step = [
        f"(define-fun t_all () Int (ite flips {machine.corrupted} t))",
        f"(assert {clock})",
        f"(define-fun age_t () Int (ite (= (state s) (state t_all)) {elapsed} 0))",
        "(define-fun demanded_t () Bool (and (torque t_all) (not (is t_all LockedHold)) (or demanded (= demand Demand_Ss1))))",
        "(define-fun since_demand_t () Int (ite demanded (+ since_demand tick) 0))",
        "(define-fun unconfirmed_t () Bool (and (torque t_all) (not (is t_all LockedHold)) (or (and unconfirmed (not standstill))"
        " (and (not (is s ProtectiveStopSs2)) (is t_all ProtectiveStopSs2)))))",
        "(define-fun since_stop_t () Int (ite unconfirmed (+ since_stop tick) 0))",
    ]
    base = f"(and (= s {machine.first}) (= age 0) (not demanded) (not unconfirmed))"
    return write_induction(induction, head, step, base, KNOWN, {name: f"{name}_t" for name in COUNTERS} | {"s": "t_all"})


def ask_all(model: str, queries: Sequence[Query], path: Path) -> list[bool]:
    """Writes a file that z3 can also run alone: it answers "unsat" to each query if the machine has the properties. @return for each query,
    whether it is unsatisfiable. @raise WorkError if z3 is missing or does not answer."""
    asked = "".join(f"(push)\n{query.text}\n(check-sat)\n(pop)\n" for query in queries)
    path.write_text(model + asked, encoding="utf-8")
    answers = _ask(path).split()
    if len(answers) != len(queries) or not set(answers) <= {"sat", "unsat"}:
        raise WorkError(f"z3 gave no answer to a query: {' '.join(answers)[:200]}; the queries are in {path}")
    return [answer == "unsat" for answer in answers]


def ask_values(model: str, query: Query, names: Sequence[str], path: Path) -> dict[str, int]:
    """Values of the constants that satisfy the query; 0 and 1 for levels. @raise WorkError like ask_all."""
    path.write_text(model + f"{query.text}\n(check-sat)\n(get-value ({' '.join(names)}))\n", encoding="utf-8")
    values = dict(re.findall(r"\((\w+) (true|false|\d+)\)", _ask(path)))
    return {name: int(text) if text.isdecimal() else int(text == "true") for name, text in values.items()}


def _ask(path: Path) -> str:
    try:
        done = subprocess.run(("z3", str(path)), capture_output=True, text=True, check=False, timeout=TIMEOUT_S)
    except OSError as error:
        raise WorkError("z3 is missing; install the package z3 (./mamori prove does)") from error
    except subprocess.TimeoutExpired as error:
        raise WorkError(f"z3 gave no answer in {TIMEOUT_S:.0f} s to {path}") from error
    if done.returncode != 0 or "(error" in done.stdout:
        raise WorkError(f"z3 refuses {path}: {(done.stdout + done.stderr).strip()[:200]}")
    return done.stdout
