# SPDX-License-Identifier: Apache-2.0
"""The query language: tokens with their columns, and an expression in postfix order. No function is recursive, so any depth is possible.

    expression = comparison | has(NAME) | not expression | expression and expression | expression or expression | (expression)
    comparison = FIELD (= | != | ~ | !~ | < | <= | > | >=) (WORD | "TEXT")

@satisfies SWR-TRC-079, SWR-TRC-080      Design: docs/design/trace.md#query
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mamori_trace.base.errors import FormatError

MAX_LENGTH = 10_000
MAX_DEPTH = 64
AND, OR, NOT, HAS, COMPARE = "and", "or", "not", "has", "compare"
OPERATORS = ("=", "!=", "~", "!~", "<", "<=", ">", ">=")
_TOKEN = re.compile(r'\s*(?:(?P<text>"(?:\\.|[^"\\])*")|(?P<sign>!=|!~|<=|>=|[=~<>()])|(?P<word>[^\s"()=!~<>]+))')
_RANK = {OR: 1, AND: 2, NOT: 3}


@dataclass(frozen=True, slots=True)
class Token:
    """A word, a sign or a quoted text; `column` is its first column."""

    kind: str
    text: str
    column: int


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the postfix order: a comparison or has() pushes a truth value, the others combine the last ones."""

    action: str
    field: str = ""
    operator: str = ""
    value: str = ""
    column: int = 0
    value_column: int = 0


def split_tokens(text: str) -> list[Token]:
    """Raises FormatError at the first character that begins no token."""
    if len(text) > MAX_LENGTH:
        raise FormatError(f"longer than {MAX_LENGTH} characters", MAX_LENGTH + 1)
    tokens: list[Token] = []
    position = 0
    end = len(text.rstrip())
    while position < end:
        match = _TOKEN.match(text, position)
        if match is None:
            column = position + len(text[position:]) - len(text[position:].lstrip()) + 1
            raise FormatError("a text is not closed" if text[column - 1] == '"' else f"'{text[column - 1]}' is not understood", column)
        kind = match.lastgroup or ""
        word = match[kind]
        if kind == "text":
            word = re.sub(r"\\(.)", r"\1", word[1:-1])
        tokens.append(Token(kind, word, match.start(kind) + 1))
        position = match.end()
    return tokens


def parse(text: str) -> list[Step]:
    """Postfix steps of an expression (two stacks, as for arithmetic). Raises FormatError."""
    tokens = split_tokens(text)
    end = Token("end", "", len(text.rstrip()) + 1)
    steps: list[Step] = []
    waiting: list[Token] = []
    wants_operand = True
    position = 0
    while position < len(tokens):
        token = tokens[position]
        word = token.text.lower() if token.kind == "word" else ""
        rest = [*tokens[position + 1 : position + 4], end, end, end]
        position += 1
        if wants_operand:
            if word == NOT or _is_sign(token, "("):
                _push(waiting, token)
            else:
                step, used = _take_operand(token, word, rest)
                steps.append(step)
                position += used
                wants_operand = False
        elif word in (AND, OR):
            _pop_while(waiting, steps, _RANK[word])
            waiting.append(token)
            wants_operand = True
        elif _is_sign(token, ")"):
            _close(waiting, steps, token)
        else:
            raise FormatError(f"'{token.text}' where 'and', 'or' or the end is expected; a value with signs stands in quotation marks", token.column)
    if wants_operand:
        raise FormatError("a comparison is expected, for example level=SWR", end.column)
    _pop_while(waiting, steps, 0)
    if waiting:
        raise FormatError("'(' is not closed", waiting[-1].column)
    return steps


def _is_sign(token: Token, sign: str) -> bool:
    return token.kind == "sign" and token.text == sign


def _push(waiting: list[Token], token: Token) -> None:
    if len(waiting) >= MAX_DEPTH:
        raise FormatError(f"nested deeper than {MAX_DEPTH}", token.column)
    waiting.append(token)


def _take_operand(token: Token, word: str, rest: list[Token]) -> tuple[Step, int]:
    """Parses a comparison or has(), and returns how many further tokens it uses."""
    if token.kind != "word" or word in (AND, OR):
        raise FormatError(f"'{token.text}' where a field is expected, for example level", token.column)
    if word == HAS:
        if not (_is_sign(rest[0], "(") and rest[1].kind == "word" and _is_sign(rest[2], ")")):
            raise FormatError("has wants one name in brackets, for example has(code)", rest[0].column)
        return Step(HAS, rest[1].text.lower(), column=rest[1].column), 3
    operator, value = rest[0], rest[1]
    if operator.kind != "sign" or operator.text not in OPERATORS:
        raise FormatError(f"one of {' '.join(OPERATORS)} is expected after '{token.text}'", operator.column)
    if value.kind not in ("word", "text"):
        raise FormatError(f"a value is expected after '{operator.text}'; quote one that holds blanks or signs", value.column)
    return Step(COMPARE, word, operator.text, value.text, token.column, value.column), 2


def _pop_while(waiting: list[Token], steps: list[Step], rank: int) -> None:
    while waiting and not _is_sign(waiting[-1], "(") and _RANK[waiting[-1].text.lower()] >= rank:
        steps.append(Step(waiting.pop().text.lower()))


def _close(waiting: list[Token], steps: list[Step], token: Token) -> None:
    _pop_while(waiting, steps, 0)
    if not waiting:
        raise FormatError("')' closes nothing", token.column)
    waiting.pop()
