# SPDX-License-Identifier: Apache-2.0
"""Converts a selection to cases of the arm: instants and joints of a plan are resolved for one motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mamori_tools.campaign.arm.fault import FASTEST, Fault
from mamori_tools.campaign.arm.plan import ArmPlan, ArmScenario, Bounds, Expected
from mamori_tools.campaign.case import Case, Selection
from mamori_tools.motion import Motion

FRAME_S = 0.001
"""Major frame of the program under test [s]."""

SPEED_WINDOW_S = 0.1
"""The speed of a joint at an instant is its mean over this time from that instant on [s]."""

SEARCH_STEP_S = 0.01
"""Step of the search for an instant at which a joint moves [s]; also the minimum distance between two instants."""


@dataclass(frozen=True)
class ArmCase(Case):
    """One run: all its inputs, and all criteria for its evaluation.

    `fault` is None for a run without an injection; `latent` as in FaultSpec. `frames` is None if the program itself ends with the motion.
    `watch_s`: minimum duration of the run after the injection, or, without an injection, its minimum total duration [s].
    """

    fault: Fault | None
    latent: str
    frames: int | None
    watch_s: float
    expected: Expected
    bounds: Bounds


def resolve(selection: Selection, motion: Motion) -> tuple[ArmCase, ...]:
    """The cases for one motion. Raises InputError if the motion lacks an instant or a joint of the plan."""
    cases: list[ArmCase] = []
    plan = selection.plan
    assert isinstance(plan, ArmPlan)
    for scenario in selection.scenarios:
        assert isinstance(scenario, ArmScenario)
        if scenario.fault.kind == "none":
            cases.append(_make_case(plan, scenario, 1, None, motion))
            continue
        earliest_s = 0.0
        for number, instant in enumerate(scenario.instants[:selection.instants], start=1):
            asked_s = instant if scenario.in_seconds else instant * motion.duration_s
            fault = _place_fault(scenario, motion, max(asked_s, earliest_s))
            cases.append(_make_case(plan, scenario, number, fault, motion))
            earliest_s = fault.at_s + SEARCH_STEP_S
    return tuple(cases)


def _make_case(plan: ArmPlan, scenario: ArmScenario, number: int, fault: Fault | None, motion: Motion) -> ArmCase:
    end_s = plan.motion_begins_at_s + (0.0 if fault is None else fault.at_s) + plan.observe_s
    joint = "" if fault is None or fault.joint is None else str(fault.joint)
    return ArmCase(
        id=f"{scenario.name}-{number}",
        scenario=scenario.name,
        title=scenario.title.replace("{joint}", joint),
        fault=fault,
        latent=scenario.fault.latent,
        seed=plan.seed,
        frames=None if fault is None else math.ceil(round(end_s / FRAME_S, 6)),
        watch_s=plan.motion_begins_at_s + motion.duration_s if fault is None else plan.observe_s,
        expected=scenario.expected,
        bounds=plan.bounds,
        requirements=scenario.requirements,
    )


def _place_fault(scenario: ArmScenario, motion: Motion, asked_s: float) -> Fault:
    """Determines time and joint of a fault; the time is that of a frame."""
    spec = scenario.fault
    place_s, joint = asked_s, None
    if asked_s >= motion.duration_s:
        raise scenario.node.error(f"{scenario.name} begins at {asked_s:.3f} s, the motion lasts {motion.duration_s:.3f} s; "
                                  "choose an earlier instant")
    if spec.joint is not None:
        if isinstance(spec.joint, int) and spec.joint > len(motion.joint_names):
            raise scenario.node.error(f"{scenario.name} names joint {spec.joint}, the arm has {len(motion.joint_names)}")
        place_s, joint = _find_moving_joint(scenario, motion, asked_s)
    at_s = round(round(place_s / FRAME_S) * FRAME_S, 6)
    return Fault(spec.kind, at_s, joint, spec.channel, spec.magnitude, spec.duration_s)


def _find_moving_joint(scenario: ArmScenario, motion: Motion, asked_s: float) -> tuple[float, int]:
    """The first instant from `asked_s` on at which the joint moves fast enough, and the number of the joint from 1."""
    spec = scenario.fault
    least = spec.min_speed_rad_s or 0.0
    steps = max(1, math.ceil((motion.duration_s - asked_s) / SEARCH_STEP_S))
    for step in range(steps):
        place_s = asked_s + step * SEARCH_STEP_S
        speeds = motion.calc_mean_speed(place_s, place_s + SPEED_WINDOW_S)
        joint = int(np.argmax(speeds)) + 1 if spec.joint == FASTEST else int(spec.joint or 0)
        if speeds[joint - 1] >= least:
            return place_s, joint
    who = "no joint" if spec.joint == FASTEST else f"joint {spec.joint} never"
    raise scenario.node.error(f"{scenario.name}: {who} moves at {least:g} rad/s from {asked_s:.3f} s of "
                              f"{motion.source_name} on; choose an earlier instant or another motion")
