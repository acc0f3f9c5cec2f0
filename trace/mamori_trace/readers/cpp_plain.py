# SPDX-License-Identifier: Apache-2.0
"""C++ text without parts that the compiler ignores: comments and dead preprocessor branches. Offsets stay unchanged.

@satisfies SWR-TRC-105      Design: docs/design/trace.md#dead-code
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator

_TOKEN = re.compile(r"""R"([^\s()\\]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|'(?:\\[^'\n]+|[^'\\\n])'|//(?:\\\n|[^\n])*|/\*.*?(?:\*/|\Z)""", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b([^\n]*)", re.MULTILINE)
_WORD = re.compile(r"[^\n]")
_SIGN = re.compile(r"[(){};]")
_BRACE = re.compile(r"[{}]")
_CONDITION_MAX = 200


def blank(text: str) -> str:
    """Replaces all characters by spaces, except line ends."""
    return _WORD.sub(" ", text)


class Plain:
    """Views of one text with equal lengths: `code` without comments and dead branches, `shape` also without the contents of literals."""

    def __init__(self, text: str) -> None:
        self.comments: list[re.Match[str]] = []
        self.code = _TOKEN.sub(self._keep_literal, text)
        self.shape = _TOKEN.sub(lambda match: blank(match[0]), text)
        self._dead = list(_list_dead(self.shape)) if "#" in text else []
        for first, last in self._dead:
            self.code = self.code[:first] + blank(self.code[first:last]) + self.code[last:]
            self.shape = self.shape[:first] + blank(self.shape[first:last]) + self.shape[last:]
        self._starts = [first for first, _ in self._dead]

    def is_dead(self, offset: int) -> bool:
        """Whether the preprocessor removes the text at `offset`."""
        index = bisect_right(self._starts, offset) - 1
        return index >= 0 and offset < self._dead[index][1]

    def _keep_literal(self, match: re.Match[str]) -> str:
        if match[0].startswith(("//", "/*")):
            self.comments.append(match)
            return blank(match[0])
        return match[0]


def find_dead_lines(text: str) -> frozenset[int]:
    """Lines, from 1, in the dead branches of a text."""
    if not re.search(r"^[ \t]*#[ \t]*(?:el)?if\b", text, re.MULTILINE):
        return frozenset()
    shape = _TOKEN.sub(lambda match: blank(match[0]), text)
    lines: set[int] = set()
    for first, last in _list_dead(shape):
        start = shape.count("\n", 0, first) + 1
        lines.update(range(start, start + shape.count("\n", first, last) + 1))
    return frozenset(lines)


def _list_dead(shape: str) -> Iterator[tuple[int, int]]:
    """(begin, end) of each outermost dead branch. A non-constant condition may be true, so its branches count as live."""
    stack: list[tuple[bool, bool]] = []  # of each open #if: whether its branch is dead, and whether an earlier branch is certainly true
    begin = -1
    for match in _DIRECTIVE.finditer(shape):
        word, condition = match[1], match[2]
        dead_before = any(dead for dead, _ in stack)
        if word in ("if", "ifdef", "ifndef"):
            value = _evaluate(condition) if word == "if" else None
            stack.append((value is False, value is True))
        elif stack and word == "endif":
            stack.pop()
        elif stack:
            taken = stack.pop()[1]
            value = _evaluate(condition) if word == "elif" else True
            stack.append((taken or value is False, taken or value is True))
        dead = any(one for one, _ in stack)
        if dead and not dead_before:
            begin = match.end()
        elif dead_before and not dead:
            yield begin, match.start()
    if begin >= 0 and any(dead for dead, _ in stack):
        yield begin, len(shape)


def _evaluate(condition: str) -> bool | None:
    """True or False for a constant condition, None if it depends on a macro."""
    text = condition.strip()
    if len(text) > _CONDITION_MAX:
        return None
    while text.startswith("(") and _find_close(text, 0) == len(text) - 1:
        text = text[1:-1].strip()
    for operator, decisive in (("||", True), ("&&", False)):
        parts = _split(text, operator)
        if len(parts) > 1:
            values = [_evaluate(part) for part in parts]
            return decisive if decisive in values else None if None in values else not decisive
    if text.startswith("!") and not text.startswith("!="):
        value = _evaluate(text[1:])
        return None if value is None else not value
    if text in ("true", "false"):
        return text == "true"
    number = re.fullmatch(r"(0[xX][0-9a-fA-F]+|\d+)[uUlL]*", text)
    return None if number is None else int(number[1], 16 if number[1][:2] in ("0x", "0X") else 10) != 0


def _split(text: str, operator: str) -> list[str]:
    parts, depth, last = [], 0, 0
    for at, letter in enumerate(text):
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if depth == 0 and text.startswith(operator, at):
            parts.append(text[last:at])
            last = at + len(operator)
    return [*parts, text[last:]]


def _find_close(text: str, at: int) -> int:
    """Offset of the bracket that closes the bracket at `at`; -1 if there is none."""
    depth = 0
    for offset in range(at, len(text)):
        depth += {"(": 1, ")": -1}.get(text[offset], 0)
        if depth == 0:
            return offset
    return -1


def find_body(shape: str, at: int) -> tuple[int, int]:
    """(begin, end) of the first block in braces after `at`; empty if a semicolon or the end comes first."""
    brackets = 0
    for match in _SIGN.finditer(shape, at):
        sign, offset = match[0], match.start()
        brackets += {"(": 1, ")": -1}.get(sign, 0)
        if sign == ";" and brackets <= 0:
            return offset, offset
        if sign == "{" and brackets <= 0:
            return offset, _find_brace(shape, offset)
    return len(shape), len(shape)


def _find_brace(shape: str, at: int) -> int:
    depth = 0
    for match in _BRACE.finditer(shape, at):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return match.end()
    return len(shape)
