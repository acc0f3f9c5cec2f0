# SPDX-License-Identifier: Apache-2.0
"""A constraint as data, in the canonical form of the RTC Profile's notation, and as the typed constraint of the kernel.

@satisfies SWR-PAR-001      Design: docs/design/parameters.md#notation
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_tools.profiles.scalar_type import BOOL, FLOAT, ScalarType, Value


@dataclass(frozen=True)
class Range:
    """Values between two limits. None: no limit."""

    lower: Value | None = None
    upper: Value | None = None
    is_lower_open: bool = False
    is_upper_open: bool = False

    @property
    def is_one_value(self) -> bool:
        return self.lower is not None and self.lower == self.upper


@dataclass(frozen=True)
class Constraint:
    """One item for all elements, or one for each. The value of an element may be in any range of its item."""

    type: ScalarType
    items: tuple[tuple[Range, ...], ...]

    def format_canonical(self) -> str:
        """The canonical text of this constraint. It has no names of elements, no spaces and no duplicate choices."""
        return ",".join(self._format_item(item) for item in self.items)

    def format_cpp(self) -> str:
        """The arguments of mamori::Parameter after the default value."""
        return ", ".join(self._format_cpp_item(item) for item in self.items)

    def _format_item(self, item: tuple[Range, ...]) -> str:
        first = item[0]
        if len(item) > 1 or (first.is_one_value and self.type.names):
            return f"({','.join(self._format_choice(choice) for choice in item)})"
        return self._format_choice(first) if first.is_one_value else self._format_limits(first)

    def _format_choice(self, choice: Range) -> str:
        assert choice.lower is not None
        return self.type.names[int(choice.lower)] if self.type.names else self.type.format(choice.lower)

    def _format_limits(self, limits: Range) -> str:
        lower = "" if limits.lower is None else self.type.format(limits.lower)
        upper = "" if limits.upper is None else self.type.format(limits.upper)
        if lower and upper:
            return f"{lower}{'<' if limits.is_lower_open else '<='}x{'<' if limits.is_upper_open else '<='}{upper}"
        if lower:
            return f"x{'>' if limits.is_lower_open else '>='}{lower}"
        return f"x{'<' if limits.is_upper_open else '<='}{upper}" if upper else ""

    def _format_cpp_item(self, item: tuple[Range, ...]) -> str:
        if len(item) > 1 or item[0].is_one_value:
            return f"mamori::one_of({', '.join(self._format_literal(choice.lower) for choice in item)})"
        only = item[0]
        if only.lower is None and only.upper is None:
            return "mamori::any_value()"
        lower = f"mamori::{'above' if only.is_lower_open else 'at_least'}({self._format_literal(only.lower)})"
        upper = f"mamori::{'below' if only.is_upper_open else 'at_most'}({self._format_literal(only.upper)})"
        if only.lower is None or only.upper is None:
            return upper if only.lower is None else lower
        if only.is_lower_open or only.is_upper_open:
            return f"mamori::between({lower}, {upper})"
        return f"mamori::between({self._format_literal(only.lower)}, {self._format_literal(only.upper)})"

    def _format_literal(self, value: Value | None) -> str:
        if value is None:
            return ""
        if self.type == BOOL:
            return self.type.names[int(value)]
        if self.type.names:
            return f"{self.type.name}::{name_enumerator(self.type.names[int(value)])}"
        text = self.type.format(value)
        if self.type.is_real:
            return f"{text}{'' if '.' in text or 'e' in text else '.0'}{'F' if self.type == FLOAT else ''}"
        suffix = "ULL" if self.type.maximum >= 2**63 else "LL" if self.type.maximum >= 2**31 else ""
        if value in (-(2**31), -(2**63)) and value == self.type.lowest:
            return f"({int(value) + 1}{suffix} - 1)"  # the type cannot represent the number without its sign
        return text + suffix


def name_enumerator(name: str) -> str:
    """`very_slow` becomes the enumerator `kVerySlow`."""
    return "k" + "".join(part[:1].upper() + part[1:] for part in name.split("_"))
