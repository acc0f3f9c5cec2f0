# SPDX-License-Identifier: Apache-2.0
"""The table `[cost]` of a `timing.toml`: input classes, margin of the budgets, and permitted growth of a count.

@satisfies SWR-TIM-031      Design: docs/design/cost.md#input-classes
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.host.project import Project
from mamori_tools.timing.system import FILE, System, read_words
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

KEYS = ("margin_percent", "growth_percent", "class")
CLASS_KEYS = ("name", "cycles", "first", "every", "arguments")
NAME = re.compile(r"[A-Za-z0-9_-]{1,40}")
CYCLES_MAX = 1_000_000
COUNTED_MAX = 20_000
"""Maximum number of counted cycles; each counted step takes milliseconds."""
PERCENT_MAX = 1000.0
GROWTH_PERCENT = 2.0


@dataclass(frozen=True)
class InputClass:
    """Inputs that execute some of the branches of a system: the declared `arguments` of its program.

    The major frames `first`, `first + every`, ... below `cycles` are counted.
    """

    name: str
    cycles: int
    first: int
    every: int
    arguments: tuple[str, ...]
    words: tuple[str, ...]
    """The arguments in the form for the program."""


@dataclass(frozen=True)
class CostPlan:
    """Input classes and limits [percent]. A budget must be at least the measured maximum plus `margin_percent`; a maximum may be at most
    that of the baseline plus `growth_percent`."""

    margin_percent: float
    growth_percent: float
    classes: tuple[InputClass, ...]


def read_plan(system: System, project: Project) -> CostPlan:
    """@raise InputError if the table of the system is missing or invalid."""
    if system.file is None:
        raise InputError(f"cost: '{system.program.name}' has no input classes; name a folder with a {FILE} that has a [cost]")
    if not system.cost:
        raise InputError("has no [cost] with a margin_percent and at least one [[cost.class]]; docs/manual/cost.md shows one", system.file)
    data, file = system.cost, system.file
    _refuse_unknown(data, KEYS, "[cost]", file)
    rows = data.get("class", [])
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise InputError("[cost] has no [[cost.class]]; declare at least one class of inputs", file)
    classes = tuple(_read_class(row, project, file) for row in rows)
    names = [one.name for one in classes]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InputError(f"two classes of inputs have the name '{twice[0]}'; give each its own", file)
    if "margin_percent" not in data:
        raise InputError("[cost] has no margin_percent; declare how much a budget is to have over the measured maximum", file)
    return CostPlan(_read_percent(data["margin_percent"], "margin_percent", file),
                    _read_percent(data.get("growth_percent", GROWTH_PERCENT), "growth_percent", file), classes)  # fmt: skip


def choose(plan: CostPlan, names: Sequence[str]) -> tuple[InputClass, ...]:
    """Classes with these names; all without names. @raise InputError for an unknown name."""
    known = [one.name for one in plan.classes]
    for name in names:
        if name not in known:
            raise InputError(f"cost: there is no class of inputs '{name}'; {nearest_names(name, known)}")
    return tuple(one for one in plan.classes if not names or one.name in names)


def _read_class(row: dict[str, Any], project: Project, file: Path) -> InputClass:
    name = row.get("name")
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise InputError("a [[cost.class]] has no name of 1 to 40 letters, digits, '_' and '-'", file)
    what = f"class '{name}'"
    _refuse_unknown(row, CLASS_KEYS, what, file)
    cycles = _read_count(row, "cycles", 1, CYCLES_MAX, what, file)
    first = _read_count(row, "first", 0, cycles - 1, what, file)
    every = _read_count(row, "every", 1, CYCLES_MAX, what, file)
    counted = -(-(cycles - first) // every)
    if counted > COUNTED_MAX:
        raise InputError(f"{what} would count {counted} cycles, at most {COUNTED_MAX}; raise 'first' or 'every'", file)
    words = read_words(row.get("arguments", []), f"'arguments' of {what}", project, file)
    return InputClass(name, cycles, first, every, tuple(row.get("arguments", [])), words)


def _read_count(row: dict[str, Any], key: str, least: int, most: int, what: str, file: Path) -> int:
    value = row.get(key, least if key != "cycles" else None)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise InputError(f"{what}: '{key}' must be an integer of {least} .. {most}", file)
    return value


def _read_percent(value: object, key: str, file: Path) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 <= value <= PERCENT_MAX:
        raise InputError(f"[cost]: '{key}' must be a number of 0 .. {PERCENT_MAX:g}", file)
    return float(value)


def _refuse_unknown(data: dict[str, Any], known: tuple[str, ...], what: str, file: Path) -> None:
    for key in data:
        if key not in known:
            raise InputError(f"{what} has an unknown key '{key}'; {nearest_names(key, known)}", file)
