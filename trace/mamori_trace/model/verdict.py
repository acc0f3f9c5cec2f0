# SPDX-License-Identifier: Apache-2.0
"""Derives the verdict of each item from executed results, the worst first.

@satisfies SWR-TRC-006, SWR-TRC-007, SWR-TRC-014, SWR-TRC-101, SWR-TRC-102      Design: docs/design/trace.md#verdict
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from mamori_trace.model.evidence import CAMPAIGN, NOT_SHOWN, PASSED, SKIPPED, UNBOUND
from mamori_trace.model.item import DRAFT, Item
from mamori_trace.model.project import Project

VERIFIED = "verified"
FAILED = "failed"
INCOMPLETE = "incomplete"
NOT_RUN = "not run"

# Worst first: the worst objection determines the verdict of an item.
WORST_FIRST = (FAILED, INCOMPLETE, UNBOUND, NOT_RUN, NOT_SHOWN, DRAFT, VERIFIED)

_OF_STATUS = {SKIPPED: (INCOMPLETE, "was skipped"), UNBOUND: (UNBOUND, "has no evidence record"),
              NOT_SHOWN: (NOT_SHOWN, "cannot be shown on this host")}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Verdict:
    """`word` is one of WORST_FIRST; `reasons` are the objections to 'verified', the worst first, empty if there are none."""

    word: str
    reasons: tuple[str, ...] = ()


_Objection = tuple[str, str]  # (word, reason)


def calc_verdicts(project: Project) -> dict[str, Verdict]:
    """Verdict of each live item. Levels are evaluated from the bottom of the V upwards, so that a cycle cannot block the evaluation."""
    verdicts: dict[str, Verdict] = {}
    for level in reversed(project.schema.levels):
        for item in project.live_items:
            if item.level == level:
                verdicts[item.id] = _judge(project, item, verdicts)
    return verdicts


def _judge(project: Project, item: Item, verdicts: dict[str, Verdict]) -> Verdict:
    if item.status == DRAFT:
        return Verdict(DRAFT, ("the item is a draft",))
    level = project.schema.levels[item.level]
    objections = list(_list_bad_results(project, item))
    if not item.whole:
        objections.append((INCOMPLETE, "the item block is malformed"))
    if level.needs_code and item.id not in project.tags_of:
        objections.append((INCOMPLETE, "no code names it"))
    children = [child for child in project.children_of.get(item.id, []) if child.id in verdicts]
    if level.from_children:
        objections += _judge_children(children, verdicts)
    else:
        failed = [child.id for child in children if verdicts[child.id].word == FAILED]
        objections += [(FAILED, f"{child} failed") for child in failed]
        for method in item.verify:
            objections += judge_method(project, item, method, children, verdicts)
    if not objections:
        return Verdict(VERIFIED)
    objections.sort(key=lambda objection: WORST_FIRST.index(objection[0]))
    return Verdict(objections[0][0], tuple(dict.fromkeys(reason for _, reason in objections)))


def _list_bad_results(project: Project, item: Item) -> Iterable[_Objection]:
    """Results that name the item and did not pass, and tests of the item without a result."""
    absent = NOT_RUN if project.allow_missing else INCOMPLETE
    for result in project.results_of.get(item.id, []):
        if result.failing:
            yield FAILED, f"test {result.title} failed"
        elif result.status in _OF_STATUS:
            word, what = _OF_STATUS[result.status]
            yield word, f"test {result.title} {what}"
    for case in project.cases_of.get(item.id, []):
        if case.status == FAILED:
            yield FAILED, f"campaign case {case.id} failed"
        elif case.status == NOT_SHOWN:
            yield NOT_SHOWN, f"campaign case {case.id} was inconclusive"
        elif case.status == UNBOUND:
            yield UNBOUND, f"campaign case {case.id} has no evidence record"
    for test in project.unexecuted_of.get(item.id, []):
        yield absent, f"test {test.title} has no result"


def _judge_children(children: list[Item], verdicts: dict[str, Verdict]) -> list[_Objection]:
    if not children:
        return [(INCOMPLETE, "nothing refines it")]
    return [
        (INCOMPLETE if word == DRAFT else word, f"{child.id} is {word}")
        for child in children
        if (word := verdicts[child.id].word) != VERIFIED
    ]


def judge_method(
    project: Project, item: Item, method: str, children: list[Item], verdicts: dict[str, Verdict]
) -> list[_Objection]:
    """Objections to the item by one method that it requires."""
    if method == "campaign":
        # Unbound and inconclusive cases have a separate objection.
        passed = {case.get_polarity(item.id) for case in project.cases_of.get(item.id, []) if case.status != FAILED}
        absent = NOT_RUN if project.allow_missing else INCOMPLETE
        return [(absent, f"no passed {polarity} campaign case") for polarity in item.polarity if polarity not in passed]
    if method == "test":
        own = _judge_own_tests(project, item)
        if not own or not (project.schema.levels[item.level].through_children and children):
            return own
        return _judge_through_children(project, item, children, verdicts)
    return [] if is_reviewed(project, item) else [(INCOMPLETE, f"no review of its links is recorded ({method})")]


def _judge_own_tests(project: Project, item: Item) -> list[_Objection]:
    executed = (PASSED, UNBOUND, NOT_SHOWN)  # `_list_bad_results` has reported the last two under their own verdicts
    passed = {
        result.polarity or "nominal"
        for result in project.results_of.get(item.id, [])
        if result.status in executed and result.kind != CAMPAIGN
    }
    waiting = {test.polarity for test in project.unexecuted_of.get(item.id, [])} if project.allow_missing else set()
    return [
        (NOT_RUN if polarity in waiting else INCOMPLETE, f"no passed {polarity} test")
        for polarity in item.polarity
        if polarity not in passed
    ]


def _judge_through_children(
    project: Project, item: Item, children: list[Item], verdicts: dict[str, Verdict]
) -> list[_Objection]:
    """Verified children replace tests of the item if, for each polarity that the item requires, one of them requires it too."""
    objections = _judge_children(children, verdicts)
    for polarity in list_uncovered_polarities(project, item, children):
        objections.append((INCOMPLETE, f"no {polarity} test, neither its own nor of a child"))
    return objections


def list_uncovered_polarities(project: Project, item: Item, children: list[Item]) -> list[str]:
    """Required polarities that no test of the item shows and no child requires."""
    covered = {polarity for child in children for polarity in child.polarity}
    covered |= {test.polarity for test in project.tests_of.get(item.id, [])}
    covered |= {result.polarity or "nominal" for result in project.results_of.get(item.id, [])}
    return [polarity for polarity in item.polarity if polarity not in covered]


def is_reviewed(project: Project, item: Item) -> bool:
    """Whether a person has reviewed each parent link of the current item."""
    parents = [parent for parent in item.parents if parent in project.items]
    lock, now = project.lock, project.fingerprints
    return bool(parents) and lock is not None and not any(lock.describe_suspicion(item.id, parent, now) for parent in parents)
