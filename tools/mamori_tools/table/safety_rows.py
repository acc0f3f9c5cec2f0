# SPDX-License-Identifier: Apache-2.0
"""Rows of the safety layer in a system table, as checked rows.

@satisfies SWR-CYC-032      Design: docs/design/cost.md#schema
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from mamori_trace.base.json_node import JsonNode

CONFIRMATIONS = ("standstill", "closed_brakes", "torque_off")


@dataclass(frozen=True)
class Supervised:
    component: int | None
    late_cycles: int
    expired_cycles: int
    shortest_ns: int
    longest_ns: int
    checkpoints: int
    fault: int | None
    """None: the watchdog is not serviced while the component is late or expired."""


@dataclass(frozen=True)
class FaultConfirmation:
    fault: int | None
    cycles: int = 1
    """0: not by count."""
    decay: int = 0
    time_ns: int = 0
    """0: not by time."""
    healing_cycles: int = 1
    healing_ns: int = 0


@dataclass(frozen=True)
class StopSource:
    component: int | None
    port: str
    confirms: tuple[str, ...]


@dataclass(frozen=True)
class RepeatedTest:
    found_within_ns: int
    fault: int | None


@dataclass(frozen=True)
class Protection:
    component: int | None
    """The receiver."""
    profile: int
    fresh_within_ns: int
    lead_ns: int
    max_delta: int | None
    """Largest accepted step of the counter; None: stated at run time."""
    fault: int | None


@dataclass(frozen=True)
class Assumption:
    name: str
    within_ns: int


@dataclass(frozen=True)
class Cycle:
    ss2_within_ns: int
    ss1_within_ns: int
    brakes_close_within_ns: int
    brakes_have_contacts: bool
    watchdog_shortest_ns: int
    watchdog_longest_ns: int
    torque_feedback_ns: int
    lateness_max_ns: int
    late_reaction_fault: int | None
    self_test_fault: int | None
    unconfirmed_brakes_fault: int | None
    brakes_first: tuple[int, ...]
    """Faults whose STO waits for the brakes."""


@dataclass(frozen=True)
class Safety:
    cycle: Cycle
    supervised: tuple[Supervised, ...]
    confirmations: tuple[FaultConfirmation, ...]
    stop_sources: tuple[StopSource, ...]
    self_tests: tuple[RepeatedTest, ...]
    protections: tuple[Protection, ...]
    assumptions: tuple[Assumption, ...]


def read_safety(node: JsonNode, component_count: int) -> Safety | None:
    """@return None for a table of the kernel alone."""
    if node.is_none():
        return None
    return Safety(
        cycle=_read_cycle(node.at("cycle")),
        supervised=tuple(Supervised(**_read_numbers(row, Supervised), component=row.at("component").index_or_none(component_count))
                         for row in node.at("supervised").items()),
        protections=tuple(Protection(**_read_numbers(row, Protection), component=row.at("component").index_or_none(component_count),
                                     max_delta=row.at("max_delta").whole_or_none()) for row in node.at("protections").items()),
        assumptions=tuple(Assumption(row.at("name").text(), row.at("within_ns").whole()) for row in node.at("assumptions").items()),
        confirmations=tuple(FaultConfirmation(**_read_numbers(row, FaultConfirmation)) for row in node.at("confirmations").items()),
        stop_sources=tuple(StopSource(row.at("component").index_or_none(component_count), row.at("port").text(),
                                      tuple(item.text(CONFIRMATIONS) for item in row.at("confirms").items()))
                           for row in node.at("stop_sources").items()),
        self_tests=tuple(RepeatedTest(**_read_numbers(row, RepeatedTest)) for row in node.at("self_tests").items()),
    )  # fmt: skip


def _read_cycle(node: JsonNode) -> Cycle:
    return Cycle(**_read_numbers(node, Cycle), brakes_have_contacts=node.at("brakes_have_contacts").truth(),
                 brakes_first=tuple(item.count() for item in node.at("brakes_first").items()))  # fmt: skip


def _read_numbers(node: JsonNode, row: type) -> dict[str, Any]:
    """Integers of a row by the names of its fields; that of a fault may be null."""
    numbers: dict[str, Any] = {}
    for field in fields(row):
        if field.type == "int":
            numbers[field.name] = node.at(field.name).whole()
        elif field.name.endswith("fault"):
            numbers[field.name] = node.at(field.name).whole_or_none()
    return numbers
