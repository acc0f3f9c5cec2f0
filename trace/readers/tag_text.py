# SPDX-License-Identifier: Apache-2.0
"""Finds the ids that one line of a comment names, in the words of this project and in those of other tools.

@satisfies SWR-TRC-002, SWR-TRC-040      Design: docs/design/trace_cover.md#tags-of-other-tools
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from mamori.trace.model.evidence import CodeTag
from mamori.trace.model.finding import Place, Problem

FILE_SYMBOL = "file"
ID_PATTERN = r"[A-Z]+-[\w-]+"
"""Ids as this project writes them. A project kept for another tool brings its own pattern."""

IMPLEMENTS = "implements"
VERIFIES = "verifies"
NAMES = "names"
"""The tag does not tell; where it stands does."""

_MARKS = ("@satisfies", "@verifies", "@relation(", "req-Id:", "lobster-trace:")
_ARTIFACT = re.compile(r"\[[a-z]+(?:~[^\]\s]*)?[ \t]*->")
_TEST_ARTIFACT = re.compile(r"[a-z]*test")


def has_mark(text: str) -> bool:
    """Whether there is what every tag begins with; a text without it holds none."""
    for mark in _MARKS:
        if mark in text:
            return True
    return "->" in text and _ARTIFACT.search(text) is not None


@dataclass(frozen=True, slots=True)
class TagWord:
    """One id that a tag names. `of_file`: the tag says that it speaks for the whole file."""

    requirement: str
    role: str
    of_file: bool = False


@dataclass(frozen=True, slots=True)
class _Patterns:
    satisfies: re.Pattern[str]
    bare: re.Pattern[str]
    verifies: re.Pattern[str]
    relation: re.Pattern[str]
    artifact: re.Pattern[str]
    named: re.Pattern[str]
    single: re.Pattern[str]


@cache
def _get_patterns(id_pattern: str) -> _Patterns:
    one = rf"(?:{id_pattern})"
    more = rf"({one}(?:[ \t]*,[ \t]*{one})*)"
    return _Patterns(
        satisfies=re.compile(rf"@satisfies[ \t]+{more}"),
        bare=re.compile(rf"^[\s/*#'\"]*@satisfies\b(?![ \t]+{one})"),
        verifies=re.compile(rf"@verifies[ \t]+{more}"),
        relation=re.compile(rf"@relation\([ \t]*{more}[ \t]*((?:,[ \t]*\w+[ \t]*=[ \t]*\w+[ \t]*)*)\)"),
        artifact=re.compile(rf"\[([a-z]+)(?:~[^\]\s]*?)?[ \t]*->[ \t]*({one})[ \t]*(?:>>[^\]]*)?\]"),
        named=re.compile(rf"\b(?:req-Id|lobster-trace):[ \t]*{more}"),
        single=re.compile(one),
    )


def find_words(line: str, id_pattern: str = ID_PATTERN) -> Iterator[TagWord]:
    """All ids that the tags of one line name, in the order of the kinds of tags."""
    if not has_mark(line):
        return
    patterns = _get_patterns(id_pattern)
    for pattern, role in ((patterns.satisfies, IMPLEMENTS), (patterns.verifies, VERIFIES), (patterns.named, NAMES)):
        for match in pattern.finditer(line):
            yield from (TagWord(word, role) for word in _split(match[1]))
    for match in patterns.relation.finditer(line):
        options = dict(re.findall(r"(\w+)[ \t]*=[ \t]*(\w+)", match[2]))
        if options.get("scope") == "range_end":  # its beginning has told it already
            continue
        role = _get_role(options.get("role", ""))
        yield from (TagWord(word, role, options.get("scope") == "file") for word in _split(match[1]))
    for match in patterns.artifact.finditer(line):
        yield TagWord(match[2], VERIFIES if _TEST_ARTIFACT.fullmatch(match[1]) else IMPLEMENTS)


def _get_role(word: str) -> str:
    if word.lower().startswith(("verif", "test")):
        return VERIFIES
    return IMPLEMENTS if word else NAMES


def _split(words: str) -> list[str]:
    return [word.strip() for word in words.split(",")]


def make_tags(line: str, place: Place, symbol: str, problems: list[Problem], id_pattern: str = ID_PATTERN) -> list[CodeTag]:
    """Tags of one line of a comment. A tag that names nothing is a problem. @param id_pattern what an id looks like."""
    if not has_mark(line):
        return []
    if _get_patterns(id_pattern).bare.search(line):
        problems.append(Problem("unknown-id", place, "@satisfies names no requirement id"))
    words = (word for word in find_words(line, id_pattern) if word.role != VERIFIES)
    return [CodeTag(word.requirement, place, FILE_SYMBOL if word.of_file else symbol) for word in words]


def find_verified(text: str, id_pattern: str = ID_PATTERN) -> Iterator[tuple[int, str]]:
    """Ids that a comment of a test says to verify, with the number of the line in `text`, from 0."""
    for number, line in enumerate(text.splitlines()):
        yield from ((number, word.requirement) for word in find_words(line, id_pattern) if word.role != IMPLEMENTS)
