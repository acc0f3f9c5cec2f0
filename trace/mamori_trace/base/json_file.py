# SPDX-License-Identifier: Apache-2.0
"""Reads one JSON evidence file with a schema key (docs/design/trace.md#evidence-files), and checks its content.

@satisfies SWR-TRC-009, SWR-TRC-016      Design: docs/design/trace.md#evidence-files
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text
from mamori_trace.base.finding import Place, Problem

_WHOLE_MAX = 2**63
"""Integers in evidence have at most 64 bits. Larger ones are invalid, because some could not be converted to float."""


@dataclass(frozen=True, slots=True)
class Maybe:
    """A value of `shape`, or null."""

    shape: Any


@dataclass(frozen=True, slots=True)
class Each:
    """A table with any keys, all of whose values have `shape`."""

    shape: Any


def read_json(path: Path, schema: str, root: Path, problems: list[Problem]) -> tuple[dict[str, Any], str] | None:
    """Content and text. @return None if the file has no usable content, after reporting a problem."""
    shown = get_shown_path(path, root)
    text = read_text(path, shown, problems)
    if not text and any(problem.place.file == shown for problem in problems):
        return None
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        problems.append(Problem(UNREADABLE, Place(shown, error.lineno), f"is not whole JSON ({error.msg}); make it again"))
        return None
    except RecursionError:
        problems.append(Problem(UNREADABLE, Place(shown, 1), "is nested too deeply to be evidence; make it again"))
        return None
    except ValueError:  # an integer of thousands of digits
        problems.append(Problem(UNREADABLE, Place(shown, 1), "holds a number that is too long to be evidence; make it again"))
        return None
    if not isinstance(content, dict) or content.get("schema") != schema:
        found = content.get("schema") if isinstance(content, dict) else type(content).__name__
        problems.append(Problem(UNREADABLE, Place(shown, 1), f"schema is {found!r}; this tool reads {schema!r}"))
        return None
    return content, text


def read_records(
    files: Iterable[Path], schema: str, shape: object, remedy: str, root: Path, problems: list[Problem]
) -> Iterator[tuple[Path, dict[str, Any], Place]]:
    """Each valid file with its content and location; an invalid file becomes a problem. @param remedy the correction to report."""
    for path in files:
        table = read_json(path, schema, root, problems)
        if table is None:
            continue
        place = Place(get_shown_path(path, root), 1)
        misfit = find_misfit(table[0], shape, "")
        if misfit:
            problems.append(Problem(UNREADABLE, place, f"{misfit}; {remedy}"))
        else:
            yield path, table[0], place


def find_misfit(value: Any, shape: Any, name: str) -> str:
    """Describes the first mismatch with its location in the file (`windows[2].budget_ns is not an integer`); empty if all values match.

    `shape`: `int`, `float` (any finite number), `str`, `bool`; `[shape]`: a list of such values; a table from keys to shapes: the required
    keys; `Maybe`, `Each`. The recursion depth depends on the shape only, not on `value`.
    """
    if isinstance(shape, Maybe):
        return "" if value is None else find_misfit(value, shape.shape, name)
    if isinstance(shape, list):
        if not isinstance(value, list):
            return f"{name} is no list"
        return _find_first((one, shape[0], f"{name}[{index}]") for index, one in enumerate(value))
    if isinstance(shape, dict | Each):
        if not isinstance(value, dict):
            return f"{name or 'the content'} is no table"
        if isinstance(shape, Each):
            return _find_first((key, str, f"a key of {name}") for key in value) or _find_first(
                (one, shape.shape, _join(name, key)) for key, one in value.items()
            )
        absent = [key for key in shape if key not in value]
        if absent:
            return f"{_join(name, absent[0])} is missing"
        return _find_first((value[key], inner, _join(name, key)) for key, inner in shape.items())
    fits, otherwise = _LEAVES[shape]
    return "" if fits(value) else f"{name} is {otherwise}"


def _find_first(parts: Iterable[tuple[Any, Any, str]]) -> str:
    return next((misfit for part in parts if (misfit := find_misfit(*part))), "")


def _join(name: str, key: str) -> str:
    return f"{name}.{key}" if name else key


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and -_WHOLE_MAX <= value < _WHOLE_MAX


def _is_text(value: object) -> bool:
    """Rejects half of a surrogate pair, which cannot be encoded."""
    return isinstance(value, str) and not any("\ud800" <= letter <= "\udfff" for letter in value)


_LEAVES: dict[type, tuple[Callable[[Any], bool], str]] = {
    int: (_is_whole, "not an integer"),
    float: (lambda value: _is_whole(value) or (isinstance(value, float) and math.isfinite(value)), "no number"),
    str: (_is_text, "no text"),
    bool: (lambda value: isinstance(value, bool), "no truth value"),
}
