# SPDX-License-Identifier: Apache-2.0
"""Renamed identifiers: a file that has no other changes keeps its stored result.

@satisfies SWR-VER-030      Design: docs/design/test_strength.md#stored-result
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from mamori_trace.base.errors import WorkError

LIST = Path(__file__).resolve().with_name("renamed.toml")
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


@cache
def read_renamed(path: Path = LIST) -> Mapping[bytes, bytes]:
    """The former name of each renamed identifier. @raise WorkError for a row that is ambiguous or not a pair of identifiers."""
    try:
        rows = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise WorkError(f"{path}: invalid TOML ({error}); correct it") from error
    former: dict[bytes, bytes] = {}
    for new, old in rows.items():
        if not isinstance(old, str) or not _IDENTIFIER.fullmatch(old) or not _IDENTIFIER.fullmatch(new):
            raise WorkError(f"{path}: '{new}': a row is new_name = \"former_name\", both C++ identifiers")
        if old in rows or old.encode() in former.values():
            raise WorkError(f"{path}: '{new}': '{old}' occurs in two rows; keep one row per identifier, from its first to its present name")
        former[new.encode()] = old.encode()
    return former


def restore_names(words: Iterable[bytes], former: Mapping[bytes, bytes]) -> list[bytes]:
    """The tokens with former names. If the file also contains the former name, both names stay, because they differ there."""
    found = list(words)
    present = set(found)
    return [former[word] if word in former and former[word] not in present else word for word in found]
