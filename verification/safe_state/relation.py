# SPDX-License-Identifier: Apache-2.0
"""Reads the step relation that `mamori_safe_state_relation` prints: the complete behaviour of the compiled machine.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#step-relation
"""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from mamori_trace.base.errors import InputError
from mamori_trace.base.json_node import JsonNode

SCHEMA = "mamori.safe_state/1"
INPUTS = ("demand", "self_test", "lock_out", "standstill", "faults_cleared", "start_permitted", "start_button", "reset_button",
          "brakes_failed", "time")  # fmt: skip
"""The names that the properties use, in the order of the digits of a letter."""
LEVELS = ("no", "yes")
VALUES = {
    "demand": ("None", "Degrade", "Ss2", "Ss1", "Sto", "Invalid"),
    "self_test": ("Running", "Passed", "Failed", "Invalid"),
    "time": ("BeforeEntry", "Within", "AtBound", "Beyond"),
    **dict.fromkeys(INPUTS[2:9], LEVELS),
}
SHAPE = tuple(len(VALUES[name]) for name in INPUTS)
LIMITS = ("none", "ss2_within", "ss1_within")
OUTPUTS = ("torque_enable", "brake_release", "stop_requested", "hold_requested")

Array = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Label:
    """What an external observer sees of a situation. `limit`: name of the time bound that affects its next step."""

    state: str
    is_consistent: bool
    limit: str
    outputs: tuple[bool, ...]

    @property
    def name(self) -> str:
        return self.state if self.is_consistent else f"{self.state} (corrupted)"

    def get(self, output: str) -> bool:
        return self.outputs[OUTPUTS.index(output)]


@dataclass(frozen=True)
class Relation:
    """`next` has the shape (situations, *SHAPE): the situation after each letter. Situation 0 is the one after power-up."""

    states: tuple[str, ...]
    events: tuple[str, ...]
    table: dict[tuple[str, str], str]
    labels: tuple[Label, ...]
    next: Array
    steps: int
    corrupted_objects: int


def run_program(program: Path) -> str:
    """The output of the program. @raise InputError if the program does not exist, or the machine has no step relation."""
    try:
        done = subprocess.run((str(program),), capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"cannot be run: {error.strerror}; run ./mamori build", program) from error
    if done.returncode != 0:
        raise InputError(f"ended with status {done.returncode}: {done.stderr.strip() or 'without a word'}", program)
    return done.stdout


def read_node(text: str, path: Path, schema: str, program: str) -> JsonNode:
    """Parses the output of `program`. @param path origin of the text, for messages. @raise InputError for another schema or invalid
    JSON."""
    remedy = f"print it again with {program}"
    try:
        node = JsonNode(path, "the relation", json.loads(text), remedy)
    except ValueError as error:
        raise InputError(f"not valid JSON: {error}; {remedy}", path) from error
    node.at("schema").text((schema,))
    return node


def read_relation(text: str, path: Path) -> Relation:
    """@param path origin of the text, for messages. @raise InputError for a text that is not a complete relation."""
    node = read_node(text, path, SCHEMA, "mamori_safe_state_relation")
    _check_inputs(node)
    states = tuple(item.text() for item in node.at("states").items())
    events = tuple(item.text() for item in node.at("events").items())
    situations = node.at("situations").items()
    return Relation(
        states,
        events,
        _read_table(node, states, events),
        tuple(_read_label(item, states) for item in situations),
        np.stack([_read_next(item, len(situations)) for item in situations]),
        node.at("steps").count(),
        node.at("corrupted_objects").count(),
    )


def _check_inputs(node: JsonNode) -> None:
    found = [(item.at("name").text(), tuple(value.text() for value in item.at("values").items()))
             for item in node.at("inputs").items()]  # fmt: skip
    wanted = [(name, VALUES[name]) for name in INPUTS]
    if found != wanted:
        raise node.at("inputs").complain(f"are {found}, the properties speak about {wanted}")


def _read_table(node: JsonNode, states: tuple[str, ...], events: tuple[str, ...]) -> dict[tuple[str, str], str]:
    rows = node.at("table").items()
    if len(rows) != len(states):
        raise node.at("table").complain(f"has {len(rows)} rows for {len(states)} states")
    table = {}
    for state, row in zip(states, rows, strict=True):
        cells = row.items()
        if len(cells) != len(events):
            raise row.complain(f"has {len(cells)} cells for {len(events)} events")
        table.update({(state, event): cell.text(states) for event, cell in zip(events, cells, strict=True)})
    return table


def _read_label(node: JsonNode, states: tuple[str, ...]) -> Label:
    outputs = node.at("outputs")
    return Label(node.at("state").text(states), node.at("is_consistent").truth(), node.at("limit").text(LIMITS),
                 tuple(outputs.at(name).truth() for name in OUTPUTS))  # fmt: skip


def _read_next(node: JsonNode, count: int) -> Array:
    numbers = [item.index(count) for item in node.at("next").items()]
    if len(numbers) != np.prod(SHAPE):
        raise node.at("next").complain(f"has {len(numbers)} answers for {np.prod(SHAPE)} combinations of inputs")
    return np.array(numbers, dtype=np.int64).reshape(SHAPE)
