# SPDX-License-Identifier: Apache-2.0
"""Reads one number of a motion file."""

from __future__ import annotations

import math
from pathlib import Path

from mamori_trace.base.errors import InputError

_NOT_FINITE = frozenset({".nan", ".inf", "-.inf", "+.inf"})
_SHOWN = 24


def parse_number(word: str, path: Path, line: int, what: str) -> float:
    """The finite number in `word`. Raises InputError with `what` if there is none."""
    try:
        # float() also accepts 1_000 and digits of other scripts; motion files contain neither.
        number = float(word) if word.isascii() and "_" not in word else None
    except ValueError:
        number = math.nan if word.lower() in _NOT_FINITE else None
    if number is None:
        shown = word if len(word) <= _SHOWN else word[:_SHOWN] + ".."
        raise InputError(f"{what} is '{shown}', no number; write a decimal number", path, line)
    if not math.isfinite(number):
        raise InputError(f"{what} is {word}, not finite; write a finite number", path, line)
    return number
