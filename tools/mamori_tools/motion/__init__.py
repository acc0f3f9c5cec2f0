# SPDX-License-Identifier: Apache-2.0
"""Joint motions: reads BodyMotion files and whitespace tables, checks them against an arm, writes one canonical table.

    limits = load_limits(Path("pa10_like.yaml"))
    motion = read_motion(Path("walk.yaml"), limits)      # InputError: one line with file and line number
    write_canonical(motion, Path("motion.txt"))

@satisfies SWR-MOT-001, SWR-MOT-002, SWR-MOT-003, SWR-MOT-004, SWR-MOT-005, SWR-MOT-006, SWR-MOT-007, SWR-MOT-008, SWR-MOT-009
Design: docs/design/simulation.md#motion-formats
"""

from mamori_tools.motion.canonical import canonical_text, write_canonical
from mamori_tools.motion.limits import ArmLimits, JointLimits, load_limits
from mamori_tools.motion.motion import Motion
from mamori_tools.motion.reader import read_motion

__all__ = ["ArmLimits", "JointLimits", "Motion", "canonical_text", "load_limits", "read_motion", "write_canonical"]
