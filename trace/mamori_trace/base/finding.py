# SPDX-License-Identifier: Apache-2.0
"""Findings: rule, severity, location and text of each violation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

ERROR = "error"
WARNING = "warning"
OFF = "off"


class Place(NamedTuple):
    """A line of a file. `file` is relative to the project root if it is inside; `line` counts from 1.

    A tuple, because a large project has tens of thousands: creation takes half the time of a frozen class, and comparison is faster.
    """

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


@dataclass(frozen=True, slots=True)
class Problem:
    """A problem that a reader found. `rule` names the rule that reports it."""

    rule: str
    place: Place
    message: str
    item: str = ""


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: `id` never changes its meaning; `about` states its requirement in one sentence.

    `severity` applies unless a rule pack specifies another one. A rule with severity OFF reports only if a rule pack enables it. `release`
    replaces the severity in the check of a release.
    """

    id: str
    severity: str
    about: str
    release: str = ""


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation of one rule at one location; `item` is the id of the affected item, or empty."""

    rule: str
    severity: str
    place: Place
    message: str
    item: str = ""

    def sort_key(self) -> tuple[str, int, str, str]:
        return (self.place.file, self.place.line, self.rule, self.message)
