# SPDX-License-Identifier: Apache-2.0
"""JSON whose keys have locations: duplicate keys are detected, and each member has its line."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from typing import Any

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Place, Problem


class Table(dict):
    """A JSON object that also keeps its members in file order, including duplicates."""

    def __init__(self, pairs: list[tuple[str, Any]]) -> None:
        super().__init__(pairs)
        self.pairs = pairs


def parse_json(text: str, shown: str, problems: list[Problem]) -> Any:
    """The content, or None and one problem."""
    try:
        return json.loads(text, object_pairs_hook=Table)
    except json.JSONDecodeError as error:
        problems.append(Problem(UNREADABLE, Place(shown, error.lineno), f"is not whole JSON ({error.msg}); make it again"))
    except (RecursionError, ValueError):
        problems.append(Problem(UNREADABLE, Place(shown, 1), "is nested too deeply or holds a number that is too long"))
    return None


class Lines:
    """Line numbers of one text."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def get_line(self, offset: int) -> int:
        return bisect_right(self._starts, offset)

    def find_key(self, key: str, start: int, end: int | None = None, opens: str = "") -> int:
        """Offset of the next member `key` at or after `start`; -1 if there is none. `opens`: first characters of its value."""
        spellings = {re.escape(json.dumps(key)), re.escape(json.dumps(key, ensure_ascii=False))}
        pattern = re.compile(rf"(?<!\\)(?:{'|'.join(sorted(spellings))})\s*:\s*{re.escape(opens)}")
        match = pattern.search(self._text, start, len(self._text) if end is None else end)
        return match.start() if match else -1
