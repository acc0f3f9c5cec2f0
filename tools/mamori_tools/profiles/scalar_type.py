# SPDX-License-Identifier: Apache-2.0
"""The element types of parameters, and how each represents a decimal number.

@satisfies SWR-PAR-001      Design: docs/design/parameters.md#notation
"""

from __future__ import annotations

import math
import re
import struct
from dataclasses import dataclass
from decimal import Decimal

Value = float | int
EXPONENT_DIGITS_MAX = 9
"""Longer exponents are shortened to 9 digits; the number is out of range in both cases."""
EXPONENT = re.compile(r"(?<=[eE])([+-]?)0*(\d+)$", re.ASCII)


@dataclass(frozen=True)
class ScalarType:
    """Type of an element. In a type with `names`, value i has name number i."""

    name: str
    """As in C++."""
    lowest: int = 0
    maximum: int = 0
    names: tuple[str, ...] = ()
    is_real: bool = False

    def read(self, text: str) -> Value | None:
        """The nearest value; for a real type with ties to even. None: the type cannot represent the number.
        @param text sign, digits with at most one point, exponent."""
        text = EXPONENT.sub(lambda match: match[1] + (match[2] if len(match[2]) <= EXPONENT_DIGITS_MAX else "9" * EXPONENT_DIGITS_MAX), text)
        if not self.is_real:
            exact = Decimal(text)
            is_value = self.lowest <= exact <= self.maximum and Decimal(int(exact)) == exact
            return int(exact) if is_value else None
        value = _round_to_single(text) if self == FLOAT else float(text)
        is_lost = value == 0 and re.search("[1-9]", re.split("[eE]", text)[0]) is not None
        return value if math.isfinite(value) and not is_lost else None

    def format(self, value: Value) -> str:
        """The shortest decimal number that converts to `value`."""
        if not self.is_real:
            return str(int(value))
        text = repr(float(value))
        if self == FLOAT:
            text = repr(float(next(short for digits in range(1, 10) if self.read(short := f"{value:.{digits}g}") == value)))
        return text.removesuffix(".0")


def _round_to_single(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        return value
    exact = Decimal(text)
    is_even = int.from_bytes(struct.pack("<d", value), "little") % 2 == 0
    if exact != Decimal(value) and is_even:  # rounding to odd, so that the second rounding gives the result of a single rounding
        value = math.nextafter(value, math.inf if exact > Decimal(value) else -math.inf)
    try:
        single: float = struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return single


DOUBLE = ScalarType("double", is_real=True)
FLOAT = ScalarType("float", is_real=True)
BOOL = ScalarType("bool", 0, 1, ("false", "true"))
INTEGERS = tuple(
    integer for bits in (8, 16, 32, 64)
    for integer in (ScalarType(f"std::int{bits}_t", -(2 ** (bits - 1)), 2 ** (bits - 1) - 1), ScalarType(f"std::uint{bits}_t", 0, 2**bits - 1)))  # fmt: skip
TYPES = {type_.name: type_ for type_ in (DOUBLE, FLOAT, BOOL, ScalarType("int", -(2**31), 2**31 - 1), *INTEGERS)}


def make_enumeration(name: str, names: tuple[str, ...]) -> ScalarType:
    """@param names of the enumerators 0, 1, ..., as in a configuration file."""
    return ScalarType(name, 0, len(names) - 1, names)
