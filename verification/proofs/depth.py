# SPDX-License-Identifier: Apache-2.0
"""Groups of functions that call each other, and the deepest path through a graph of calls.

@satisfies SWR-PRF-020, SWR-PRF-022      Design: docs/design/proofs.md#stack
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

import networkx as nx


def find_groups(calls: Mapping[str, Collection[str]]) -> list[list[str]]:
    """Strongly connected components, callees before callers. A group of one function is recursive only if the function calls itself."""
    graph = nx.condensation(nx.DiGraph({name: sorted(calls[name]) for name in sorted(calls)}))
    return [sorted(graph.nodes[number]["members"]) for number in reversed(list(nx.topological_sort(graph)))]


def is_recursive(group: Collection[str], calls: Mapping[str, Collection[str]]) -> bool:
    """True if a function of the group may be called before its previous call has returned."""
    return len(group) > 1 or any(name in calls.get(name, ()) for name in group)


def calc_deepest_paths(frames: Mapping[str, int], calls: Mapping[str, Collection[str]]) -> dict[str, tuple[str, ...]]:
    """For each function the path with the largest sum of frames, beginning with the function.

    Functions that may reach a recursion or a function without a known frame are omitted: they have no bound.
    """
    paths: dict[str, tuple[str, ...]] = {}
    sums: dict[str, int] = {}
    for group in find_groups(calls):
        name = group[0]
        callees = calls.get(name, ())
        if is_recursive(group, calls) or name not in frames or any(callee not in sums for callee in callees):
            continue
        deepest = max(sorted(callees), key=lambda callee: sums[callee], default=None)
        paths[name] = (name, *paths.get(deepest or "", ()))
        sums[name] = frames[name] + (sums[deepest] if deepest else 0)
    return paths
