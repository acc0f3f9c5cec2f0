# SPDX-License-Identifier: Apache-2.0
"""Derives the levels of an external project from its data: groups of items, their order, and the rules of each group.

A property of most items of a group is required for all of them; a property of few is required for none.

@satisfies SWR-TRC-046      Design: docs/design/trace_formats.md#levels-from-data
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable

from mamori_trace.formats.mapping import Mapping
from mamori_trace.formats.model import ForeignItem
from mamori_trace.model.item import Level

_SEPARATOR = re.compile(r"[-_.~/ ]+")
_SHALL = re.compile(r"\bshall\b", re.IGNORECASE)
_REFINED = " (refined)"
_NO_ID = re.compile(r"(?!)")
CODE_KINDS = frozenset({"impl", "code"})
TEST_KINDS = frozenset({"utest", "itest", "stest", "test", "tst", "tests"})


def group_items(items: list[ForeignItem], mapping: Mapping) -> list[str]:
    """The group of each item."""
    if mapping.group_by == "kind":
        return [item.kind or "item" for item in items]
    if mapping.group_by == "document":
        return [item.document or "item" for item in items]
    if mapping.group_by.startswith("attribute:"):
        name = mapping.group_by.partition(":")[2]
        return [item.attributes.get(name, "") or "item" for item in items]
    return _group_by_prefix([item.id for item in items])


def _group_by_prefix(ids: list[str]) -> list[str]:
    """The first word of the id in which the ids differ: `ZEP-SRS-1-2` and `ZEP-SYRS-3` give SRS and SYRS."""
    parts = [[part for part in _SEPARATOR.split(each) if part] for each in ids]
    common = 0
    while parts and all(len(each) > common + 1 and each[common] == parts[0][common] for each in parts):
        common += 1
    groups = []
    for each in parts:
        word = each[common] if len(each) > common else ""
        name = re.sub(r"\d+$", "", word)
        groups.append(name or "-".join(each[:common]) or "item")
    return groups


def split_refined(groups: list[str], parents: list[list[int]], share: float) -> list[str]:
    """If items of a group refine each other, the refined items become a separate level."""
    inside: Counter[str] = Counter()
    sizes = Counter(groups)
    refined = set()
    for index, above in enumerate(parents):
        own = [each for each in above if groups[each] == groups[index] and each != index]
        inside[groups[index]] += bool(own)
        refined.update(own)
    split = {group for group, count in inside.items() if count >= share * sizes[group]}
    return [group + _REFINED if group in split and index in refined else group for index, group in enumerate(groups)]


def infer_levels(items: list[ForeignItem], groups: list[str], parents: list[list[int]], named: list[bool], mapping: Mapping) -> dict[str, Level]:
    """Levels from top to bottom. `parents`: positions of the known parents; `named`: whether an item names any parent."""
    sizes = Counter(groups)
    up: dict[str, Counter] = defaultdict(Counter)
    for index, above in enumerate(parents):
        up[groups[index]].update({groups[each] for each in above})
    edges = _choose_edges(up, sizes, mapping.shares["link"])
    order = _order_groups(sorted(sizes), edges)
    with_parent, with_child = _count(groups, named), _count(groups, _list_refined(groups, parents))
    with_shall = _count(groups, [len(_SHALL.findall(item.statement or "")) == 1 for item in items])
    coded = _count(groups, [item.needs is None or bool(CODE_KINDS & set(item.needs)) for item in items])
    levels = {}
    for position, group in enumerate(order):
        higher = tuple(sorted(edges.get(group, ())))
        below = any(group in each for each in edges.values())
        size, shares = sizes[group], mapping.shares
        demanded = bool(higher) and with_parent[group] >= shares["parent"] * size
        top = not higher and below and with_child[group] >= shares["child"] * size
        also = set(order[:position]) | ({group} if up[group][group] >= shares["link"] * size else set())
        levels[group] = Level(
            key=group,
            name=group,
            pattern=_NO_ID,
            parents=higher if demanded else (),
            also=tuple(each for each in order if each in also - (set(higher) if demanded else set())),
            shall=with_shall[group] >= shares["shall"] * size,
            needs_child=top,
            needs_code=not below and coded[group] >= 0.5 * size,
            from_children=top,
            through_children=below and not top,
        )
    return levels


def _count(groups: list[str], flags: Iterable[bool]) -> Counter:
    return Counter(group for group, flag in zip(groups, flags, strict=True) if flag)


def _list_refined(groups: list[str], parents: list[list[int]]) -> list[bool]:
    refined = {each for above in parents for each in above}
    return [index in refined for index in range(len(groups))]


def _choose_edges(up: dict[str, Counter], sizes: Counter, share: float) -> dict[str, set[str]]:
    """Orders the groups by the links between them. Takes the most frequent links first, and ignores a link that would close a cycle."""
    counted = sorted((-count, low, high) for low, row in up.items() for high, count in row.items() if low != high)
    edges: dict[str, set[str]] = defaultdict(set)
    for count, low, high in counted:
        if -count >= share * sizes[low] and low not in _reach(edges, high):
            edges[low].add(high)
    return edges


def _reach(edges: dict[str, set[str]], start: str) -> set[str]:
    seen, waiting = set(), [start]
    while waiting:
        group = waiting.pop()
        if group not in seen:
            seen.add(group)
            waiting.extend(edges.get(group, ()))
    return seen


def _order_groups(groups: list[str], edges: dict[str, set[str]]) -> list[str]:
    """From top to bottom; groups without an order are sorted by name."""
    depth = {group: len(_reach(edges, group)) for group in groups}
    return sorted(groups, key=lambda group: (depth[group], group))
