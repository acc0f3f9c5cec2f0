# SPDX-License-Identifier: Apache-2.0
"""The data of the readers: unchanged samples of the file, and the checked motion."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

MAX_DURATION_S = 600.0
"""Maximum duration of a motion [s]."""

MAX_SAMPLES = 1_000_000
"""Maximum number of samples: the longest motion at more than 1.6 kHz."""


@dataclass
class Samples:
    """Content of a file before the check against an arm. One entry per sample in `lines`, `time_s`, `rows`."""

    path: Path
    sha256: str
    lines: list[int] = field(default_factory=list)
    time_s: list[float] = field(default_factory=list)
    rows: list[list[float]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Motion:
    """A joint motion that was checked against the limits of an arm; `read_motion` creates it.

    `time_s` [s], shape (samples,), starts at 0 and increases. `position_rad` [rad], shape (samples, joints).
    """

    source_name: str
    source_sha256: str
    joint_names: tuple[str, ...]
    time_s: np.ndarray
    position_rad: np.ndarray
    notes: tuple[str, ...] = ()

    @property
    def duration_s(self) -> float:
        return float(self.time_s[-1])

    def get_speeds(self) -> np.ndarray:
        """Speed of each step [rad/s], never negative, shape (samples - 1, joints)."""
        return calc_speeds(self.time_s, self.position_rad)

    def calc_mean_speed(self, start_s: float, end_s: float) -> np.ndarray:
        """Distance between the positions at two instants divided by the elapsed time [rad/s], shape (joints,).

        Positions are interpolated; before the start and after the end the motion is at rest.
        """
        ends = [np.interp([start_s, end_s], self.time_s, joint) for joint in self.position_rad.T]
        return np.array([abs(late - early) / (end_s - start_s) for early, late in ends])


def calc_speeds(time_s: np.ndarray, position_rad: np.ndarray) -> np.ndarray:
    """Speed of each step [rad/s], shape (samples - 1, joints)."""
    return np.abs(np.diff(position_rad, axis=0)) / np.diff(time_s)[:, np.newaxis]
