# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori_tools.motion FILE --model M [-o OUT]`: checks a motion, shows it, writes the canonical table."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from mamori_tools.motion import ArmLimits, Motion, load_limits, read_motion, write_canonical
from mamori_trace.base.errors import InputError


def main(arguments: list[str] | None = None) -> int:
    """Returns 0, or 2 with one line on standard error for bad input."""
    parser = argparse.ArgumentParser(prog="python -m mamori_tools.motion",
                                     description="Checks a joint motion against an arm and shows its extremes.")
    parser.add_argument("file", type=Path, help="BodyMotion YAML, or a whitespace table: time [s] and joints [rad]")
    parser.add_argument("--model", type=Path, required=True, help="model file of the arm")
    parser.add_argument("-o", "--output", type=Path, help="write the canonical table here")
    options = parser.parse_args(arguments)
    try:
        limits = load_limits(options.model)
        motion = read_motion(options.file, limits)
        if options.output is not None:
            write_canonical(motion, options.output)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    print(summary(motion, limits))
    return 0


def summary(motion: Motion, limits: ArmLimits) -> str:
    """Summary of a motion for readers: length, and per joint the extremes with their limits."""
    speed = motion.get_speeds().max(axis=0)
    lines = [f"{motion.source_name}: {motion.duration_s:g} s, {len(motion.time_s)} samples, "
             f"{len(motion.joint_names)} joints"]
    lines += [f"note: {note}" for note in motion.notes]
    lines.append(f"{'joint':<12}{'position [rad]':>20}{'range [rad]':>20}{'top speed':>12}{'limit [rad/s]':>15}")
    for index, joint in enumerate(limits.joints):
        column = motion.position_rad[:, index]
        lines.append(f"{joint.name:<12}{f'{column.min():.3f} .. {column.max():.3f}':>20}"
                     f"{f'{joint.position_min_rad:.3f} .. {joint.position_max_rad:.3f}':>20}"
                     f"{speed[index]:>12.3f}{joint.motion_speed_rad_s:>15.3f}")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
