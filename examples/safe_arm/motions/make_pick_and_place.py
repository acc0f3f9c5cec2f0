# SPDX-License-Identifier: Apache-2.0
"""Makes pick_and_place.yaml: the arm reaches down, lifts, swings over, puts down and returns.

    python make_pick_and_place.py > pick_and_place.yaml

Between two poses each joint follows the minimum-jerk polynomial (speed and acceleration are zero at both ends; the top
speed is 15/8 of distance over time): Flash and Hogan, J. Neuroscience 5 (1985), 1688-1703. Every joint moves in every
part, so that a frozen encoder of any joint can be seen.
"""

from __future__ import annotations

import sys

FRAME_RATE_HZ = 200
DIGITS = 6

REST_S = 0.2
"""The motion begins and ends with this rest [s]."""

START_RAD = (0.00, 0.30, 0.00, 0.90, 0.00, 0.60, 0.00)

PARTS = (  # time to get there [s], pose [rad]
    (1.4, (-0.40, 0.60, 0.30, 1.15, 0.60, 0.20, -0.80)),  # over the part
    (1.2, (-0.25, 0.90, 0.00, 0.80, 0.20, 0.60, -0.20)),  # down at the part
    (1.2, (-0.45, 0.58, 0.35, 1.15, 0.70, 0.15, -0.90)),  # lifted
    (1.8, (0.10, 0.85, -0.30, 0.75, -0.30, 0.70, 0.40)),  # swung over and down at the place
    (1.8, START_RAD),  # back
)


def calc_blend(fraction: float) -> float:
    """Minimum-jerk progress, 0 .. 1, at `fraction` 0 .. 1 of the time."""
    return fraction**3 * (10.0 + fraction * (-15.0 + 6.0 * fraction))


def make_frames() -> list[tuple[float, ...]]:
    """All poses [rad], one per frame."""
    rest = round(REST_S * FRAME_RATE_HZ)
    frames: list[tuple[float, ...]] = [START_RAD] * rest
    begin = START_RAD
    for duration_s, end in PARTS:
        steps = round(duration_s * FRAME_RATE_HZ)
        for step in range(steps):
            blend = calc_blend(step / steps)
            frames.append(tuple(a + blend * (b - a) for a, b in zip(begin, end, strict=True)))
        begin = end
    frames += [START_RAD] * (rest + 1)
    return frames


def make_text() -> str:
    """The file's text: BodyMotion, first format."""
    frames = make_frames()
    lines = ["# SPDX-License-Identifier: Apache-2.0",
             "# Made by make_pick_and_place.py; do not edit.",
             "type: BodyMotion",
             "components:",
             "  -",
             "    type: MultiValueSeq",
             "    content: JointPosition",
             f"    frameRate: {FRAME_RATE_HZ}",
             f"    numFrames: {len(frames)}",
             f"    numParts: {len(START_RAD)}",
             "    frames:"]
    # Adding 0.0 turns a rounded -0.0 into 0.0.
    lines += [f"      - [ {', '.join(f'{round(value, DIGITS) + 0.0}' for value in frame)} ]" for frame in frames]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(make_text())
