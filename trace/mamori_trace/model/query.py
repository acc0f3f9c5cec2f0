# SPDX-License-Identifier: Apache-2.0
"""Meaning of a query: the fields of items and their values. A word that no item can contain is an error, not an empty result.

@satisfies SWR-TRC-079, SWR-TRC-080      Design: docs/design/trace.md#query
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable
from functools import lru_cache

from mamori_trace.base.errors import FormatError
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.query_syntax import AND, COMPARE, HAS, NOT, Step, parse
from mamori_trace.model.verdict import WORST_FIRST, Verdict

RETIRED_WORD = "retired"
_ORDERED = ("sil", "line")
_LINKS = ("id", "parent", "child", "ancestor", "descendant")
Values = tuple[str, ...]


class Query:
    """An expression that was checked against the project. Raises FormatError."""

    def __init__(self, text: str, project: Project, verdicts: dict[str, Verdict], rules_of: Callable[[], dict[str, set[str]]]) -> None:
        """@param rules_of returns the rules with a finding for each item; called only if a query needs it."""
        self._project = project
        self._verdicts = verdicts
        self._rules_of = lru_cache(maxsize=1)(rules_of)
        self._fields = self._make_fields()
        self._words = self._make_words()
        self._steps = parse(text)
        for step in self._steps:
            self._check(step)

    @property
    def fields(self) -> list[str]:
        return list(self._fields)

    def select(self) -> list[Item]:
        """The items for which the expression is true, sorted by id."""
        items = self._project.items
        return [items[key] for key in sorted(items) if self._holds(items[key])]

    def _holds(self, item: Item) -> bool:
        truths: list[bool] = []
        for step in self._steps:
            if step.action == COMPARE:
                truths.append(self._compare(step, self._fields[step.field](item)))
            elif step.action == HAS:
                truths.append(any(self._fields[step.field](item)))
            elif step.action == NOT:
                truths.append(not truths.pop())
            else:
                right, left = truths.pop(), truths.pop()
                truths.append(left and right if step.action == AND else left or right)
        return truths[0]

    def _compare(self, step: Step, values: Values) -> bool:
        if step.operator in ("=", "!="):
            equal = any(value.casefold() == step.value.casefold() for value in values)
            return equal == (step.operator == "=")
        if step.operator in ("~", "!~"):
            found = any(step.value.casefold() in value.casefold() for value in values)
            return found == (step.operator == "~")
        return any(self._is_ordered(step, value) for value in values)

    def _is_ordered(self, step: Step, value: str) -> bool:
        left, right = self._rank(step.field, value), self._rank(step.field, step.value)
        if left < 0:
            return False  # an item whose SIL could not be read
        return {"<": left < right, "<=": left <= right, ">": left > right, ">=": left >= right}[step.operator]

    def _rank(self, field: str, value: str) -> int:
        """Index of a SIL in the order of the schema, or the number itself; -1 if it is neither."""
        if field == "sil":
            order = [word.casefold() for word in self._project.schema.sil]
            return order.index(value.casefold()) if value.casefold() in order else -1
        return int(value) if value.isascii() and value.isdigit() and len(value) < 10 else -1

    def _check(self, step: Step) -> None:
        if step.action not in (COMPARE, HAS):
            return
        if step.field not in self._fields:
            raise FormatError(f"there is no field '{step.field}'{_hint(step.field, self._fields)}", step.column)
        if step.operator in ("<", "<=", ">", ">=") and step.field not in _ORDERED:
            raise FormatError(f"'{step.field}' has no order; only {' and '.join(_ORDERED)} have", step.column)
        if step.field == "line" and step.action == COMPARE and self._rank("line", step.value) < 0:
            raise FormatError(f"'{step.value}' is no line number", step.value_column)
        known = self._words.get(step.field)
        if step.operator in ("~", "!~") or step.action == HAS or known is None:
            return
        if step.value.casefold() not in {word.casefold() for word in known}:
            raise FormatError(f"'{step.value}' is no {step.field}{_hint(step.value, known)}", step.value_column)

    def _make_fields(self) -> dict[str, Callable[[Item], Values]]:
        project = self._project
        return {
            "id": lambda item: (item.id,),
            "title": lambda item: (item.title,),
            "text": lambda item: (item.statement,),
            "rationale": lambda item: (item.rationale,),
            "level": lambda item: (item.level,),
            "area": lambda item: tuple(item.id.split("-")[1:-1]),
            "sil": lambda item: (item.sil,),
            "verify": lambda item: item.verify,
            "polarity": lambda item: item.polarity,
            "status": lambda item: (item.status,),
            "design": lambda item: (item.design,),
            "file": lambda item: (item.place.file,),
            "line": lambda item: (str(item.place.line),),
            "verdict": lambda item: (self._get_verdict(item).word,),
            "objection": lambda item: tuple(self._get_verdict(item).reasons),
            "rule": lambda item: tuple(sorted(self._rules_of().get(item.id, ()))),
            "parent": lambda item: item.parents,
            "child": lambda item: tuple(child.id for child in project.children_of.get(item.id, [])),
            "ancestor": lambda item: tuple(sorted(list_ancestors(project, item))),
            "descendant": lambda item: tuple(sorted(list_descendants(project, item))),
            "code": lambda item: tuple(f"{tag.place.file} {tag.symbol}" for tag in project.tags_of.get(item.id, [])),
            "test": lambda item: tuple(test.title for test in project.tests_of.get(item.id, [])),
            "technique": lambda item: tuple({test.technique for test in project.tests_of.get(item.id, [])}),
            "result": lambda item: tuple(result.status for result in project.results_of.get(item.id, [])),
            "case": lambda item: tuple(case.id for case in project.cases_of.get(item.id, [])),
        }

    def _make_words(self) -> dict[str, Iterable[str]]:
        """Fields with a closed list of values."""
        schema = self._project.schema
        words: dict[str, Iterable[str]] = dict.fromkeys(_LINKS, self._project.items)
        words["level"] = schema.levels
        words["area"] = {part for key in self._project.items for part in key.split("-")[1:-1]}
        words |= {"sil": schema.sil, "verify": schema.verify, "polarity": schema.polarity, "status": schema.status}
        words |= {"verdict": (*WORST_FIRST, RETIRED_WORD), "technique": schema.technique}
        words["result"] = ("passed", "failed", "error", "skipped")
        return words

    def _get_verdict(self, item: Item) -> Verdict:
        return self._verdicts.get(item.id, Verdict(RETIRED_WORD))


def list_ancestors(project: Project, item: Item) -> set[str]:
    """All ancestors; a cycle ends at its beginning."""
    return _walk(item.parents, lambda key: project.items[key].parents if key in project.items else ())


def list_descendants(project: Project, item: Item) -> set[str]:
    """All descendants."""
    children = project.children_of
    return _walk((child.id for child in children.get(item.id, [])), lambda key: (child.id for child in children.get(key, [])))


def _walk(first: Iterable[str], follow: Callable[[str], Iterable[str]]) -> set[str]:
    seen: set[str] = set()
    waiting = list(first)
    while waiting:
        key = waiting.pop()
        if key not in seen:
            seen.add(key)
            waiting.extend(follow(key))
    return seen


def _hint(word: str, known: Iterable[str]) -> str:
    names = sorted(known)
    folded = {name.casefold(): name for name in names}
    near = [folded[each] for each in difflib.get_close_matches(word.casefold(), folded, n=3, cutoff=0.5)]
    return f"; nearest: {', '.join(near)}" if near else f"; known are {', '.join(names)}" if len(names) < 40 else ""
