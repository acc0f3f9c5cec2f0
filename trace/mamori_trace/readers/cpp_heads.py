# SPDX-License-Identifier: Apache-2.0
"""Finds the tests of C++ frameworks by their macros, under the names that their results use (docs/manual/trace.md, Frameworks).

@satisfies SWR-TRC-104      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from typing import NamedTuple

from mamori_trace.model.evidence import ANY_SUITE
from mamori_trace.readers.cpp_plain import Plain, find_body

_MACRO = re.compile(r"(?:^|[;{}])[ \t]*([A-Z][A-Z0-9_]*)[ \t]*\(", re.MULTILINE)
_CODE = re.compile(r"(?:\s|#[ \t]*(?:if|ifdef|ifndef|elif|else|endif|pragma)\b[^\n]*)*+(\S)")
_FUNCTION = re.compile(r"[ \t]*(?:static[ \t]+)?void\s+(\w+)\s*\(")
_TEXT = re.compile(r'"((?:\\.|[^"\\])*)"')
_ESCAPE = re.compile(r"\\(.)")
_IDENTIFIER = re.compile(r"\w+")

_PAIR = {"TEST", "TEST_F", "TEST_P", "TYPED_TEST", "TYPED_TEST_P", "GTEST_TEST", "GTEST_TEST_F",
         "ZTEST", "ZTEST_F", "ZTEST_USER", "ZTEST_USER_F"}  # fmt: skip
"""Suite and name: GoogleTest, Unity fixtures, Zephyr."""
_FREE = {"TEST_CASE", "SCENARIO", "TEMPLATE_TEST_CASE", "TEMPLATE_TEST_CASE_SIG", "TEMPLATE_PRODUCT_TEST_CASE", "TEMPLATE_LIST_TEST_CASE",
         "TEST_CASE_TEMPLATE", "TEST_CASE_TEMPLATE_DEFINE"}  # fmt: skip
_FREE_FIXTURE = {"TEST_CASE_METHOD", "SCENARIO_METHOD", "TEMPLATE_TEST_CASE_METHOD", "TEMPLATE_TEST_CASE_METHOD_SIG",
                 "TEMPLATE_PRODUCT_TEST_CASE_METHOD", "TEMPLATE_LIST_TEST_CASE_METHOD", "TEST_CASE_FIXTURE"}  # fmt: skip
"""Free-text names: Catch2, doctest; for macros of the second kind, the fixture precedes the name."""
_BOOST = re.compile(r"BOOST_(?:AUTO|FIXTURE|DATA|AUTO_PARAM)_TEST_CASE(?:_F)?(?:_TEMPLATE)?")
_BOOST_SUITE = re.compile(r"BOOST_(?:AUTO|FIXTURE)_TEST_SUITE")
_BOOST_END = "BOOST_AUTO_TEST_SUITE_END"
_ARGUMENTS_MAX = 3


class Head(NamedTuple):
    """One test: the offset of its macro, its block in braces (empty without one), and its name in the results."""

    start: int
    begin: int
    end: int
    suite: str
    name: str


@dataclass(slots=True)
class CppHeads:
    """The tests of one file, in order."""

    plain: Plain
    shown: str
    heads: list[Head]

    def find_around(self, offset: int) -> Head | None:
        """The test whose block contains `offset`."""
        index = bisect_right([head.start for head in self.heads], offset) - 1
        head = self.heads[index] if index >= 0 else None
        return head if head is not None and (head.start <= offset < max(head.end, head.begin + 1)) else None

    def find_below(self, offset: int) -> Head | None:
        """The test that is the next declaration after `offset`, for known and unknown macros; None for anything else."""
        rest = _CODE.search(self.plain.shape, offset)
        if rest is None:
            return None
        at = rest.start(1)
        known = next((head for head in self.heads if head.start == at), None)
        if known is not None:
            return known
        macro = _MACRO.match(self.plain.shape, self.plain.shape.rfind("\n", 0, at) + 1)
        if macro is not None and macro.start(1) == at:
            return _make_head(self.plain, macro, self.shown, [], anything=True)
        function = _FUNCTION.match(self.plain.shape, at)
        if function is None:
            return None
        begin, end = find_body(self.plain.shape, function.end() - 1)
        return Head(at, begin, end, ANY_SUITE, function[1])


def list_cpp_heads(plain: Plain, shown: str) -> CppHeads:
    """All tests with known macros, except those in dead branches."""
    heads: list[Head] = []
    suites: list[str] = []
    for macro in _MACRO.finditer(plain.shape):
        if macro[1] == _BOOST_END:
            suites[-1:] = []
        elif _BOOST_SUITE.fullmatch(macro[1]):
            suites.append(next(iter(_read_arguments(plain, macro.end())), ""))
        else:
            head = _make_head(plain, macro, shown, suites)
            if head is not None:
                heads.append(head)
    return CppHeads(plain, shown, heads)


def _make_head(plain: Plain, macro: re.Match[str], shown: str, suites: list[str], anything: bool = False) -> Head | None:
    word = macro[1]
    plain_word = word.removeprefix("CATCH_").removeprefix("DOCTEST_")
    if not (anything or word in _PAIR or plain_word in _FREE or plain_word in _FREE_FIXTURE or _BOOST.fullmatch(word)):
        return None
    arguments = _read_arguments(plain, macro.end())
    begin, end = find_body(plain.shape, macro.end() - 1)
    suite, name = _name(word, plain_word, arguments, plain, shown, suites)
    return Head(macro.start(1), begin, end, suite, name) if name else None


def _name(word: str, plain_word: str, arguments: list[str], plain: Plain, shown: str, suites: list[str]) -> tuple[str, str]:
    """Suite and name; a star represents the types of a test with several types."""
    if not arguments or (plain_word in _FREE_FIXTURE and len(arguments) < 2):
        return "", ""
    if _BOOST.fullmatch(word):
        name = arguments[1] if word.endswith("_F") and len(arguments) > 1 else arguments[0]
        return ".".join(suites[-2:]), f"{name}<*>" if word.endswith("_TEMPLATE") else name
    if plain_word in _FREE or plain_word in _FREE_FIXTURE:
        is_doctest = plain_word == "TEST_CASE_FIXTURE" or "TEST_CASE_TEMPLATE" in plain_word or "doctest" in plain.code
        text = _read_text(arguments[1 if plain_word in _FREE_FIXTURE else 0])
        name = f"Scenario: {text}" if plain_word.startswith("SCENARIO") and text else text
        if name and ("TEMPLATE" in plain_word):
            name += "<*>" if is_doctest else " - *"
        fixture = arguments[0].rpartition("::")[2] if plain_word in _FREE_FIXTURE else "global"
        return shown.rpartition("/")[2] if is_doctest else fixture, name
    text = _read_text(arguments[0])
    if text:
        return ANY_SUITE, text
    if len(arguments) > 1 and _IDENTIFIER.fullmatch(arguments[1]):
        return arguments[0], arguments[1]
    return ANY_SUITE, arguments[0]


def _read_text(argument: str) -> str:
    """The string literal at the beginning of an argument; adjacent literals are joined."""
    pieces, at = [], 0
    while (match := _TEXT.match(argument, at)) is not None:
        pieces.append(_ESCAPE.sub(r"\1", match[1]))
        at = match.end()
        at += len(argument) - at - len(argument[at:].lstrip())
    return "".join(pieces).strip()


def _read_arguments(plain: Plain, begin: int) -> list[str]:
    """The first arguments of a call whose bracket opens directly before `begin`."""
    found: list[str] = []
    depth, last = 0, begin
    for match in re.compile(r"[()<>{},;]").finditer(plain.shape, begin):
        sign = match[0]
        if sign == ";" or (depth == 0 and sign in ",)"):
            found.append(plain.code[last : match.start()].strip())
            last = match.end()
            if sign in ");" or len(found) == _ARGUMENTS_MAX:
                break
        depth += {"(": 1, "{": 1, "<": 1, ")": -1, "}": -1, ">": -1}.get(sign, 0)
    return [each for each in found if each] if found[:1] != [""] else []
