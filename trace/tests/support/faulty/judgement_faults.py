# SPDX-License-Identifier: Apache-2.0
"""Fault classes of waivers, decomposition, reviews, ids, and the rules of a SIL."""

from __future__ import annotations

import random
from collections.abc import Callable

from faulty.fault import Fault, Seed, pick
from faulty.plan import MIDDLE, TOP, Plan, Requirement
from mamori_trace.base.finding import Place
from mamori_trace.model.item import Item

_WAIVERS = ("requirements/waivers.toml", "mamori.waivers/1", "waiver")
_RECORDS = ("requirements/decomposition.toml", "mamori.decomposition/1", "record")
_REVIEWS = ("requirements/reviews.toml", "mamori.reviews/1", "review")
_IDS = "requirements/ids.lock"
_NO_SIL = {"oft": "the format has no word for a safety level"}
_NO_ATTRIBUTE = {"oft": "the format has no attributes of one's own"}
_FOREIGN = ("strictdoc", "oft", "needs", "doorstop", "trlc")
_NO_WORD = dict.fromkeys(_FOREIGN, "the format does not tell a hazard, or has no design links")


def _add_row(plan: Plan, file: tuple[str, str, str], key: str, **columns: str | list[str]) -> None:
    """A row of a TOML file in requirements/; `key` finds its head."""
    name, schema, head = file
    lines = plan.beside.setdefault(name, [(f'schema = "{schema}"', "")])
    lines.append((f"[[{head}]]", key))
    for column, value in columns.items():
        shown = f'"{value}"' if isinstance(value, str) else "[" + ", ".join(f'"{each}"' for each in value) + "]"
        lines.append((f"{column} = {shown}", ""))


def _waiver(**columns: str) -> Callable[[Plan, random.Random], list[Seed]]:
    def spoil(plan: Plan, chance: random.Random) -> list[Seed]:
        chosen = pick(plan, chance)
        for each in chosen:
            row = {"rule": "sil-lower", "item": each.id, "reason": "It is so.", "by": "the maintainers", **columns}
            _add_row(plan, _WAIVERS, each.id, **row)
        return [("sil-lower", each.id, ("row",)) for each in chosen]

    return spoil


def _record(plan: Plan, child: Requirement, carrier: Requirement) -> None:
    _add_row(plan, _RECORDS, child.id, child=child.id, parent=child.parents[0], reason="It is so.", independence="They share nothing.",
             carried_by=[carrier.id], by="the maintainers")  # fmt: skip


def unused_record(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        sibling = next(one for one in plan.requirements if one.parents == each.parents and one is not each)
        _record(plan, each, sibling)
    return [(each.id, each.id, ("row",)) for each in chosen]


def unsound_record(plan: Plan, chance: random.Random) -> list[Seed]:
    first, second = pick(plan, chance)
    for each, other in ((first, second), (second, first)):
        each.sil = "1"
        _record(plan, each, other)
    return [(each.id, each.id, ("row",)) for each in (first, second)]


def id_reused(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    plan.beside[_IDS] = [(f"{each.id} 0123456789ab 2026-10-01 Something older", "") for each in chosen]
    return [(each.id, each.id, ("item",)) for each in chosen]


def weak_word(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.statement = each.statement.replace("its range", "its range if possible")
    return [(each.id, each.id, ("statement",)) for each in chosen]


def violation_not_demanded(plan: Plan, chance: random.Random) -> list[Seed]:
    hazard = Requirement("HAZ-801", TOP, "Speed", "The machine strikes a person.")
    plan.requirements.append(hazard)
    chosen = pick(plan, chance, MIDDLE)
    for each in chosen:
        each.parents.append(hazard.id)
    return [(each.id, each.id, ("Polarity",)) for each in chosen]


def design_missing(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.sil = "3"
    return [(each.id, each.id, ("Design",)) for each in chosen]


def review_missing(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.verify = "test, analysis"
    return [(each.id, each.id, ("Verify",)) for each in chosen]


def _add_review(plan: Plan, requirement: Requirement) -> None:
    """Adds an analysis of the current requirement by its author."""
    item = Item(requirement.id, requirement.title, "SWR", Place("", 1), statement=requirement.statement, sil=requirement.sil,
                verify=tuple(requirement.verify.split(", ")), polarity=tuple(requirement.polarity.split(", ")))  # fmt: skip
    _add_row(plan, _REVIEWS, requirement.id, item=requirement.id, method="analysis", fingerprint=item.calc_fingerprint(),
             looked_at="docs/design/generated.md", author="the maintainers", by="the maintainers", date="2026-11-21")  # fmt: skip


def review_unused(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = [Requirement(plan.make_id(2, 901 + number), 2, "Gone", "The software shall stay gone.") for number in range(2)]
    for each in chosen:
        _add_review(plan, each)
    return [(each.id, each.id, ("row",)) for each in chosen]


def review_by_author(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.verify = "test, analysis"
        _add_review(plan, each)
    return [(each.id, each.id, ("row",)) for each in chosen]


JUDGEMENT_FAULTS = {
    "weak-word": Fault("weak-word", weak_word),
    "id-reused": Fault("id-reused", id_reused),
    "waiver-unused": Fault("waiver-unused", _waiver()),
    "waiver-expired": Fault("waiver-expired", _waiver(expires="2026-11-01"), evidence=True),
    "waiver-without-reason": Fault("waiver-without-reason", _waiver(reason="")),
    "decomposition-unused": Fault("decomposition-unused", unused_record, _NO_SIL),
    "decomposition-unsound": Fault("decomposition-unsound", unsound_record, _NO_SIL),
    "violation-not-demanded": Fault("violation-not-demanded", violation_not_demanded, _NO_WORD),
    "design-missing": Fault("design-missing", design_missing, _NO_WORD),
    "review-missing": Fault("review-missing", review_missing, _NO_ATTRIBUTE),
    "review-unused": Fault("review-unused", review_unused),
    "review-by-author": Fault("independence-missing", review_by_author, _NO_ATTRIBUTE),
}
