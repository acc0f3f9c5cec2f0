# SPDX-License-Identifier: Apache-2.0
"""The brake sequence as SMT-LIB for z3, with the machine. One cycle is a set of decision diagrams; closing time and clock are any integers.

@satisfies SWR-FSM-022, SWR-FSM-023      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from collections.abc import Iterable

from verification.safe_state import smt
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import TIMES
from verification.safe_state.brakes.sequence import Memory
from verification.safe_state.brakes.torque import CAUSES, UNKNOWN
from verification.safe_state.properties import Induction, Property

MEMORY = ("was_torque", "was_closed", "stood")
CALL = ("q", "standing", "contacts", "r", "brake_time", "can_hold", "cause")


def write_model(pair: Pair) -> str:
    """The definitions: the machine, one cycle of the brakes, and the possible pasts."""
    machine, brakes = pair.machine, pair.brakes
    own = [f"(= a {state})" for state in dict.fromkeys(label.state for label in machine.labels if label.get("torque_enable"))]
    fitted = [f"(= b {number})" for number, is_fitted in enumerate(brakes.fitted) if is_fitted]
    lines = [
        f"(define-fun Invalid () Int {len(brakes.states)})",
        *(f"(define-fun Closing_{name} () Int {digit})" for digit, name in enumerate(TIMES)),
        f"(define-fun own_torque ((a Int)) Bool (or {' '.join(own)}))",
        *(f"(define-fun Cause_{name} () Int {digit})" for digit, name in enumerate(CAUSES)),
        *(f"(declare-const {name} Int)" for name in ("b", "q", "r", "last", "brake_time", "cause")),
        *(f"(declare-const {name} Bool)" for name in ("standing", "contacts", "can_hold", "kept", *MEMORY)),
        f"(assert (and (<= 0 brake_time) (< brake_time {len(TIMES)}) (<= 0 cause) (< cause {len(CAUSES)})))",
        f"(define-fun fitted () Bool (or {' '.join(fitted)}))",
    ]
    # The states of the machine are numbered from 1.
    before = [("(- q 1)", "Int"), ("standing", "Bool"), ("contacts", "Bool")]
    time = ("brake_time", "Int")
    lines += smt.write_diagram("confirmed_level", "b", brakes.confirmed, [*before, time])
    for name, array in brakes.cycle.items():
        lines += smt.write_diagram("b_t" if name == "next" else f"{name}_level", "b", array, [*before, ("(- r 1)", "Int"), time])
    lines += [f"(define-fun {word} () Bool (= {level}_level 1))" for word, level in (
        ("confirmed", "confirmed"), ("torque_out", "torque"), ("open_out", "open"), ("told_now", "told_now"), ("overdue_out", "overdue"),
        ("closing_out", "closing"))]  # fmt: skip
    lines += ["(define-fun had_torque () Bool (or was_torque kept))"]
    lines += smt.write_diagram("final_level", "(- r 1)", pair.torque.after, [
        ("torque_out", "Bool"), ("closing_out", "Bool"), ("had_torque", "Bool"), ("can_hold", "Bool"), ("cause", "Int")])  # fmt: skip
    lines += ["(define-fun final_torque () Bool (= final_level 1))", "(define-fun kept_t () Bool (and final_torque (not torque_out)))"]
    lines += ["(define-fun stood_now () Bool (and (= q ProtectiveStopSs1) (or standing stood)))",
              "(define-fun stood_t () Bool (and (= r ProtectiveStopSs1) stood_now))"]  # fmt: skip
    lines += _write_known(pair)
    return smt.write_model(machine) + "\n".join(lines) + "\n"


def _write_known(pair: Pair) -> list[str]:
    """The reachable situations with their pasts, alone and under the machine."""
    alone = [f"(and (= b {number}) {_write_memory(memory)})" for number, memory in sorted(pair.brakes.roads)]
    both = [f"(and (= s {node.machine}) (= b {node.brakes}) {_write_memory(node.memory)} {smt.write_literal('kept', node.is_kept)})"
            for node in sorted(pair.roads)]  # fmt: skip
    words = "(b Int) (last Int) (was_torque Bool) (was_closed Bool) (stood Bool)"
    return [f"(define-fun known_alone ({words}) Bool (or\n {_join(alone)}))",
            f"(define-fun known_both ((s Int) {words} (kept Bool)) Bool (or\n {_join(both)}))"]  # fmt: skip


def _join(rows: Iterable[str]) -> str:
    return "\n ".join(rows)


def _write_memory(memory: Memory) -> str:
    levels = zip(MEMORY, (memory.torque, memory.closed, memory.stood), strict=True)
    return " ".join([f"(= last {memory.last})", *(smt.write_literal(name, level) for name, level in levels)])


NOW = "b last was_torque was_closed stood"
NEXT = "b_t r torque_out (not open_out) stood_t"
ALONE = (f"(and (known_alone {NOW}) (<= 1 r) (<= r Invalid)"
         " (or (= q last) (and (= q LockedOut) (= r LockedOut))))")  # fmt: skip
COUPLED = (f"(and (known_both s {NOW} kept) {smt.KNOWN} (= q (state s)) (= r (state t)) (= standstill confirmed)"
           " (= (>= demand Demand_Sto) (not (= cause Cause_None))))")  # fmt: skip


def list_history_queries(pair: Pair) -> list[str]:
    """Base of the pasts: each cycle, and each bit flip of the machine, leads from known pasts to known pasts. The compiled safety cycle was
    executed with each letter of the models."""
    powered = [f"(and (= b {first}) {_write_memory(Memory())} (not kept))" for first in pair.brakes.firsts]
    powered_up = f"(assert (or {' '.join(powered)}))"
    flipped = f"(known_both {pair.machine.corrupted} {NOW} kept)"
    return [
        f"{powered_up}\n(assert (not (and (known_alone {NOW}) (known_both {pair.machine.first} {NOW} kept))))",
        f"(assert (and {ALONE} (not (known_alone {NEXT}))))",
        f"(assert (and {COUPLED} (not (known_both t {NEXT} kept_t))))",
        f"(assert (and {COUPLED} (not {flipped})))",
        f"(assert (and {COUPLED} (= final_level {UNKNOWN})))",
    ]


def list_queries(wanted: Property) -> list[str]:
    """Queries that must be unsatisfiable if the property holds."""
    situation = COUPLED if wanted.is_coupled else ALONE
    if wanted.induction is not None:
        return _write_induction(wanted.induction, situation)
    return [f"(assert (and {situation} (not {wanted.step})))"] if wanted.step else []


def _write_induction(induction: Induction, situation: str) -> list[str]:
    """Base, step and use of the invariant. A cycle takes 1 to `cycle`. The clock of the sequence may also jump to either side of its
    closing time. Before a command to close, this time has no effect."""
    elapsed = "(+ told_age tick)"
    head = [f"(declare-const {name} Int)" for name in ("closed_age", "told_age", "closes_within", "cycle", "tick")]
    head += [
        "(assert (and (> closes_within 0) (> cycle 0) (<= 1 tick cycle)))",
        f"(define-fun exact () Bool (=> was_closed {smt.write_match('brake_time', 'Closing_', elapsed, 'closes_within')}))",
        "(assert (or exact (= brake_time Closing_BeforeCommand) (= brake_time Closing_Beyond)))",
        "(define-fun closing () Int (ite was_closed (+ closed_age tick) 0))",
        "(define-fun last_t () Int r)",
        "(define-fun was_closed_t () Bool (not open_out))",
        "(define-fun closed_age_t () Int closing)",
        f"(define-fun told_age_t () Int (ite told_now 0 {elapsed}))",
    ]
    after = {name: f"{name}_t" for name in ("last", "was_closed", "closed_age", "told_age")}
    return smt.write_induction(induction, head, (), "(not was_closed)", situation, after)  # no command at power-up
