# SPDX-License-Identifier: Apache-2.0
"""One value of a JSON document; its errors name its location in the document.

@satisfies SWR-TAB-008      Design: docs/design/cost.md#schema
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

HOW_TO_FIX = "write it again with mamori::table_dump"


class JsonNode:
    """One JSON value with its location, which every error message names."""

    def __init__(self, path: Path, place: str, value: object, mend: str = HOW_TO_FIX) -> None:
        self._path = path
        self._place = place
        self._value = value
        self._mend = mend

    def complain(self, text: str) -> InputError:
        return InputError(f"{self._place} {text}; {self._mend}", self._path)

    def at(self, key: str) -> JsonNode:
        place = f"{self._place}.{key}" if self._place != "the table" else key
        if not isinstance(self._value, dict):
            raise self.complain("must be an object")
        if key not in self._value:
            raise self.complain(f"has no '{key}'")
        return JsonNode(self._path, place, self._value[key], self._mend)

    def has(self, key: str) -> bool:
        return isinstance(self._value, dict) and key in self._value

    def items(self) -> list[JsonNode]:
        if not isinstance(self._value, list):
            raise self.complain("must be a list")
        return [JsonNode(self._path, f"{self._place}[{index}]", value, self._mend) for index, value in enumerate(self._value)]

    def is_none(self) -> bool:
        return self._value is None

    def items_or_none(self) -> list[JsonNode] | None:
        return None if self._value is None else self.items()

    def text(self, known: tuple[str, ...] = ()) -> str:
        if not isinstance(self._value, str):
            raise self.complain("must be a text")
        if known and self._value not in known:
            raise self.complain(f"is '{self._value}'; {nearest_names(self._value, known)}")
        return self._value

    def truth(self) -> bool:
        if not isinstance(self._value, bool):
            raise self.complain("must be true or false")
        return self._value

    def whole(self) -> int:
        if not isinstance(self._value, int) or isinstance(self._value, bool) or abs(self._value) >= 2**64:
            raise self.complain("must be an integer of 64 bits")
        return self._value

    def count(self) -> int:
        if self.whole() < 0:
            raise self.complain("must not be negative")
        return self.whole()

    def whole_or_none(self) -> int | None:
        return None if self._value is None else self.whole()

    def real_or_none(self) -> float | None:
        if self._value is None:
            return None
        if not isinstance(self._value, int | float) or isinstance(self._value, bool):
            raise self.complain("must be a number or null")
        try:
            return float(self._value)
        except OverflowError as error:
            raise self.complain("is greater than any number of 64 bits") from error

    def number_or_none(self) -> float | int | None:
        """An integer keeps all its digits."""
        is_whole = isinstance(self._value, int) and not isinstance(self._value, bool)
        return self.whole() if is_whole else self.real_or_none()

    def index(self, size: int) -> int:
        if not 0 <= self.whole() < size:
            raise self.complain(f"is {self._value}, beyond the {size} rows it points into")
        return self.whole()

    def index_or_none(self, size: int) -> int | None:
        return None if self._value is None else self.index(size)
