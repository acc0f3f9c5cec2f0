# SPDX-License-Identifier: Apache-2.0
"""A fault as data, in the form of the plan and in the form of the program argument."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from mamori_trace.base.marked_yaml import Node
from mamori_trace.base.nearest_names import nearest_names

FASTEST = "fastest"
CHANNELS = ("a", "b", "both")

_AGREE_S = 0.0005
"""A time in run.json agrees with the requested time if they differ by at most half of a frame of 1 ms [s]."""


@dataclass(frozen=True)
class Uses:
    """The parameters of a kind of fault."""

    joint: bool = False
    channel: bool = False
    magnitude: bool = False


KINDS: Mapping[str, Uses] = {
    "none": Uses(),
    "encoder_freeze": Uses(joint=True, channel=True),
    "encoder_bit_flip": Uses(joint=True, channel=True, magnitude=True),
    "encoder_bias": Uses(joint=True, channel=True, magnitude=True),
    "torque_runaway": Uses(joint=True, magnitude=True),
    "brake_fade": Uses(joint=True, magnitude=True),
    "power_loss": Uses(),
    "controller_hang": Uses(),
    "message_lost": Uses(),
    "message_late": Uses(magnitude=True),
    "supervisor_hang": Uses(),
    "brake_stuck_open": Uses(joint=True),
    "brakes_stuck_open": Uses(),
    "sto_ignored": Uses(),
    "relay_stuck": Uses(),
    "processor_stops": Uses(),
    "emergency_stop": Uses(channel=True),
    "protective_stop": Uses(channel=True),
    "brake_creep": Uses(joint=True, magnitude=True),
    "enabling_released": Uses(channel=True),
    "enabling_squeezed": Uses(),
    "run_released": Uses(),
    "reduced_speed": Uses(),
    "hold_to_run": Uses(),
    "start_stuck": Uses(),
    "reset_stuck": Uses(),
    "message_damaged": Uses(magnitude=True),
    "controller_wrong": Uses(magnitude=True),
    "encoder_drift": Uses(joint=True, channel=True, magnitude=True),
    "clock_wrong": Uses(magnitude=True),
}
LATENT_KINDS = ("brake_stuck_open", "brakes_stuck_open", "brake_fade", "sto_ignored", "relay_stuck", "start_stuck", "reset_stuck",
                "reduced_speed", "hold_to_run")  # fmt: skip

_KEYS = frozenset({"kind", "joint", "channel", "magnitude", "duration_s", "min_speed_rad_s", "latent"})


@dataclass(frozen=True)
class FaultSpec:
    """A fault of the plan. `joint` is 1 .. n or FASTEST: the joint whose reference moves fastest at the injection.

    `min_speed_rad_s`: the injection waits until that joint reaches this speed; None: no waiting.
    `duration_s`: None means until the end of the run.
    `latent`: a second fault, or an operating mode, that shows nothing by itself, as `kind` or `kind:joint`; empty: none. A mode is present
    since power-up; a fault since the start of the motion, or, with the kind `none`, since power-up.
    """

    kind: str
    joint: int | str | None = None
    channel: str | None = None
    magnitude: float | None = None
    duration_s: float | None = None
    min_speed_rad_s: float | None = None
    latent: str = ""


@dataclass(frozen=True)
class Fault:
    """A fault that is ready for injection: joint and time are known. `at_s` counts from the start of the motion [s]."""

    kind: str
    at_s: float
    joint: int | None = None
    channel: str | None = None
    magnitude: float | None = None
    duration_s: float | None = None

    def to_text(self) -> str:
        """The argument `--fault` of the program."""
        parts = {"kind": self.kind, "joint": self.joint, "channel": self.channel, "at": self.at_s,
                 "duration": self.duration_s, "magnitude": self.magnitude}  # fmt: skip
        return ",".join(f"{key}={value}" for key, value in parts.items() if value is not None)

    def find_difference(self, written: Mapping[str, Any] | None) -> str:
        """The difference between the fault in run.json and this one; empty if they agree. Values that were not requested must be absent: a
        fault that should last until the end but ended early is a different fault."""
        if written is None:
            return "no fault was injected"
        wanted = {"kind": self.kind, "joint": self.joint, "channel": self.channel, "motion_at_s": self.at_s,
                  "duration_s": self.duration_s, "magnitude": self.magnitude}  # fmt: skip
        for key, value in wanted.items():
            if not _agrees(value, written.get(key), key):
                return f"{key} {written.get(key)}"
        return ""


def read_fault(node: Node) -> FaultSpec:
    """Reads the `fault` of a scenario. Raises InputError with file and line."""
    entries = node.as_mapping(_KEYS)
    kind = node.get("kind").as_text()
    if kind not in KINDS:
        raise node.get("kind").error(f"unknown kind of fault '{kind}'; {nearest_names(kind, KINDS)}")
    uses = KINDS[kind]
    for key, used in (("joint", uses.joint), ("channel", uses.channel), ("magnitude", uses.magnitude)):
        if used and key not in entries:
            raise node.error(f"{kind} needs '{key}'; add it")
        if not used and key in entries:
            raise entries[key].error(f"{kind} takes no {key}; remove it")
    if "min_speed_rad_s" in entries and not uses.joint:
        raise entries["min_speed_rad_s"].error(f"{kind} has no joint that could move; remove it")
    if "duration_s" in entries and kind == "none":
        raise entries["duration_s"].error("none takes no duration; remove it")
    return FaultSpec(
        kind,
        _read_joint(entries["joint"]) if uses.joint else None,
        _read_channel(entries["channel"]) if uses.channel else None,
        entries["magnitude"].as_float() if uses.magnitude else None,
        read_positive(entries["duration_s"]) if "duration_s" in entries else None,
        read_positive(entries["min_speed_rad_s"]) if "min_speed_rad_s" in entries else None,
        _read_latent(entries["latent"]) if "latent" in entries else "",
    )


def _read_latent(node: Node) -> str:
    text = node.as_text()
    kind, _, joint = text.partition(":")
    if kind not in LATENT_KINDS:
        raise node.error(f"unknown latent fault '{kind}'; {nearest_names(kind, LATENT_KINDS)}")
    if KINDS[kind].joint != joint.isdecimal():
        need = f"needs a joint, for example {kind}:2" if KINDS[kind].joint else "takes no joint"
        raise node.error(f"'{text}': {kind} {need}")
    return text


def read_positive(node: Node) -> float:
    """A finite number above 0. Raises InputError."""
    number = node.as_float()
    if number <= 0.0:
        raise node.error(f"{number:g}; write a number above 0")
    return number


def _read_joint(node: Node) -> int | str:
    if node.as_text() == FASTEST:
        return FASTEST
    joint = node.as_int()
    if joint < 1:
        raise node.error(f"{joint}; joints count from 1, or write '{FASTEST}'")
    return joint


def _read_channel(node: Node) -> str:
    channel = node.as_text()
    if channel not in CHANNELS:
        raise node.error(f"unknown channel '{channel}'; {nearest_names(channel, CHANNELS)}")
    return channel


def _agrees(wanted: object, written: object, key: str) -> bool:
    if isinstance(wanted, float) and isinstance(written, (int, float)) and not isinstance(written, bool):
        return abs(wanted - written) <= (_AGREE_S if key == "motion_at_s" else 1e-9)
    return wanted == written
