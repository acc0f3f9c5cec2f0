# SPDX-License-Identifier: Apache-2.0
"""The verdict on one run: a pure function from record and expectation to checks. Missing data fails; nothing is skipped."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mamori_tools.campaign.arm.run_record import RunRecord, read_record
from mamori_tools.campaign.arm.selection import ArmCase
from mamori_tools.campaign.arm.vocabulary import NOTHING
from mamori_tools.campaign.case import Check
from mamori_trace.base.errors import WorkError

ROUNDING_S = 1e-9
"""Permitted rounding excess over a time limit [s], because times are frames of 1 ms written as decimals."""


def judge(case: ArmCase, run: Mapping[str, Any] | None, problem: str = "") -> list[Check]:
    """All checks of a case. `problem` states why there is no valid run; the case then fails."""
    if problem or run is None:
        return [Check("run", "a whole run", problem or "no run", False)]
    try:
        record = read_record(run)
    except WorkError as error:
        return [Check("run", "a whole run.json", str(error), False)]
    checks = [Check("run", "a whole run", "whole", True), *_judge_setting(case, record), _judge_false_trip(case, record),
              *_judge_outcome(case, record), _judge_speed(record), _judge_position(record)]  # fmt: skip
    if case.expected.wants_stop:
        checks += _judge_stop(case, record)
    if not case.expected.wants_reaction:
        checks.append(_judge_tracking(case, record))
    return checks


def describe_faults(case: ArmCase) -> str:
    """The argument `--fault` of the program."""
    first = "kind=none" if case.fault is None else case.fault.to_text()
    return f"{first},latent={case.latent}" if case.latent else first


def _judge_setting(case: ArmCase, record: RunRecord) -> list[Check]:
    """Checks that the run is the requested one: the right fault, in operation at the injection, observed long enough."""
    if case.fault is None:
        wanted = describe_faults(case)
        difference = "" if record.fault is None else f"{record.fault.get('kind')}"
    else:
        wanted = describe_faults(case)
        difference = case.fault.find_difference(record.fault)
    if not difference and record.latent != case.latent:
        difference = f"latent {record.latent or 'none'}"
    start = record.operational_at_s
    begin = record.injected_at_s
    end = (begin or 0.0) + case.watch_s
    in_time = start is not None and (begin is None or start < begin)
    return [
        Check("fault injected", wanted, difference or "as wanted", not difference),
        Check("seed", str(case.seed), str(record.seed), record.seed == case.seed),
        Check("operational first", "operational" if begin is None else f"operational before {begin:.3f} s",
              _show(start, "s", "never operational"), in_time) if case.expected.operational else
        Check("start refused", "never operational", _show(start, "s", "never operational"), start is None),
        Check("time watched", f">= {end:.3f} s", f"{record.simulated_s:.3f} s", record.simulated_s >= end - ROUNDING_S),
    ]  # fmt: skip


def _judge_false_trip(case: ArmCase, record: RunRecord) -> Check:
    """Checks that nothing is detected and nothing reacts before the fault."""
    happened = [("detected", record.detected_fault, record.detected_at_s), ("reacted", record.reaction, record.reacted_at_s)]
    if not case.expected.operational:
        happened = happened[1:]  # the self test detects the fault
    events = [(verb, name, at_s) for verb, name, at_s in happened if name not in (None, NOTHING)]
    begin = record.injected_at_s
    if begin is None or not case.expected.wants_reaction:
        wrong, wanted = events, "no trip"
    else:
        wrong = [event for event in events if event[2] is None or event[2] < begin - ROUNDING_S]
        wanted = f"no trip before {begin:.3f} s"
    measured = ", ".join(f"{verb} {name} at {_show(at_s, 's', 'an unknown time')}" for verb, name, at_s in wrong)
    return Check("no false trip", wanted, measured or "none", not wrong)


def _judge_outcome(case: ArmCase, record: RunRecord) -> list[Check]:
    expected = case.expected
    detected = record.detected_fault or NOTHING
    reaction = record.reaction or NOTHING
    checks = [
        Check("final state", expected.state, record.final_state, record.final_state == expected.state),
        Check("detected fault", " or ".join(expected.detected_faults), detected, detected in expected.detected_faults),
        Check("reaction", " or ".join(expected.reactions), reaction, reaction in expected.reactions),
    ]
    if expected.within_s is not None:
        delay_s = _subtract(record.reacted_at_s, record.injected_at_s)
        in_time = delay_s is not None and -ROUNDING_S <= delay_s <= expected.within_s + ROUNDING_S
        checks.append(Check("reaction time", f"<= {expected.within_s:.3f} s", _show(delay_s, "s", "unknown"), in_time))
    if expected.watchdog_bitten is not None:
        words = {True: "bitten", False: "not bitten"}
        checks.append(Check("watchdog", words[expected.watchdog_bitten], words[record.watchdog_bitten],
                            record.watchdog_bitten == expected.watchdog_bitten))  # fmt: skip
    return checks


def _judge_speed(record: RunRecord) -> Check:
    """Compares each joint with its mechanical limit, and shows the joint that is nearest to or farthest above its limit."""
    pairs = list(zip(record.max_speed_rad_s, record.speed_limit_rad_s, strict=True))
    worst = max(range(len(pairs)), key=lambda joint: pairs[joint][0] - pairs[joint][1])
    over = [joint for joint, (speed, limit) in enumerate(pairs) if speed > limit]
    speed, limit = pairs[worst]
    return Check("speed limit", "each joint within its limit", f"joint {worst + 1}: {speed:.3f} of {limit:.3f} rad/s", not over)


def _judge_position(record: RunRecord) -> Check:
    margin = record.min_position_margin_rad
    return Check("position range", "margin >= 0 rad", f"{margin:.4f} rad", margin >= 0.0)


def _judge_stop(case: ArmCase, record: RunRecord) -> list[Check]:
    bounds = case.bounds
    still = record.standstill_at_s
    begin = record.injected_at_s or 0.0
    reached = still is not None and still >= begin - ROUNDING_S
    held_s = _subtract(record.simulated_s, still)
    watched = held_s is not None and held_s >= bounds.hold_observed_s - ROUNDING_S
    drift = record.hold_drift_rad
    return [
        Check("standstill", f"reached after {begin:.3f} s", _show(still, "s", "never"), reached),
        Check("standstill watched", f">= {bounds.hold_observed_s:.3f} s", _show(held_s, "s", "never"), watched),
        Check("hold drift", f"<= {bounds.hold_drift_rad:g} rad", "unknown" if drift is None else f"{drift:.6f} rad",
              drift is not None and 0.0 <= drift <= bounds.hold_drift_rad),
    ]  # fmt: skip


def _judge_tracking(case: ArmCase, record: RunRecord) -> Check:
    error = record.max_tracking_error_rad
    bound = case.bounds.tracking_error_rad
    return Check("tracking error", f"< {bound:g} rad", "unknown" if error is None else f"{error:.6f} rad",
                 error is not None and 0.0 <= error < bound)  # fmt: skip


def _subtract(late_s: float | None, early_s: float | None) -> float | None:
    return None if late_s is None or early_s is None else late_s - early_s


def _show(value: float | None, unit: str, otherwise: str) -> str:
    return otherwise if value is None else f"{value:.3f} {unit}"
