# SPDX-License-Identifier: Apache-2.0
"""Modes, transitions, parameters and configuration sets of a system table as checked rows.

@satisfies SWR-TAB-010, SWR-TAB-013      Design: docs/design/cost.md#schema
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.json_node import JsonNode

TYPES = ("real", "whole")
Values = tuple[float | int | None, ...]
"""One for each element; None: no number that JSON has."""


@dataclass(frozen=True)
class Reference:
    """A reference to another row."""

    index: int | None
    """None: there is no such row."""
    name: str


@dataclass(frozen=True)
class Mode:
    name: str
    safe: bool
    initial: bool
    components: tuple[int | None, ...]
    """Those that run; None: one that the table does not know."""
    set: Reference | None


@dataclass(frozen=True)
class Transition:
    source: Reference
    event: int
    event_name: str
    target: Reference


@dataclass(frozen=True)
class Parameter:
    owner: Reference
    name: str
    type: str | None
    constraint: str
    values: Values | None


@dataclass(frozen=True)
class Assignment:
    parameter: Reference
    values: Values | None


@dataclass(frozen=True)
class ConfigurationSet:
    name: str
    assignments: tuple[Assignment, ...] | None


def read_mode(node: JsonNode, component_count: int, set_count: int) -> Mode:
    running = tuple(item.index_or_none(component_count) for item in node.at("components").items())
    active = node.at("set")
    return Mode(node.at("name").text(), node.at("safe").truth(), node.at("initial").truth(), running,
                None if active.is_none() else _read_reference(active, set_count))  # fmt: skip


def read_transition(node: JsonNode, mode_count: int) -> Transition:
    return Transition(_read_reference(node.at("from"), mode_count), node.at("event").count(), node.at("event_name").text(),
                      _read_reference(node.at("to"), mode_count))  # fmt: skip


def read_parameter(node: JsonNode, component_count: int) -> Parameter:
    kind = node.at("type")
    return Parameter(_read_reference(node.at("owner"), component_count), node.at("name").text(),
                     None if kind.is_none() else kind.text(TYPES), node.at("constraint").text(), _read_values(node.at("values")))  # fmt: skip


def read_set(node: JsonNode, parameter_count: int) -> ConfigurationSet:
    rows = node.at("assignments").items_or_none()
    if rows is None:
        return ConfigurationSet(node.at("name").text(), None)
    assignments = (Assignment(_read_reference(row.at("parameter"), parameter_count), _read_values(row.at("values"))) for row in rows)
    return ConfigurationSet(node.at("name").text(), tuple(assignments))


def _read_reference(node: JsonNode, size: int) -> Reference:
    return Reference(node.at("index").index_or_none(size), node.at("name").text())


def _read_values(node: JsonNode) -> Values | None:
    items = node.items_or_none()
    return None if items is None else tuple(item.number_or_none() for item in items)
