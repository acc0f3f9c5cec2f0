# SPDX-License-Identifier: Apache-2.0
"""The checks of every motion before execution. Pure functions from samples and limits to the first error."""

from __future__ import annotations

import numpy as np

from mamori_tools.motion.limits import ArmLimits
from mamori_tools.motion.motion import MAX_DURATION_S, Samples, calc_speeds
from mamori_trace.base.errors import InputError

SPEED_TOLERANCE = 1e-9
"""Permitted relative rounding excess of a speed, because speeds are quotients of differences of decimals."""


def check_samples(samples: Samples, limits: ArmLimits) -> None:
    """Raises InputError for the first error: too few samples, bad times, too long, position out of range, too fast."""
    if len(samples.rows) < 2:
        line = samples.lines[0] if samples.lines else 1
        raise InputError(f"{len(samples.rows)} sample(s), at least 2 make a motion; add samples", samples.path, line)
    time_s = np.array(samples.time_s)
    position_rad = np.array(samples.rows)
    _check_times(samples, time_s)
    _check_range(samples, position_rad, limits)
    _check_speed(samples, time_s, position_rad, limits)


def _check_times(samples: Samples, time_s: np.ndarray) -> None:
    bad = np.flatnonzero(np.diff(time_s) <= 0.0)
    if bad.size:
        after = int(bad[0]) + 1
        first, second = time_s[after - 1], time_s[after]
        what = "is repeated" if first == second else f"comes after {first:g} s"
        raise InputError(f"time {second:g} s (counted from the first sample) {what}; times must rise, sort the samples",
                         samples.path, samples.lines[after])
    if time_s[-1] > MAX_DURATION_S:
        late = int(np.searchsorted(time_s, MAX_DURATION_S, side="right"))
        raise InputError(f"motion lasts {time_s[-1]:g} s, limit {MAX_DURATION_S:g} s; cut it into parts",
                         samples.path, samples.lines[late])


def _check_range(samples: Samples, position_rad: np.ndarray, limits: ArmLimits) -> None:
    lowest = np.array([joint.position_min_rad for joint in limits.joints])
    highest = np.array([joint.position_max_rad for joint in limits.joints])
    outside = np.argwhere((position_rad < lowest) | (position_rad > highest))
    if outside.size:
        sample, joint = (int(index) for index in outside[0])
        raise InputError(f"joint {joint + 1} ({limits.joints[joint].name}) at {position_rad[sample, joint]:.6g} rad, "
                         f"range {lowest[joint]:.6g} to {highest[joint]:.6g} rad; keep the motion inside",
                         samples.path, samples.lines[sample])


def _check_speed(samples: Samples, time_s: np.ndarray, position_rad: np.ndarray, limits: ArmLimits) -> None:
    speed = calc_speeds(time_s, position_rad)
    allowed = np.array([joint.motion_speed_rad_s for joint in limits.joints])
    fast = np.argwhere(speed > allowed * (1.0 + SPEED_TOLERANCE))
    if fast.size:
        step, joint = (int(index) for index in fast[0])
        distance = abs(position_rad[step + 1, joint] - position_rad[step, joint])
        raise InputError(f"joint {joint + 1} ({limits.joints[joint].name}) steps {distance:.6g} rad in "
                         f"{time_s[step + 1] - time_s[step]:.6g} s = {speed[step, joint]:.6g} rad/s, "
                         f"limit {allowed[joint]:.6g} rad/s; slow the motion down or remove the step",
                         samples.path, samples.lines[step + 1])
