# SPDX-License-Identifier: Apache-2.0
"""Finds the ids that one comment line names, in the notations of this project and of other tools.

@satisfies SWR-TRC-002, SWR-TRC-040, SWR-TRC-047      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.evidence import CodeTag

FILE_SYMBOL = "file"
ID_PATTERN = r"[A-Z]+-[\w-]+"
"""Pattern of ids of this project. A project in the format of another tool has its own pattern."""
ANY_ID = r"[A-Za-z_][\w.\-~/]*\w"
"""Pattern of ids of a project whose id format is unknown."""
RESULT_PROPERTIES = {"Verifies": "requirement", "FullyVerifies": "requirement", "PartiallyVerifies": "requirement",
                     "verifies": "requirement", "lobster-tracing": "requirement"}  # fmt: skip
"""Properties of a JUnit test case that name the verified requirement, in the words of other tools."""

IMPLEMENTS = "implements"
VERIFIES = "verifies"
NAMES = "names"
"""The tag does not state its role; its location determines the role."""

_MARKS = ("@satisfies", "@verifies", "@relation(", "@need-ids", "lobster-trace", "req-Id", "req-id", "REQ-ID")
_ARTIFACT = re.compile(r"\[[A-Za-z]+(?:~[^\]\s]*)?[ \t]*->")
_TEST_ARTIFACT = re.compile(r"[a-z]*test|tst")
_OFT_ID = r"[A-Za-z]+~[\w.\-]+~\d+"


def has_mark(text: str) -> bool:
    """Whether the text contains the common beginning of all tags; otherwise it contains no tag."""
    for mark in _MARKS:
        if mark in text:
            return True
    return "->" in text and _ARTIFACT.search(text) is not None


class TagWord(NamedTuple):
    """One id that a tag names. `of_file`: the tag applies to the complete file."""

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


@cache
def _get_patterns(id_pattern: str) -> _Patterns:
    one = rf"(?:{id_pattern})"
    more = rf"({one}(?:[ \t]*,[ \t]*{one})*)"
    return _Patterns(
        satisfies=re.compile(rf"@satisfies[ \t]*:?[ \t]+{more}"),
        bare=re.compile(rf"^[\s/*#'\"]*@satisfies\b(?![ \t]*:?[ \t]+{one})"),
        verifies=re.compile(rf"@verifies[ \t]*:?[ \t]+{more}"),
        relation=re.compile(rf"@relation\([ \t]*{more}[ \t]*((?:,[ \t]*\w+[ \t]*=[ \t]*\w+[ \t]*)*)\)"),
        artifact=re.compile(rf"\[([A-Za-z]+)(?:~[^\]\s]*?)?[ \t]*->[ \t]*({_list_covered(id_pattern)})[ \t]*(?:>>[^\]]*)?\]"),
        named=re.compile(rf"(?:\b(?:req-[Ii]d|REQ-ID|lobster-trace)|@need-ids)[ \t]*:[ \t]*{more}"),
    )


def _list_covered(id_pattern: str) -> str:
    """Targets of a tag with an arrow. If any word may be an id, only ids with a revision count, because `[x -> y]` may be code."""
    return rf"{_OFT_ID}(?:[ \t]*,[ \t]*{_OFT_ID})*" if id_pattern == ANY_ID else rf"(?:{id_pattern})"


def find_words(line: str, id_pattern: str = ID_PATTERN) -> Iterator[TagWord]:
    """All ids that the tags of one line name, ordered by kind of tag."""
    if not has_mark(line):
        return
    patterns = _get_patterns(id_pattern)
    for mark, pattern, role in (("@satisfies", patterns.satisfies, IMPLEMENTS), ("@verifies", patterns.verifies, VERIFIES), (":", patterns.named, NAMES)):
        if mark in line:  # a plain search takes a tenth of the time of a pattern
            yield from (TagWord(word, role) for match in pattern.finditer(line) for word in _split(match[1]))
    for match in patterns.relation.finditer(line) if "@relation" in line else ():
        options = dict(re.findall(r"(\w+)[ \t]*=[ \t]*(\w+)", match[2]))
        if options.get("scope") == "range_end":  # already reported at the beginning of the range
            continue
        role = _get_role(options.get("role", ""))
        yield from (TagWord(word, role, options.get("scope") == "file") for word in _split(match[1]))
    for match in patterns.artifact.finditer(line) if "->" in line else ():
        role = VERIFIES if _TEST_ARTIFACT.fullmatch(match[1]) else IMPLEMENTS
        yield from (TagWord(word, role) for word in _split(match[2]))


def _get_role(word: str) -> str:
    if word.lower().startswith(("verif", "test")):
        return VERIFIES
    return IMPLEMENTS if word else NAMES


def _split(words: str) -> list[str]:
    return [word.strip() for word in words.split(",")]


def make_tags(line: str, place: Place, symbol: str, problems: list[Problem], id_pattern: str = ID_PATTERN) -> list[CodeTag]:
    """Tags of one comment line. A tag without an id is a problem. @param id_pattern the pattern of an id."""
    if not has_mark(line):
        return []
    if _get_patterns(id_pattern).bare.search(line):
        problems.append(Problem("unknown-id", place, "@satisfies names no requirement id"))
    words = (word for word in find_words(line, id_pattern) if word.role != VERIFIES)
    return [CodeTag(word.requirement, place, FILE_SYMBOL if word.of_file else symbol) for word in words]


def find_verified(text: str, id_pattern: str = ID_PATTERN) -> Iterator[tuple[int, str]]:
    """Ids that the comment of a test names as verified, with the line number in `text`, from 0."""
    for number, line in enumerate(text.splitlines()):
        yield from ((number, word.requirement) for word in find_words(line, id_pattern) if word.role != IMPLEMENTS)
