# SPDX-License-Identifier: Apache-2.0
"""Reads the output of `mamori_brake_sequence_relation`: all results of the compiled brake sequence.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#brakes-in-the-models
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mamori_trace.base.json_node import JsonNode
from verification.safe_state.relation import OUTPUTS, Array, read_node

SCHEMA = "mamori.brake_sequence/1"
TIMES = ("BeforeCommand", "Within", "AtBound", "Beyond")
"""Classes of the time since the command to close; the bound is the closing time."""
BEFORE_COMMAND, WITHIN, AT_BOUND, BEYOND = range(4)
INVALID = "Invalid"
CONFIRM_LETTER = ("state", "standstill", "closed", "time")
CONFIRM_ANSWER = ("confirmed", "told_now", "next")
APPLY_LETTER = ("state", "time")
APPLY_ANSWER = (*OUTPUTS, "told_now", "next")


@dataclass(frozen=True)
class BrakeRelation:
    """`confirm` has the shape (situations, states, 2, 2, 4, 3), `apply` (situations, states, 4, 6), `overdue` and `closing` (situations, 4). The last
    axis of the first two holds the answers above. The last state represents all invalid numbers. `firsts`: the situations after power-up,
    with and without contacts. `fitted`: whether the brakes of each situation have contacts."""

    states: tuple[str, ...]
    confirm: Array
    apply: Array
    overdue: Array
    closing: Array
    firsts: tuple[int, int]
    fitted: tuple[bool, ...]
    calls: int


def read_brakes(text: str, path: Path) -> BrakeRelation:
    """@param path origin of the text, for messages. @raise InputError for a text that is not a complete relation."""
    node = read_node(text, path, SCHEMA, "mamori_brake_sequence_relation")
    for name, wanted in (("times", TIMES), ("confirm_letter", CONFIRM_LETTER), ("confirm_answer", CONFIRM_ANSWER),
                         ("apply_letter", APPLY_LETTER), ("apply_answer", APPLY_ANSWER)):  # fmt: skip
        found = tuple(item.text() for item in node.at(name).items())
        if found != wanted:
            raise node.at(name).complain(f"are {found}, the properties speak about {wanted}")
    states = tuple(item.text() for item in node.at("states").items())
    rows = node.at("situations").items()
    count, kinds = len(rows), len(states)
    confirm = np.stack([_read_calls(row.at("confirm"), count, (kinds, 2, 2, 4), len(CONFIRM_ANSWER)) for row in rows])
    apply = np.stack([_read_calls(row.at("apply"), count, (kinds, 4), len(APPLY_ANSWER)) for row in rows])
    overdue, closing = (np.stack([_read_levels(row.at(name)) for row in rows]) for name in ("overdue", "closing"))
    first = node.at("first")
    firsts = (first.at("with_contacts").index(count), first.at("without_contacts").index(count))
    fitted = _find_fitted(confirm, apply, firsts[0])
    if fitted[firsts[1]]:
        raise node.complain("says that brakes with contacts turn into brakes without")
    return BrakeRelation(states, confirm, apply, overdue, closing, firsts, fitted, node.at("calls").count())


def _read_calls(node: JsonNode, count: int, shape: tuple[int, ...], width: int) -> Array:
    """Results of one call in one situation: levels, and the number of the next situation."""
    answers = node.items()
    if len(answers) != np.prod(shape):
        raise node.complain(f"has {len(answers)} answers for {np.prod(shape)} calls")
    rows = []
    for answer in answers:
        cells = answer.items()
        if len(cells) != width:
            raise answer.complain(f"has {len(cells)} cells, wanted {width}")
        rows.append([*(cell.index(2) for cell in cells[:-1]), cells[-1].index(count)])
    return np.array(rows, dtype=np.int64).reshape(*shape, width)


def _read_levels(node: JsonNode) -> Array:
    levels = [item.index(2) for item in node.items()]
    if len(levels) != len(TIMES):
        raise node.complain(f"has {len(levels)} answers for {len(TIMES)} times")
    return np.array(levels, dtype=np.int64)


def _find_fitted(confirm: Array, apply: Array, first: int) -> tuple[bool, ...]:
    """For each situation, whether it is reachable from power-up with contacts."""
    reached = {first}
    while True:
        places = sorted(reached)
        grown = reached | set(np.unique(confirm[places][..., -1]).tolist()) | set(np.unique(apply[places][..., -1]).tolist())
        if len(grown) == len(reached):
            return tuple(number in reached for number in range(len(confirm)))
        reached = grown
