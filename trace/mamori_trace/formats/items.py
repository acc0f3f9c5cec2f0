# SPDX-License-Identifier: Apache-2.0
"""Creates items and a schema of an external project, so that every rule applies to it.

An attribute that the format lacks is neutral: it requires nothing, and no rule reports it.

@satisfies SWR-TRC-046      Design: docs/design/trace_formats.md#levels-from-data
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.levels import TEST_KINDS, group_items, infer_levels, split_refined
from mamori_trace.formats.mapping import Mapping
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss
from mamori_trace.model.item import APPROVED, DRAFT, RETIRED, Item, Level, Schema

_MALFORMED = "malformed-item"
_SIL = ("QM", "1", "2", "3", "4")
_ASIL = ("QM", "A", "B", "C", "D")
_SIL_NOISE = re.compile(r"^(?:ASIL|SIL)[\s_\-:(]*|[\s)]+$")
_NO_SIL = {"", "NO", "NONE", "N/A", "NA", "-", "0"}
_SUSPECT = "suspect-link"
_REVISION = re.compile(r"~\d+$")
_TECHNIQUES = ("requirements_based", "boundary_values", "equivalence_classes", "fault_injection", "state_transition", "error_guessing",
               "interface", "back_to_back")  # fmt: skip


@dataclass(slots=True)
class Converted:
    """Items and schema; `stands_for`: requirements of each test or code item; `polar`: items with a polarity."""

    schema: Schema
    items: list[Item]
    stands_for: dict[str, tuple[str, ...]] = field(default_factory=dict)
    code_items: list[ForeignItem] = field(default_factory=list)
    polar: set[str] = field(default_factory=set)
    revisions: dict[str, str] = field(default_factory=dict)


def convert(project: ForeignProject, mapping: Mapping, problems: list[Problem]) -> Converted:
    """Items in file order. A missing part of an item is a problem at its location."""
    all_groups = group_items(project.items, mapping)
    aside = {*mapping.lists["test_groups"], *mapping.lists["code_groups"]}
    grouped = list(zip(project.items, all_groups, strict=True))
    kept = [(item, group) for item, group in grouped if not item.heading and not {item.kind, group} & aside]
    helpers = [(item, group) for item, group in grouped if not item.heading and {item.kind, group} & aside]
    items, groups = [item for item, _ in kept], [group for _, group in kept]
    revisions = {_REVISION.sub("", item.id): item.id for item in items} if project.format == "oft" else {}
    parents = _link(items, mapping, revisions, {item.id for item, _ in helpers}, project, problems)
    index = {item.id: position for position, item in reversed(list(enumerate(items)))}
    known = [[index[target] for target, _ in above if target in index] for above in parents]
    if mapping.levels:
        groups = _assign(items, groups, mapping, problems)
        levels = dict(mapping.levels)
    else:
        groups = split_refined(groups, known, mapping.shares["link"])
        levels = infer_levels(items, groups, known, [bool(above) for above in parents], mapping)
    words = _ASIL if any(_find_sil(item, mapping) in _ASIL[1:] for item in items) else _SIL
    schema = Schema((), words, ("test", "campaign", "analysis", "review"), ("nominal", "violation"), (DRAFT, APPROVED, RETIRED),
                    _TECHNIQUES, levels)  # fmt: skip
    outcome = Converted(schema, [], revisions=revisions)
    for item, group, above in zip(items, groups, parents, strict=True):
        if group in levels:
            outcome.items.append(_make_item(item, levels[group], above, mapping, schema, outcome.polar, problems))
    _demand_statements(items, groups, outcome, mapping, problems)
    for item, group in helpers:
        outcome.stands_for[item.id] = tuple(dict.fromkeys(each.target for each in item.relations))
        if group in mapping.lists["code_groups"] or item.kind in mapping.lists["code_groups"]:
            outcome.code_items.append(item)
    return outcome


def _assign(items: list[ForeignItem], groups: list[str], mapping: Mapping, problems: list[Problem]) -> list[str]:
    """The level of each item in the user's table: by the pattern of its id, or by the name of its group."""
    assigned = []
    for item, group in zip(items, groups, strict=True):
        by_id = [key for key, level in mapping.levels.items() if level.pattern.pattern and level.pattern.fullmatch(item.id)]
        key = by_id[0] if by_id else group
        if key not in mapping.levels:
            message = f"{item.id} belongs to no level of {mapping.source}: neither its id nor its group '{group}' is named there"
            problems.append(Problem(_MALFORMED, item.place, message, item.id))
        assigned.append(key)
    return assigned


def _link(
    items: list[ForeignItem], mapping: Mapping, revisions: dict[str, str], helpers: set[str], project: ForeignProject, problems: list[Problem]
) -> list[list[tuple[str, int]]]:
    """(parent, line) of each item. Reverses downward links; reports and corrects outdated revisions."""
    positions = {item.id: position for position, item in reversed(list(enumerate(items)))}
    parents: list[list[tuple[str, int]]] = [[] for _ in items]
    for position, item in enumerate(items):
        for each in item.relations:
            target = each.target
            if mapping.leads_down(each.role) and target in positions:
                parents[positions[target]].append((item.id, items[positions[target]].place.line))
            elif mapping.leads_up(each.role) or mapping.leads_down(each.role):
                current = revisions.get(_REVISION.sub("", target), target)
                if current != target and target not in positions:
                    message = f"{item.id} covers {target}, and the item is at {current}; look again and name the new revision"
                    problems.append(Problem(_SUSPECT, Place(item.place.file, each.line), message, item.id))
                    target = current
                if target not in helpers:
                    parents[position].append((target, each.line))
            else:
                project.losses.append(Loss(Place(item.place.file, each.line), f"{item.id}: relation {each.role} to {each.target}"))
    return parents


def _make_item(
    item: ForeignItem, level: Level, above: list[tuple[str, int]], mapping: Mapping, schema: Schema, polar: set[str], problems: list[Problem]
) -> Item:
    made = Item(item.id, item.title, level.key, item.place, item.statement or "", item.statement_line or item.place.line, item.rationale)
    made.parents = tuple(dict.fromkeys(target for target, _ in above))
    made.lines = _find_lines(item, above, mapping)
    made.status = _find_status(item, mapping)
    made.sil = _choose_sil(item, mapping, schema, problems)
    made.polarity = _find_words(item, "polarity", mapping, schema.polarity)
    polar.update({item.id} if made.polarity else ())
    made.polarity = made.polarity or ("nominal",)
    made.verify = _find_words(item, "verify", mapping, schema.verify)
    if not made.verify:
        asked = item.needs is None or bool(TEST_KINDS & set(item.needs)) or (level.through_children and bool(item.needs))
        made.verify = ("test",) if asked and not level.from_children else ()
    return made


def _find_lines(item: ForeignItem, above: list[tuple[str, int]], mapping: Mapping) -> dict[str, int]:
    lines = {"Parents": above[0][1]} if above else {}
    for name, key in (("SIL", "sil"), ("Status", "status"), ("Verify", "verify"), ("Polarity", "polarity")):
        found = [item.lines[each] for each in mapping.lists[key] if each in item.lines and item.attributes.get(each)]
        lines.update({name: found[0]} if found else {})
    for each in ("RATIONALE", "Rationale", "rationale"):
        lines.update({"Rationale": item.lines[each]} if each in item.lines else {})
    return lines


def _find(item: ForeignItem, key: str, mapping: Mapping) -> str:
    return next((item.attributes[name].strip() for name in mapping.lists[key] if item.attributes.get(name, "").strip()), "")


def _find_words(item: ForeignItem, key: str, mapping: Mapping, known: tuple[str, ...]) -> tuple[str, ...]:
    words = tuple(word.strip().lower() for word in _find(item, key, mapping).split(","))
    return words if all(word in known for word in words) else ()


def _find_status(item: ForeignItem, mapping: Mapping) -> str:
    word = _find(item, "status", mapping).lower()
    return DRAFT if word in mapping.draft else RETIRED if word in mapping.retired else APPROVED


def _find_sil(item: ForeignItem, mapping: Mapping) -> str:
    return _SIL_NOISE.sub("", _find(item, "sil", mapping).upper().strip())


def _choose_sil(item: ForeignItem, mapping: Mapping, schema: Schema, problems: list[Problem]) -> str:
    word = _find_sil(item, mapping)
    if word in _NO_SIL or word in schema.sil:
        return word if word in schema.sil else ""
    name = next(name for name in mapping.lists["sil"] if item.attributes.get(name, "").strip())
    message = f"{item.id}: {name} '{item.attributes[name]}' is not one of {', '.join(schema.sil)}"
    problems.append(Problem(_MALFORMED, Place(item.place.file, item.lines.get(name, item.place.line)), message, item.id))
    return ""


def _demand_statements(items: list[ForeignItem], groups: list[str], outcome: Converted, mapping: Mapping, problems: list[Problem]) -> None:
    """An empty statement is a problem if enough items of the group have statements."""
    for group in set(groups):
        members = [item for item, own in zip(items, groups, strict=True) if own == group]
        filled = sum(bool((item.statement or "").strip()) for item in members)
        if filled < mapping.shares["statement"] * len(members):
            continue
        for item in members:
            if not (item.statement or "").strip():
                problems.append(Problem(_MALFORMED, item.place, f"{item.id}: has no statement", item.id))
    wrong = {problem.item for problem in problems if problem.rule == _MALFORMED}
    for made in outcome.items:
        made.whole = made.id not in wrong
