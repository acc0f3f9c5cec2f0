# SPDX-License-Identifier: Apache-2.0
"""Reads a constraint in the notation of the RTC Profile. Reading ends at the first violated rule.

@satisfies SWR-PAR-001      Design: docs/design/parameters.md#notation
Source: RTC Profile 0.2/0.3, attribute `constraint` of a configuration parameter, as RTSystemEditor reads it
"""

from __future__ import annotations

import re
from dataclasses import replace
from enum import Enum
from typing import NoReturn

from mamori_tools.profiles.constraint import Constraint, Range
from mamori_tools.profiles.scalar_type import ScalarType, Value

WORD = re.compile(r"[A-Za-z0-9_]*")
DIGITS = re.compile(r"[+-]?[0-9]*\.?[0-9]*")
EXPONENT = re.compile(r"[eE][+-]?([0-9]*)")
SPACES = re.compile(r"[ \t]*")


class Rule(Enum):
    """Possible errors. The value is the sentence in messages."""

    NUMBER_EXPECTED = "a number is expected here"
    NOT_IN_TYPE = "the type does not have this value"
    NAME_UNKNOWN = "the type has no value of this name"
    VARIABLE_EXPECTED = "x is expected here"
    COMPARISON_EXPECTED = "<, <=, > or >= is expected here"
    DIRECTIONS_DIFFER = "both comparisons must have the same direction"
    RANGE_EMPTY = "no value is between these limits"
    KEY_EXPECTED = "the name of an element is expected here"
    KEY_DUPLICATE = "this name was used before"
    COLON_EXPECTED = "a colon is expected here"
    BRACKET_EXPECTED = "the closing bracket or a comma is expected here"
    TEXT_AFTER_END = "nothing or a comma is expected here"
    ELEMENT_COUNT = "a list has one constraint for each element"


class ConstraintError(ValueError):
    """A violated rule and the first violating character, counted from 0."""

    def __init__(self, rule: Rule, position: int) -> None:
        super().__init__(f"{rule.value} (column {position + 1})")
        self.rule = rule
        self.position = position


def parse_constraint(text: str, type_: ScalarType, element_count: int = 1) -> Constraint:
    """@param element_count 1 or more. @raise ConstraintError"""
    return _Parser(text, type_, element_count).parse()


class _Parser:
    """One pass from left to right. Each iteration of a loop consumes at least one character."""

    def __init__(self, text: str, type_: ScalarType, element_count: int) -> None:
        self._text = text
        self._type = type_
        self._element_count = element_count
        self._at = 0

    def parse(self) -> Constraint:
        self._skip_spaces()
        is_named = self._take("{")
        items = self._parse_named_list() if is_named else self._parse_list()
        if len(items) < self._element_count and (is_named or len(items) > 1):
            self._reject(Rule.ELEMENT_COUNT)
        self._skip_spaces()
        if self._at < len(self._text):
            self._reject(Rule.TEXT_AFTER_END)
        return Constraint(self._type, tuple(items))

    def _reject(self, rule: Rule, position: int | None = None) -> NoReturn:
        raise ConstraintError(rule, self._at if position is None else position)

    def _is_at(self, characters: str) -> bool:
        return self._at < len(self._text) and self._text[self._at] in characters

    def _take(self, character: str) -> bool:
        is_here = self._is_at(character)
        self._at += is_here
        return is_here

    def _take_match(self, pattern: re.Pattern[str]) -> str:
        match = pattern.match(self._text, self._at)
        self._at += len(match[0]) if match else 0
        return match[0] if match else ""

    def _skip_spaces(self) -> None:
        self._take_match(SPACES)

    def _parse_list(self) -> list[tuple[Range, ...]]:
        items = [self._parse_item(0)]
        while self._take(","):
            items.append(self._parse_item(len(items)))
        return items

    def _parse_named_list(self) -> list[tuple[Range, ...]]:
        keys: set[str] = set()
        items = [self._parse_entry(0, keys)]
        while self._take(","):
            items.append(self._parse_entry(len(items), keys))
        if not self._take("}"):
            self._reject(Rule.BRACKET_EXPECTED)
        return items

    def _parse_entry(self, element: int, keys: set[str]) -> tuple[Range, ...]:
        self._skip_spaces()
        position = self._at
        key = self._take_match(WORD)
        if not key:
            self._reject(Rule.KEY_EXPECTED)
        if key in keys:
            self._reject(Rule.KEY_DUPLICATE, position)
        keys.add(key)
        self._skip_spaces()
        if not self._take(":"):
            self._reject(Rule.COLON_EXPECTED)
        return self._parse_item(element)

    def _parse_item(self, element: int) -> tuple[Range, ...]:
        self._skip_spaces()
        if element >= self._element_count:
            self._reject(Rule.ELEMENT_COUNT)
        position = self._at
        if self._at == len(self._text) or self._is_at(",}"):
            item: tuple[Range, ...] = (Range(),)
        elif self._take("("):
            item = self._parse_choices()
        elif self._take("x"):
            item = (self._check(self._parse_comparison(Range()), position),)
        else:
            item = (self._check(self._parse_from_number(), position),)
        self._skip_spaces()
        return item

    def _parse_choices(self) -> tuple[Range, ...]:
        choices = [self._parse_choice()]
        while self._take(","):
            choices.append(self._parse_choice())
        if not self._take(")"):
            self._reject(Rule.BRACKET_EXPECTED)
        return tuple(dict.fromkeys(choices))

    def _parse_choice(self) -> Range:
        self._skip_spaces()
        position = self._at
        word = "" if self._is_at("0123456789") else self._take_match(WORD)
        if word and word not in self._type.names:
            self._reject(Rule.NAME_UNKNOWN, position)
        value = self._type.names.index(word) if word else self._take_number()
        self._skip_spaces()
        return Range(value, value)

    def _parse_from_number(self) -> Range:
        """A single number, or a number that is compared with x."""
        number = self._take_number()
        self._skip_spaces()
        if self._is_at("="):
            self._reject(Rule.COMPARISON_EXPECTED)
        if not self._is_at("<>"):
            return Range(number, number)
        is_less, is_open = self._take_comparison()
        limits = self._narrow(Range(), not is_less, is_open, number)  # 1<x means x>1
        self._skip_spaces()
        if not self._take("x"):
            self._reject(Rule.VARIABLE_EXPECTED)
        self._skip_spaces()
        if not self._is_at("<>"):
            return limits
        if self._is_at("<") != is_less:
            self._reject(Rule.DIRECTIONS_DIFFER)
        return self._parse_comparison(limits)

    def _parse_comparison(self, limits: Range) -> Range:
        """Comparison and number that follow x."""
        is_less, is_open = self._take_comparison()
        return self._narrow(limits, is_less, is_open, self._take_number())

    def _take_comparison(self) -> tuple[bool, bool]:
        self._skip_spaces()
        is_less = self._take("<")
        if not is_less and not self._take(">"):
            self._reject(Rule.COMPARISON_EXPECTED)
        return is_less, not self._take("=")

    @staticmethod
    def _narrow(limits: Range, is_less: bool, is_open: bool, limit: Value) -> Range:
        """`x` compared with `limit`."""
        if is_less:
            return replace(limits, upper=limit, is_upper_open=is_open)
        return replace(limits, lower=limit, is_lower_open=is_open)

    def _take_number(self) -> Value:
        self._skip_spaces()
        position = self._at
        digits = self._take_match(DIGITS)
        if not any(character.isdigit() for character in digits):
            self._reject(Rule.NUMBER_EXPECTED)
        exponent = EXPONENT.match(self._text, self._at)
        if exponent:
            self._at = exponent.end()
            if not exponent[1]:
                self._reject(Rule.NUMBER_EXPECTED)
        value = self._type.read(self._text[position : self._at])
        if value is None:
            self._reject(Rule.NOT_IN_TYPE, position)
        return value

    def _check(self, limits: Range, position: int) -> Range:
        if self._is_empty(limits):
            self._reject(Rule.RANGE_EMPTY, position)
        return limits

    def _is_empty(self, limits: Range) -> bool:
        """For real limits, the number of representable values in between is not checked."""
        if self._type.is_real:
            if limits.lower is None or limits.upper is None:
                return False
            return limits.lower > limits.upper or (limits.lower == limits.upper and (limits.is_lower_open or limits.is_upper_open))
        lower = self._type.lowest if limits.lower is None else limits.lower + limits.is_lower_open
        upper = self._type.maximum if limits.upper is None else limits.upper - limits.is_upper_open
        return lower > upper
