# SPDX-License-Identifier: Apache-2.0
"""The proved properties of the brakes: alone, for any calls, and under the safe-state machine.

Names in the properties for z3 (smt.py): confirm() gets the state `q`, apply() the state `r`. `standing` and `contacts` are measured.
`confirmed`, `torque_out`, `open_out` and `overdue_out` are results. `last`, `was_torque`, `was_closed` and `stood` are the past. `closing`
is the time since the command, on the clock of an external observer. `exact`: the sequence uses that time, without a jump of its clock.
Properties under the machine also use the names of the machine. In the safety cycle, `had_torque` and `final_torque` are the torque before and
after the cycle, `can_hold` and `cause` inputs (torque.py), and `kept_t` is torque that the sequence does not give.
Names in the properties for spin (promela.py): the values that an external observer sees between two cycles.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#properties-of-the-brakes
"""

from __future__ import annotations

from verification.safe_state.properties import NOTHING_WRONG, Induction, Property

HAVE_BITTEN = "(ite fitted contacts (>= closing closes_within))"


MAY_HOLD = "(= r Safe) (= cause Cause_BrakesFirst) can_hold had_torque"


def remember_command(condition: str) -> str:
    """While this condition holds, the sequence remembers the command time that an external observer saw. Claims about time rely on it."""
    return f"(=> {condition} (and was_closed (<= 0 closed_age) (= told_age closed_age)))"


BRAKE_PROPERTIES: tuple[Property, ...] = (
    Property(
        "brakes-closed-without-torque", "SWR-FSM-034",
        "SBC follows STO: in each cycle in which torque is off the brakes are told to close, whatever the caller does.",
        step="(=> (not torque_out) (not open_out))",
        always="[] (torque || !open)",
    ),
    Property(
        "brakes-close-under-torque-in-ss1-only", "SWR-FSM-026",
        "In a state that has torque of its own the brakes are closed only in an SS1 in which the machine was measured standing, and in the"
        " locked hold.",
        step="(=> (and (own_torque r) (not open_out)) (or (= r LockedHold) (and (= r ProtectiveStopSs1) stood_now)))",
        is_coupled=True,
    ),
    Property(
        "ss1-holds-while-its-brakes-close", "SWR-FSM-026",
        "An SS1 has torque, and closes its brakes in the cycle in which the machine is measured standing.",
        step="(=> (= r ProtectiveStopSs1) (and torque_out (=> (and (= q ProtectiveStopSs1) standing) (not open_out))))",
        is_coupled=True,
    ),
    Property(
        "ss1-confirmed-by-its-brakes", "SWR-FSM-027",
        "An SS1 that is neither overdue nor overruled ends only when the machine stands and its brakes have bitten: by their contacts or,"
        " without, when the closing time has passed since the command.",
        induction=Induction(
            invariant=remember_command("(and was_closed (= last ProtectiveStopSs1))"),
            claim="(=> (and (is s ProtectiveStopSs1) (is t Safe) (< demand Demand_Sto) (= time Time_Within))"
                  f" (and standing (or {HAVE_BITTEN} (and (not exact) (= brake_time Closing_Beyond)))))"),
        is_coupled=True,
    ),
    Property(
        "contacts-confirm-after-the-command-only", "SWR-FSM-036",
        "No SS1 is confirmed in the cycle in which its brakes are told to close, with any report of the contacts.",
        step="(=> (and (= q ProtectiveStopSs1) confirmed) was_closed)",
    ),
    Property(
        "torque-outlives-the-hold-only", "SWR-FSM-028",
        "In a state without torque of its own that is neither safe nor locked out, torque is on only in a standby that a hold, or"
        " torque in standby, preceded.",
        step="(=> (and torque_out (not (own_torque r)) (not (= r Safe)) (not (= r LockedOut)))"
             " (and (= r Standby) (or (= last StandstillHold) (and (= last Standby) was_torque))))",
    ),
    Property(
        "torque-outlives-the-hold-within-the-closing-time", "SWR-FSM-028",
        "Torque outlives the hold for less than the closing time after the command to close.",
        induction=Induction(
            invariant=remember_command("was_closed"),
            claim="(=> (and torque_out (= r Standby)) (< closing closes_within))"),
        always="[] (handover_cycles <= CLOSES_WITHIN)",
    ),
    Property(
        "hold-is-handed-over-to-the-brakes", "SWR-FSM-028",
        "The standby that follows a hold begins with torque unless the contacts say that the brakes are closed.",
        step="(=> (and (= last StandstillHold) (= q StandstillHold) (= r Standby) (not (and fitted contacts))) torque_out)",
    ),
    Property(
        "sto-waits-for-no-brakes", "SWR-FSM-028",
        "Torque is off in the cycle in which STO is demanded, and in each safe or locked-out one, however far the brakes are.",
        step="(=> (or (>= demand Demand_Sto) (= r Safe) (= r LockedOut)) (not torque_out))",
        always="[] ((state == Safe || state == LockedOut) -> !torque)",
        is_coupled=True,
    ),
    Property(
        "brakes-open-by-a-start-only", "SWR-FSM-035",
        "Closed brakes open only in the cycle of a start: pushed in standby, at standstill, bumpless, with nothing demanded or latched.",
        step="(=> (and was_closed open_out) (and (is s Standby) (is t Operational) start_button (not last_start) standing start_permitted"
             f" {NOTHING_WRONG}))",
        always="[] ((!open && [] !start) -> [] !open)",
        is_coupled=True,
    ),
    Property(
        "silent-brakes-are-overdue", "SWR-FSM-029",
        "Brakes with contacts that do not say closed are overdue from the first cycle beyond the closing time on, and not before; also"
        " when the clock runs to either side of it.",
        induction=Induction(
            invariant=remember_command("was_closed"),
            claim="(and (=> exact (= overdue_out (and fitted (not contacts) (not open_out) (> closing closes_within))))"
                  " (=> (and fitted (not contacts) was_closed (not open_out)"
                  " (or (= brake_time Closing_BeforeCommand) (= brake_time Closing_Beyond))) overdue_out))"),
    ),
    Property(
        "brakes-end-stops", "SWR-FSM-027",
        "Brakes with contacts and brakes without end an SS1 before its bound: nothing is proved of brakes that do nothing.",
        possible=("fitted && by_brakes", "!fitted && by_brakes"),
        is_coupled=True,
    ),
    Property(
        "brakes-first-waits-for-the-brakes", "SWR-CYC-030",
        "If only the position is unknown and torque can hold, STO takes no torque away before the contacts report closed or the closing time"
        " has passed since the command.",
        induction=Induction(
            invariant=remember_command("was_closed"),
            claim=f"(=> (and {MAY_HOLD} exact (< closing closes_within) was_closed (not contacts)) final_torque)"),
        is_coupled=True,
    ),
    Property(
        "brakes-first-waits-for-stuck-contacts", "SWR-CYC-037",
        "No report of the contacts takes the torque away in the cycle in which the brakes are told to close.",
        step=f"(=> (and {MAY_HOLD} (not was_closed)) final_torque)",
        is_coupled=True,
    ),
    Property(
        "brakes-first-ends-with-the-closing-time", "SWR-CYC-030",
        "The cycle keeps torque for less than the closing time after the command to close, with closed brakes, on any clock.",
        induction=Induction(
            invariant=remember_command("was_closed"),
            claim="(=> kept_t (and (not open_out) (< closing closes_within)))"),
        always="[] (kept_cycles <= CLOSES_WITHIN)",
        is_coupled=True,
    ),
    Property(
        "another-sto-ends-torque-at-once", "SWR-CYC-030",
        "The cycle keeps no torque when STO is demanded for any other reason or none, lost trust locks out, or torque cannot hold.",
        step="(=> kept_t (and (= cause Cause_BrakesFirst) can_hold (not lock_out) (< self_test Test_Failed)))",
        is_coupled=True,
    ),
    Property(
        "cycle-keeps-torque-only", "SWR-CYC-030",
        "The safety cycle gives the torque of the brake sequence, and more only in the safe state after a cycle with torque.",
        step="(and (=> torque_out final_torque) (=> kept_t (and (= r Safe) had_torque)))",
        is_coupled=True,
    ),
)  # fmt: skip
