# SPDX-License-Identifier: Apache-2.0
"""Finds death tests that accept any cause of death, because their pattern also matches unrelated output.

@satisfies SWR-VER-024      Design: docs/design/test_strength.md#death-tests
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

DEATH_TEST = re.compile(r"\b(?:EXPECT|ASSERT)_(?:DEBUG_)?(?:DEATH|EXIT)(?:_IF_SUPPORTED)?\s*\(")
TEXT = re.compile(r'R"(?P<mark>[^\s()\\]*)\((?P<raw>.*?)\)(?P=mark)"|(?P<plain>"(?:\\.|[^"\\\n])*")', re.DOTALL)
MASKED = re.compile(rf"//[^\n]*|/\*.*?\*/|'(?:\\[^'\n]+|[^'\\\n])'|{TEXT.pattern}", re.DOTALL)
# Permitted text around a literal: none, a constructor or a matcher, or the suffix of a std::string.
AROUND_LITERAL = re.compile(r"(?:[\w:]+\s*[({]\s*[)}])?s?")
EMPTY_STRING = re.compile(r"std::string(?:_view)?\s*[({]\s*[)}]")
# Output of a program that dies of another cause. No literal of a test contains its first character.
UNRELATED_OUTPUT = (
    "\x01", "\x01\n\x01", "==7==ERROR: AddressSanitizer: SEGV on unknown address 0x000000000000",
    "unit.cpp:7:9: runtime error: signed integer overflow", "free(): invalid pointer", "terminate called after throwing an instance",
)  # fmt: skip
WILDCARD = re.compile(r"(?:(?:::)?testing\s*::\s*)?_")


def check_death_tests(text: str) -> Iterator[tuple[int, str]]:
    """@return (line, message) for each death test whose pattern accepts unrelated output. Computed patterns are not checked."""
    code = MASKED.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for call in DEATH_TEST.finditer(code):
        first, last = _find_last_argument(code, call.end())
        around = code[first:last].strip()
        literals = [_read(match) for match in MASKED.finditer(text, first, last) if match["raw"] is not None or match["plain"]]
        is_literal = literals and AROUND_LITERAL.fullmatch(around)
        accepts_any = (is_literal or EMPTY_STRING.fullmatch(around)) and _accepts_unrelated("".join(literals))
        if accepts_any or WILDCARD.fullmatch(around):
            yield (code.count("\n", 0, call.start()) + 1,
                   f"{call[0].rstrip('( ')} accepts any death; use EXPECT_CHECK_FAILS, or state the expected output ('^$': none)")  # fmt: skip


def _find_last_argument(code: str, start: int) -> tuple[int, int]:
    """@return begin and end of the last argument of the macro. As in the preprocessor, only parentheses protect commas."""
    first, depth = start, 1
    for place in range(start, len(code)):
        depth += {"(": 1, ")": -1}.get(code[place], 0)
        if depth == 0:
            return first, place
        if depth == 1 and code[place] == ",":
            first = place + 1
    return first, len(code)


def _read(literal: re.Match[str]) -> str:
    return literal["raw"] if literal["plain"] is None else str(ast.literal_eval(literal["plain"]))


def _accepts_unrelated(pattern: str) -> bool:
    try:
        usual = re.compile(re.sub(r"\[:\w+:\]", r"\\w", pattern))
    except re.error:  # an invalid pattern; GoogleTest reports it at run time
        return False
    return any(usual.search(output) for output in UNRELATED_OUTPUT)
