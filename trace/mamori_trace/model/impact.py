# SPDX-License-Identifier: Apache-2.0
"""Effects of a change: from functions, items, tests and headings to requirements, hazards, tests, cases and reviews.

In doubt, the report includes too much instead of too little. It lists changed files that it cannot assign.

@satisfies SWR-TRC-071, SWR-TRC-072      Design: docs/design/trace.md#impact
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from mamori_trace.model.evidence import CampaignCase, CodeTag, SourceTest
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project

ADDED, CHANGED, REMOVED = "added", "changed", "removed"
WHOLE_FILE = "(file)"
_CPP = (".hpp", ".h", ".cpp", ".cc", ".ipp")
_COMPARED = ("title", "statement", "rationale", "parents", "sil", "verify", "polarity", "design", "status")


@dataclass(frozen=True, slots=True, order=True)
class Part:
    """A named part of a changed file, or the file outside its parts. `requirements` own it."""

    file: str
    name: str
    state: str
    requirements: tuple[str, ...] = ()
    is_test: bool = False


@dataclass(frozen=True, slots=True, order=True)
class ItemChange:
    """An item that was added, removed or changed; `fields` names the changed fields."""

    id: str
    state: str
    fields: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, order=True)
class Redo:
    """A link that needs a new review. `recorded`: the newer side already contains that review."""

    child: str
    parent: str
    why: str
    recorded: bool


@dataclass(slots=True)
class Impact:
    """All effects of a change. `causes`: reason for each affected requirement; `above`: the items above them."""

    parts: list[Part] = field(default_factory=list)
    items: list[ItemChange] = field(default_factory=list)
    headings: list[Part] = field(default_factory=list)
    unattributed: list[str] = field(default_factory=list)
    causes: dict[str, list[str]] = field(default_factory=dict)
    above: list[str] = field(default_factory=list)
    tests: list[SourceTest] = field(default_factory=list)
    removed_tests: list[SourceTest] = field(default_factory=list)
    cases: list[CampaignCase] = field(default_factory=list)
    reviews: list[Redo] = field(default_factory=list)


class Owners:
    """The requirements that own a part of a file, by the tags of both sides of the change."""

    def __init__(self, tags: Iterable[CodeTag]) -> None:
        self._by_file: dict[str, set[CodeTag]] = {}
        self._by_stem: dict[tuple[str, str], set[str]] = {}
        for tag in tags:
            self._by_file.setdefault(tag.place.file, set()).add(tag)
            self._by_stem.setdefault(_get_stem(tag.place.file), set()).add(tag.place.file)

    def find(self, file: str, name: str) -> tuple[str, ...]:
        """Requirements of the part, its enclosing parts, and the file. Tags of a header also apply to the source file of the same name."""
        files = {file}
        if file.endswith(_CPP):
            files |= {other for other in self._by_stem.get(_get_stem(file), ()) if other.endswith(_CPP)}
        words = set(re.split(r"::|\.", name))
        tags = [tag for each in files for tag in self._by_file.get(each, ())]
        if name == WHOLE_FILE:
            return tuple(sorted({tag.requirement for tag in tags}))
        return tuple(sorted({tag.requirement for tag in tags if tag.symbol == "file" or tag.symbol.split("::")[-1] in words}))


def _get_stem(file: str) -> tuple[str, str]:
    """Layer and name: `safety/include/mamori/safety/a.hpp` and `safety/src/a.cpp` are one unit."""
    path = PurePosixPath(file)
    return path.parts[0], path.stem


def compare_items(old: dict[str, Item], new: dict[str, Item]) -> list[ItemChange]:
    """Items that were added, removed, or whose content differs; a move inside the files is not a change."""
    changes = [ItemChange(key, ADDED) for key in new.keys() - old.keys()]
    changes += [ItemChange(key, REMOVED) for key in old.keys() - new.keys()]
    for key in old.keys() & new.keys():
        fields = tuple(name for name in _COMPARED if getattr(old[key], name) != getattr(new[key], name))
        if fields:
            changes.append(ItemChange(key, CHANGED, fields))
    return sorted(changes)


def list_reviews(old: Project, new: Project) -> list[Redo]:
    """Links with changed ends, and new links."""
    before = {(item.id, parent) for item in old.live_items for parent in item.parents}
    reviews = []
    for child in new.live_items:
        for name in dict.fromkeys(child.parents):
            parent = new.items.get(name)
            if parent is None:
                continue
            changed = [each.id for each in (child, parent) if _is_other(old.items.get(each.id), each)]
            if (child.id, name) not in before:
                why = "new link"
            elif changed:
                why = f"{' and '.join(changed)} changed"
            else:
                continue
            recorded = new.lock is not None and not new.lock.describe_suspicion(child.id, name, new.fingerprints)
            reviews.append(Redo(child.id, name, why, recorded))
    return sorted(reviews)


def _is_other(old: Item | None, new: Item) -> bool:
    return old is None or old.calc_fingerprint() != new.calc_fingerprint()


def calc_impact(old: Project, new: Project, parts: list[Part], headings: list[Part], unattributed: list[str]) -> Impact:
    """Joins the results of the readers. `parts` have their owners."""
    impact = Impact(sorted(parts), compare_items(old.items, new.items), sorted(headings), sorted(unattributed))
    changed_tests = {(part.file, part.name) for part in parts if part.is_test and part.state != REMOVED}
    removed = {(part.file, part.name) for part in parts if part.is_test and part.state == REMOVED}
    impact.removed_tests = [test for test in old.tests if _get_key(test) in removed]
    _collect_causes(impact, old, new, changed_tests)
    impact.above = _list_above(impact.causes, old, new)
    wanted = {*impact.causes, *impact.above}
    impact.tests = sorted(
        {test for test in new.tests if test.name and (test.requirement in wanted or _get_key(test) in changed_tests)},
        key=lambda test: (test.place, test.suite, test.name, test.requirement),
    )
    impact.cases = [case for case in new.evidence.cases if wanted & set(case.requirements)]
    impact.reviews = list_reviews(old, new)
    return impact


def _get_key(test: SourceTest) -> tuple[str, str]:
    """File and name in the spelling of the part finder: `Suite.Name` in C++, `Class.name` or `name` in Python."""
    if test.place.file.endswith(".py"):
        inner = test.suite.partition(".")[2]
        return test.place.file, f"{inner}.{test.name}" if inner else test.name
    return test.place.file, test.title


def _collect_causes(impact: Impact, old: Project, new: Project, changed_tests: set[tuple[str, str]]) -> None:
    causes: dict[str, set[str]] = {}
    for part in impact.parts:
        for requirement in part.requirements:
            causes.setdefault(requirement, set()).add(f"{part.file}: {part.name} {part.state}")
    for change in impact.items:
        causes.setdefault(change.id, set()).add("item " + change.state + (f" ({', '.join(change.fields)})" if change.fields else ""))
    for project, wanted, word in ((new, changed_tests, CHANGED), (old, {_get_key(test) for test in impact.removed_tests}, REMOVED)):
        for test in project.tests:
            if _get_key(test) in wanted:
                causes.setdefault(test.requirement, set()).add(f"test {test.title} {word}")
    for heading in impact.headings:
        for requirement in heading.requirements:
            causes.setdefault(requirement, set()).add(f"design {heading.file}#{heading.name} {heading.state}")
    impact.causes = {key: sorted(causes[key]) for key in sorted(causes)}


def _list_above(causes: Iterable[str], old: Project, new: Project) -> list[str]:
    """Ancestors on either side, each once; a cycle ends where it began."""
    seen: set[str] = set()
    waiting = list(causes)
    while waiting:
        key = waiting.pop()
        for project in (old, new):
            item = project.items.get(key)
            for parent in item.parents if item else ():
                if parent not in seen:
                    seen.add(parent)
                    waiting.append(parent)
    return sorted(seen - set(causes))
