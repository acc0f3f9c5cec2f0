# SPDX-License-Identifier: Apache-2.0
"""The plan of the arm: faults, times, and expected results. Data in a YAML file, checked as a whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.campaign.arm.fault import FaultSpec, read_fault, read_positive
from mamori_tools.campaign.arm.vocabulary import DETECTED_FAULTS, NOTHING, REACTIONS, STATES, STOPS
from mamori_tools.campaign.case import Plan, Scenario
from mamori_tools.campaign.plan_parts import read_name, read_requirements, read_scenario_name, read_scenarios, read_seed
from mamori_trace.base.marked_yaml import Node

SUBJECT_NAME = "arm"

_TOP_KEYS = frozenset({"schema", "subject", "seed", "instants", "motion_begins_at_s", "observe_s", "bounds", "scenarios"})
_BOUND_KEYS = frozenset({"hold_drift_rad", "hold_observed_s", "tracking_error_rad"})
_SCENARIO_KEYS = frozenset({"name", "title", "fault", "at", "at_s", "expected", "requirements"})
_EXPECTED_KEYS = frozenset({"state", "reaction", "detected_fault", "within_s", "watchdog_bitten", "operational"})


@dataclass(frozen=True)
class Bounds:
    """Physical bounds for every case.

    `hold_drift_rad`: maximum movement after standstill [rad]; `hold_observed_s`: minimum observation time of standstill [s];
    `tracking_error_rad`: upper bound of the tracking error of an undisturbed motion [rad].
    """

    hold_drift_rad: float
    hold_observed_s: float
    tracking_error_rad: float


@dataclass(frozen=True)
class Expected:
    """The expected result of a case. `within_s` is None exactly if no reaction is expected. `operational`: the machine starts."""

    state: str
    reactions: tuple[str, ...]
    detected_faults: tuple[str, ...]
    within_s: float | None
    watchdog_bitten: bool | None = None
    operational: bool = True

    @property
    def wants_reaction(self) -> bool:
        return self.reactions != (NOTHING,)

    @property
    def wants_stop(self) -> bool:
        return STOPS.issuperset(self.reactions)


@dataclass(frozen=True)
class ArmScenario(Scenario):
    """One row of the plan. `instants` are fractions of the motion, or seconds if `in_seconds`."""

    fault: FaultSpec
    instants: tuple[float, ...]
    in_seconds: bool
    expected: Expected

    @property
    def case_count(self) -> int:
        return max(1, len(self.instants))


@dataclass(frozen=True)
class ArmPlan(Plan):
    """A complete plan. Times in seconds: `motion_begins_at_s` since the start of a run, `observe_s` since the injection."""

    scenarios: tuple[ArmScenario, ...]
    motion_begins_at_s: float
    observe_s: float
    bounds: Bounds


def read_plan(root: Node, path: Path) -> ArmPlan:
    """Raises InputError with one line, including file and line number, for the first error."""
    root.as_mapping(_TOP_KEYS)
    bounds = root.get("bounds")
    bounds.as_mapping(_BOUND_KEYS)
    instants = _read_fractions(root.get("instants"))
    return ArmPlan(
        path,
        SUBJECT_NAME,
        read_seed(root.get("seed")),
        read_scenarios(root, lambda node: _read_scenario(node, instants)),
        _read_not_negative(root.get("motion_begins_at_s")),
        read_positive(root.get("observe_s")),
        Bounds(*(read_positive(bounds.get(key)) for key in ("hold_drift_rad", "hold_observed_s", "tracking_error_rad"))),
    )


def _read_scenario(node: Node, usual_instants: tuple[float, ...]) -> ArmScenario:
    entries = node.as_mapping(_SCENARIO_KEYS)
    name = read_scenario_name(node)
    fault = read_fault(node.get("fault"))
    times = [key for key in ("at", "at_s") if key in entries]
    if len(times) > 1 or (times and fault.kind == "none"):
        raise entries[times[-1]].error("a scenario has 'at' or 'at_s', and none where nothing is injected")
    if fault.kind == "none":
        instants: tuple[float, ...] = ()
    elif "at_s" in entries:
        instants = _read_instants(entries["at_s"], None)
    else:
        instants = _read_fractions(entries["at"]) if "at" in entries else usual_instants
    expected = _read_expected(node.get("expected"))
    if fault.kind == "none" and expected.wants_reaction:
        raise node.get("expected").error(f"a reaction without a fault is a false trip; write reaction: [{NOTHING}]")
    return ArmScenario(
        name, node.get("title").as_text(), read_requirements(node.get("requirements")), node,
        fault, instants, "at_s" in entries, expected,
    )  # fmt: skip


def _read_expected(node: Node) -> Expected:
    entries = node.as_mapping(_EXPECTED_KEYS)
    state = read_name(node.get("state"), STATES)
    reactions = _read_names(node.get("reaction"), REACTIONS)
    faults = _read_names(node.get("detected_fault"), DETECTED_FAULTS)
    bitten = entries["watchdog_bitten"].as_bool() if "watchdog_bitten" in entries else None
    if (reactions == (NOTHING,)) == ("within_s" in entries):
        raise node.error("'within_s' belongs to a case with a reaction, and only there")
    within_s = read_positive(entries["within_s"]) if "within_s" in entries else None
    operational = entries["operational"].as_bool() if "operational" in entries else True
    return Expected(state, reactions, faults, within_s, bitten, operational)


def _read_names(node: Node, known: Sequence[str]) -> tuple[str, ...]:
    names = tuple(read_name(item, known) for item in node.as_list())
    if not names:
        raise node.error(f"is empty; name at least one, or [{NOTHING}]")
    if NOTHING in names and len(names) > 1:
        raise node.error(f"'{NOTHING}' stands alone; a verdict that allows both says nothing")
    return names


def _read_fractions(node: Node) -> tuple[float, ...]:
    return _read_instants(node, 1.0)


def _read_instants(node: Node, end: float | None) -> tuple[float, ...]:
    """Increasing numbers from 0, below `end` if it is given."""
    instants: list[float] = []
    for item in node.as_list():
        instant = _read_not_negative(item)
        if end is not None and instant >= end:
            raise item.error(f"{instant:g}; a fraction of the motion is below {end:g} (seconds: use 'at_s')")
        if instants and instant <= instants[-1]:
            raise item.error(f"{instant:g} after {instants[-1]:g}; write instants that rise")
        instants.append(instant)
    if not instants:
        raise node.error("is empty; write at least one instant")
    return tuple(instants)


def _read_not_negative(node: Node) -> float:
    number = node.as_float()
    if number < 0.0:
        raise node.error(f"{number:g}; write 0 or more")
    return number
