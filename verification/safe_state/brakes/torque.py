# SPDX-License-Identifier: Apache-2.0
"""Reads the output of `mamori_safety_cycle_relation`: when the compiled safety cycle keeps torque that its machine and brakes do not give.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#the-cycle-in-the-models
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from verification.safe_state.relation import Array, read_node

SCHEMA = "mamori.safety_cycle/1"
LETTER = ("state", "own_torque", "closing", "had_torque", "can_hold", "sto_cause", "torque")
CAUSES = ("None", "BrakesFirst", "Other")
"""Why STO is demanded: it is not, only by faults declared by brakes_first, or by any other fault."""
UNKNOWN = 2
BRAKES_FIRST, OTHER = 1, 2
Hold = tuple[int, int]
"""Whether torque can hold the machine without its brakes, and the index of the cause of STO."""


@dataclass(frozen=True)
class Torque:
    """`after` has the shape (states, 2, 2, 2, 2, 3), in the order of LETTER: the torque, or UNKNOWN if the compiled cycle never had that
    letter. `situations` and `cycles`: how many were executed."""

    states: tuple[str, ...]
    after: Array
    situations: int
    cycles: int

    def calc(self, state: str, is_own: bool, is_closing: bool, had_torque: bool, hold: Hold) -> bool:
        """z3 proves that the models have no letter whose torque is UNKNOWN."""
        return int(self.after[(self.states.index(state), int(is_own), int(is_closing), int(had_torque), *hold)]) == 1


def fill(torque: Torque) -> Torque:
    """What the compiled cycle never had, because its sequence is sound, it answers with the torque of the sequence."""
    own = np.arange(2).reshape(2, 1, 1, 1, 1)
    return replace(torque, after=np.where(torque.after == UNKNOWN, own, torque.after))


def read_torque(text: str, states: tuple[str, ...], path: Path) -> Torque:
    """@param states of the machine. @param path origin of the text, for messages. @raise InputError for a text that is no such relation."""
    node = read_node(text, path, SCHEMA, "mamori_safety_cycle_relation")
    found = tuple(item.text() for item in node.at("letter").items())
    if found != LETTER:
        raise node.at("letter").complain(f"are {found}, the properties speak about {LETTER}")
    after = np.full((len(states), 2, 2, 2, 2, len(CAUSES)), UNKNOWN, dtype=np.int64)
    for row in node.at("rows").items():
        cells = row.items()
        if len(cells) != len(LETTER):
            raise row.complain(f"has {len(cells)} cells, wanted {len(LETTER)}")
        place = (states.index(cells[0].text(states)), *(cell.index(2) for cell in cells[1:5]), cells[5].index(len(CAUSES)))
        after[place] = cells[6].index(2)
    return Torque(states, after, node.at("situations").count(), node.at("cycles").count())
