# SPDX-License-Identifier: Apache-2.0
"""Findings: what is wrong, where, how badly, and by which rule."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

ERROR = "error"
WARNING = "warning"
OFF = "off"


class Place(NamedTuple):
    """A line of a file. `file` is relative to the project root where it lies inside; `line` counts from 1.

    A tuple, like all that a large project has ten thousands of: made in half of the time that a frozen class takes, and compared in less.
    """

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass(frozen=True, slots=True)
class Problem:
    """Something a reader stumbled over. `rule` names the rule under which it is reported."""

    rule: str
    place: Place
    message: str
    item: str = ""


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: `id` never changes its meaning; `about` says in one sentence what it demands.

    `severity` holds where no rule pack says another; OFF is a rule that only speaks where a pack demands it. `release` replaces the
    severity of what is judged for a release.
    """

    id: str
    severity: str
    about: str
    release: str = ""


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation of one rule at one place; `item` is the id it is about, or empty."""

    rule: str
    severity: str
    place: Place
    message: str
    item: str = ""

    def sort_key(self) -> tuple[str, int, str, str]:
        return (self.place.file, self.place.line, self.rule, self.message)
