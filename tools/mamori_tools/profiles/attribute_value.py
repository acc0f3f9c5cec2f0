# SPDX-License-Identifier: Apache-2.0
"""Values of attributes: whether a value has its type, and the value that the writer probably meant.

@satisfies SWR-PFL-005      Design: docs/design/profiles.md#tolerant-mode
"""

from __future__ import annotations

import re
from datetime import datetime

DOUBLE = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?|-?INF|NaN")
INTEGER = re.compile(r"[+-]?[0-9]{1,24}")
DATE = re.compile(r"([0-9]{4})-([0-9]{2})-([0-9]{2})T([0-9]{2}):([0-9]{2}):([0-9]{2})(\.[0-9]+)?(Z|[+-][0-9]{2}:[0-9]{2})?")
LOOSE_DATE = re.compile(r"([0-9]{4})[-/.]([0-9]{1,2})[-/.]([0-9]{1,2})(?:[T ]+([0-9]{1,2}):([0-9]{1,2})(?::([0-9]{1,2})(\.[0-9]+)?)?)?"
                        r" *(Z|[+-][0-9]{2}:?[0-9]{2})?")  # fmt: skip
BOOLEANS = {"true": "true", "yes": "true", "on": "true", "1": "true", "false": "false", "no": "false", "off": "false", "0": "false"}
TYPING_ERRORS = {"periodoc": "periodic"}
"""Known wrong spellings in files of other tools."""


def is_of_type(value: str, type_: str, names: tuple[str, ...]) -> bool:
    """@param names allowed values of an enumeration, else empty."""
    if names:
        return value in names
    bare = value.strip()
    match type_:
        case "boolean":
            return bare in ("true", "false", "0", "1")
        case "integer":
            return INTEGER.fullmatch(bare) is not None
        case "double":
            return DOUBLE.fullmatch(bare) is not None
        case "dateTime":
            return _is_date(bare)
        case _:
            return True


def find_meant(value: str, type_: str, names: tuple[str, ...]) -> str | None:
    """@return the value of the type that differs only in case, separators or a known typing error; else None."""
    bare = value.strip()
    if names:
        return _find_name(bare, names)
    match type_:
        case "boolean":
            return BOOLEANS.get(bare.lower())
        case "integer" if DOUBLE.fullmatch(bare) and bare[-1].isdigit() and float(bare).is_integer() and abs(float(bare)) < 1e15:
            return str(int(float(bare)))
        case "dateTime":
            return _read_date(bare)
        case _:
            return None


def _find_name(value: str, names: tuple[str, ...]) -> str | None:
    folded = {_fold(name): name for name in names}
    return folded.get(TYPING_ERRORS.get(_fold(value), _fold(value)))


def _fold(name: str) -> str:
    return re.sub(r"[ _-]", "", name).lower()


def _is_date(value: str) -> bool:
    match = DATE.fullmatch(value)
    return match is not None and _is_calendar_date(match)


def _is_calendar_date(match: re.Match[str]) -> bool:
    try:
        datetime(*(int(part or 0) for part in match.groups()[:6]))  # type: ignore[arg-type]  # six integers
    except ValueError:
        return False
    return True


def _read_date(value: str) -> str | None:
    match = LOOSE_DATE.fullmatch(value)
    if match is None or not _is_calendar_date(match):
        return None
    year, *rest = (int(part or 0) for part in match.groups()[:6])
    zone = match[8] or ""
    zone = zone if len(zone) != 5 else f"{zone[:3]}:{zone[3:]}"
    return "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}".format(year, *rest) + (match[7] or "") + zone
