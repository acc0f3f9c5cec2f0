# SPDX-License-Identifier: Apache-2.0
"""An arm for the tests: seven joints with round limits. Its tables may have two additional columns."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.motion import ArmLimits, load_limits

JOINT = "  - {{name: J{joint}, position_range_rad: {{value: [-2.0, 2.0], source: test}}, speed_limit_rad_s: {speed}}}\n"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Motion limits: J1 0.8 x 1 rad/s, J2 0.8 x 2 rad/s, and so on."""
    path = tmp_path / "arm.yaml"
    joints = "".join(JOINT.format(joint=joint, speed=f"{{value: {joint}, assumption: test}}") for joint in range(1, 8))
    path.write_text(f"motion_columns_ignored: {{value: 2, source: fingers}}\njoints:\n{joints}")
    return path


@pytest.fixture
def limits(model: Path) -> ArmLimits:
    return load_limits(model)
