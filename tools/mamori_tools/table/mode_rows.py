# SPDX-License-Identifier: Apache-2.0
"""Modes, transitions, parameters and configuration sets of a system table as checked rows.

@satisfies SWR-TAB-010, SWR-TAB-013      Design: docs/design/cost.md#schema
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_tools.profiles.constraint_parser import ConstraintError, parse_constraint
from mamori_tools.profiles.scalar_type import DOUBLE, ScalarType
from mamori_trace.base.json_node import JsonNode

TYPES = {"real": DOUBLE, "whole": ScalarType("integer", -(2**63), 2**64 - 1)}
Values = tuple[float | int | None, ...]
"""One value for each element; None: a number that JSON cannot represent."""


@dataclass(frozen=True)
class Reference:
    """A reference to another row."""

    index: int | None
    """None if there is no such row."""
    name: str


@dataclass(frozen=True)
class Mode:
    name: str
    safe: bool
    initial: bool
    components: tuple[int | None, ...]
    """Running components; None: a component that is not in the table."""
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
    """In canonical form if the type is known."""
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
    kind, values = None if node.at("type").is_none() else node.at("type").text(tuple(TYPES)), _read_values(node.at("values"))
    return Parameter(_read_reference(node.at("owner"), component_count), node.at("name").text(), kind,
                     _read_constraint(node.at("constraint"), kind, len(values or ())), values)  # fmt: skip


def read_set(node: JsonNode, parameter_count: int) -> ConfigurationSet:
    rows = node.at("assignments").items_or_none()
    if rows is None:
        return ConfigurationSet(node.at("name").text(), None)
    assignments = (Assignment(_read_reference(row.at("parameter"), parameter_count), _read_values(row.at("values"))) for row in rows)
    return ConfigurationSet(node.at("name").text(), tuple(assignments))


def _read_reference(node: JsonNode, size: int) -> Reference:
    return Reference(node.at("index").index_or_none(size), node.at("name").text())


def _read_constraint(node: JsonNode, kind: str | None, element_count: int) -> str:
    text = node.text()
    if kind is None or element_count == 0:
        return text
    try:
        return parse_constraint(text, TYPES[kind], element_count).format_canonical()
    except ConstraintError as error:
        raise node.complain(f"is {text!r}: {error}") from error


def _read_values(node: JsonNode) -> Values | None:
    items = node.items_or_none()
    return None if items is None else tuple(item.number_or_none() for item in items)
