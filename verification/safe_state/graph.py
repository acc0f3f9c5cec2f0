# SPDX-License-Identifier: Apache-2.0
"""Graphs of situations: shortest paths from power-up, and merged situations that no sequence of inputs distinguishes.

@satisfies SWR-FSM-022      Design: docs/design/safe_state.md#models
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import TypeVar

import numpy as np

from verification.safe_state.relation import Array

Place = TypeVar("Place", bound=Hashable)
Link = TypeVar("Link")


def walk(begins: Iterable[Place], list_moves: Callable[[Place], Iterable[tuple[Link, Place]]]) -> dict[Place, tuple[Place, Link] | None]:
    """@return for each reachable place, the previous place on a shortest path and the link between them; None for `begins`."""
    roads: dict[Place, tuple[Place, Link] | None] = dict.fromkeys(begins)
    pending = deque(roads)
    while pending:
        here = pending.popleft()
        for link, there in list_moves(here):
            if there not in roads:
                roads[there] = (here, link)
                pending.append(there)
    return roads


def list_road(roads: Mapping[Place, tuple[Place, Link] | None], place: Place) -> list[tuple[Place, Link]]:
    """@return each place on the path to `place`, with the link to the next one."""
    road: list[tuple[Place, Link]] = []
    while (before := roads.get(place)) is not None:
        road.insert(0, before)
        place = before[0]
    return road


def merge_alike(seen: Sequence[Array], following: Array) -> tuple[Array, list[int]]:
    """Groups situations that give equal results for every sequence of inputs. `seen`: rows of results. `following`: the situation after
    each input. @return the group of each situation, numbered in the order of the relation, and one member of each group."""
    count = len(following)
    group = np.zeros(count, dtype=np.int64)
    while True:
        rows = np.concatenate([group[:, None], *(array.reshape(count, -1) for array in seen), group[following].reshape(count, -1)], axis=1)
        _, first_seen, finer = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        finer = np.argsort(np.argsort(first_seen))[finer.reshape(-1)]
        if finer.max() == group.max():
            return finer, [int(np.flatnonzero(finer == number)[0]) for number in range(int(finer.max()) + 1)]
        group = finer
