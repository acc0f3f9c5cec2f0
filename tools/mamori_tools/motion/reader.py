# SPDX-License-Identifier: Apache-2.0
"""Reads a motion file of either kind and checks it against the limits of an arm."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mamori_tools.motion.body_motion import read_body_motion
from mamori_tools.motion.checks import check_samples
from mamori_tools.motion.limits import ArmLimits
from mamori_tools.motion.motion import Motion
from mamori_tools.motion.table import read_table
from mamori_trace.base.text_file import SourceText, read_text

_YAML_SUFFIXES = frozenset({".yaml", ".yml", ".seq"})


def read_motion(path: Path | str, limits: ArmLimits) -> Motion:
    """Reads and checks a motion. Raises InputError with one line, including file and line number, for the first error."""
    source = read_text(path, "motion file")
    if is_body_motion(source):
        samples = read_body_motion(source, len(limits.joints), limits.ignored_columns)
    else:
        samples = read_table(source, len(limits.joints), limits.ignored_columns)
    check_samples(samples, limits)
    return Motion(source.path.name, source.sha256, tuple(joint.name for joint in limits.joints),
                  np.array(samples.time_s), np.array(samples.rows), tuple(samples.notes))


def is_body_motion(source: SourceText) -> bool:
    """True for a YAML suffix, or if the first non-comment line looks like YAML."""
    if source.path.suffix.lower() in _YAML_SUFFIXES:
        return True
    for line in source.text.split("\n"):
        text = line.split("#", 1)[0].strip()
        if text:
            return ":" in text or text.startswith(("%YAML", "---"))
    return False
