# SPDX-License-Identifier: Apache-2.0
"""The limits of a motion, read from the model file of the arm. Only this module of the package uses the keys of that file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.marked_yaml import Node, load

OPERATING_FRACTION = 0.8
"""Share of the mechanical speed limit that a motion may use if the model has no `motion_speed_limit_rad_s`.

The rest is for the controller: tracking a motion at the full limit would exceed the limit.
"""

OPERATING_MARGIN_RAD = 0.1
"""Minimum distance of a motion from the mechanical end of a joint: a guard stops the arm before the end stop."""


@dataclass(frozen=True)
class JointLimits:
    """Limits of one joint: permitted positions of a motion [rad] and maximum speed of a motion [rad/s]."""

    name: str
    position_min_rad: float
    position_max_rad: float
    motion_speed_rad_s: float


@dataclass(frozen=True)
class ArmLimits:
    """Limits of an arm. In a table, `ignored_columns` additional columns may follow the joints; they are ignored."""

    model: Path
    joints: tuple[JointLimits, ...]
    ignored_columns: int


def load_limits(model: Path | str) -> ArmLimits:
    """Reads the limits from a model file. Raises InputError with file and line for a missing or invalid limit."""
    root = load(model, "model file")
    joints = root.get("joints").as_list()
    if not joints:
        raise root.get("joints").error("lists no joint; add them")
    ignored = _ignored_columns(root)
    return ArmLimits(Path(model), tuple(_joint(node) for node in joints), ignored)


def _joint(node: Node) -> JointLimits:
    name = node.get("name").as_text()
    ends = _value(node.get("position_range_rad"))
    bounds = [end.as_float() for end in ends.as_list()]
    if len(bounds) != 2 or not bounds[0] + 2.0 * OPERATING_MARGIN_RAD < bounds[1]:
        raise ends.error(f"joint {name} needs two numbers [lowest, highest] in rad, more than {2.0 * OPERATING_MARGIN_RAD:g} apart")
    entries = node.as_mapping()
    if "motion_speed_limit_rad_s" in entries:
        speed = _positive(entries["motion_speed_limit_rad_s"], name)
    else:
        speed = OPERATING_FRACTION * _positive(node.get("speed_limit_rad_s"), name)
    return JointLimits(name, bounds[0] + OPERATING_MARGIN_RAD, bounds[1] - OPERATING_MARGIN_RAD, speed)


def _positive(node: Node, joint: str) -> float:
    number = _value(node).as_float()
    if number <= 0.0:
        raise node.error(f"joint {joint} has {number:g}; write a positive speed in rad/s")
    return number


def _ignored_columns(root: Node) -> int:
    """`motion_columns_ignored` is a count or a list of names; default: none."""
    entries = root.as_mapping()
    if "motion_columns_ignored" not in entries:
        return 0
    node = _value(entries["motion_columns_ignored"])
    if isinstance(node.value, list):
        return len(node.value)
    count = node.as_int()
    if count < 0:
        raise node.error(f"{count} columns; write 0 or more")
    return count


def _value(node: Node) -> Node:
    """The value of a figure that may name its source: `{value: .., source: ..}` or only the value."""
    return node.get("value") if isinstance(node.value, dict) else node
