# SPDX-License-Identifier: Apache-2.0
"""The cases of `mamori hil`: the faults of the campaign plan, the communication errors of each link, and killed processes.

@satisfies SWR-HIL-008      Design: docs/design/safe_arm.md#hardware-in-the-loop
Source: IEC 61784-3:2021, 5.3 (communication errors)
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mamori_tools.campaign import load_plan, select
from mamori_tools.campaign.arm.fault import Fault
from mamori_tools.campaign.arm.plan import ArmPlan, Expected
from mamori_tools.campaign.arm.selection import FRAME_S, ArmCase, resolve
from mamori_tools.motion import Motion
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

ERRORS = ("corruption", "repetition", "sequence", "loss", "delay", "insertion", "masquerade", "addressing")
LINKS = ("command", "drive", "device", "state")
PROCESSES = ("kernel", "controller", "plant")
MESSAGE_FAULT = "message_lost"
"""The fault of the program that an error on a link replaces."""

REPLACED_FAULTS = ("processor_stops", "message_damaged", "clock_wrong")
"""Faults of the program that the kill of a process and an error on a link replace, or that processes on one clock cannot have."""

AFTER_S = 1.2
"""Observation time after an error on a link or a killed process [s]: standstill is observed for at least 0.5 s."""

ERRORS_AT = (0.25, 0.5, 0.7)
"""Instants of errors, as fractions of the motion."""

WITHIN_S = 0.02
UNDISTURBED = Expected("Operational", ("None",), ("None",), None, False)
STOPPED = {
    "command": Expected("Safe", ("Ss1",), ("CommandStale", "ControllerSilent"), WITHIN_S, False),
    "state": Expected("Safe", ("Ss1",), ("CommandStale", "ControllerSilent"), WITHIN_S, False),
    # Without readings, the supervisor cannot confirm that the torque is off: it stops the watchdog service later.
    "device": Expected("Safe", ("Sto",), ("MeasurementStale",), WITHIN_S, None),
    # The plant closes by itself; its record ends with the last report of the supervisor.
    "drive": Expected("Safe", ("Sto",), ("WatchdogExpired", "SupervisorSilent", "MeasurementStale"), WITHIN_S, True),
}  # fmt: skip
"""The result if no valid message passes a link."""

STOPPING = ("corruption", "loss", "addressing")
"""Errors that leave no valid message while they last. A delay stops the arm, even for a single message: the others wait behind it."""


@dataclass(frozen=True)
class HilCase:
    """One run of the three processes. `link` and `error`: a communication error; `kill`: the process that is killed at a random instant."""

    arm: ArmCase
    link: str = ""
    error: str = ""
    kill: str = ""
    kill_at_s: float = 0.0

    @property
    def id(self) -> str:
        return self.arm.id

    @property
    def frames(self) -> int:
        assert self.arm.frames is not None
        return self.arm.frames


def list_cases(plan_path: Path, motion: Motion) -> tuple[HilCase, ...]:
    """All cases except kills. The first ones cover each kind once."""
    plan = load_plan(plan_path)
    assert isinstance(plan, ArmPlan)
    faults = [HilCase(_limit(case, plan, motion)) for case in resolve(select(plan), motion)
              if case.fault is None or case.fault.kind not in REPLACED_FAULTS]  # fmt: skip
    kinds = [(lasting, error, link) for lasting in (True, False) for error in ERRORS for link in LINKS]
    errors = [_make_error(plan, motion, link, error, lasting, number) for number, (lasting, error, link) in enumerate(kinds)]
    return tuple(_interleave(faults, errors))


def list_kills(plan_path: Path, motion: Motion, count: int, seed: int) -> tuple[HilCase, ...]:
    """`count` kills of each process, at random instants of the motion."""
    plan = load_plan(plan_path)
    assert isinstance(plan, ArmPlan)
    source = random.Random(seed)
    cases = []
    for number in range(1, count + 1):
        for process in PROCESSES:
            at_s = round(source.uniform(0.0, motion.duration_s), 6)
            end_s = plan.motion_begins_at_s + motion.duration_s + AFTER_S
            arm = ArmCase(f"kill_{process}-{number}", f"kill_{process}", f"The {process} is killed", seed, {}, None, "", round(end_s / FRAME_S), AFTER_S,
                          STOPPED["drive"], plan.bounds)  # fmt: skip
            cases.append(HilCase(arm, kill=process, kill_at_s=plan.motion_begins_at_s + at_s))
    return tuple(cases)


def choose(cases: Sequence[HilCase], names: Sequence[str]) -> tuple[HilCase, ...]:
    """The cases with these ids or scenario names. @raise InputError for an unknown name."""
    known = sorted({name for case in cases for name in (case.id, case.arm.scenario)})
    for name in names:
        if name not in known:
            raise InputError(f"hil: unknown scenario '{name}'; {nearest_names(name, known)}; --list shows all")
    return tuple(case for case in cases if {case.id, case.arm.scenario} & set(names))


def _limit(case: ArmCase, plan: ArmPlan, motion: Motion) -> ArmCase:
    """A fault-free run has a number of frames, too."""
    if case.frames is not None:
        return case
    return replace(case, frames=round((plan.motion_begins_at_s + motion.duration_s + AFTER_S) / FRAME_S))


def _make_error(plan: ArmPlan, motion: Motion, link: str, error: str, lasting: bool, number: int) -> HilCase:
    at_s = round(round(ERRORS_AT[number % len(ERRORS_AT)] * motion.duration_s / FRAME_S) * FRAME_S, 6)
    fault = Fault(MESSAGE_FAULT, at_s, duration_s=None if lasting else FRAME_S)
    stops = error == "delay" or (lasting and error in STOPPING)
    word = "each" if lasting else "one"
    name = f"{error}_{link}{'' if lasting else '_once'}"
    arm = ArmCase(f"{name}-1", name, f"{error.capitalize()} of {word} message on the link {link}", plan.seed + number, {}, fault, "",
                  round((plan.motion_begins_at_s + at_s + AFTER_S) / FRAME_S), AFTER_S, STOPPED[link] if stops else UNDISTURBED,
                  plan.bounds)  # fmt: skip
    return HilCase(arm, link, error)


def _interleave(faults: Sequence[HilCase], errors: Sequence[HilCase]) -> list[HilCase]:
    """Alternating, the first case of each fault scenario before the others, so that a small number of cases covers many kinds."""
    ordered = sorted(faults, key=lambda case: int(case.id.rpartition("-")[2]))
    result: list[HilCase] = []
    for index in range(max(len(ordered), len(errors))):
        result += ordered[index : index + 1]
        result += errors[index : index + 1]
    return result
