# SPDX-License-Identifier: Apache-2.0
"""Tags of other tools in comments of code and tests: what each spelling means, and the ids that it names.

@satisfies SWR-TRC-047      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

CODE, TEST, EITHER = "code", "test", ""
RESULT_PROPERTIES = {"Verifies": "requirement", "FullyVerifies": "requirement", "PartiallyVerifies": "requirement",
                     "verifies": "requirement", "lobster-tracing": "requirement"}  # fmt: skip
"""Properties of a JUnit test case that name what it verifies, in the words of other tools."""

_WORD = r"[A-Za-z_][\w.\-~/]*[\w]"
_LIST = rf"{_WORD}(?:[ \t]*,[ \t]*{_WORD})*"
_OFT_ID = r"[A-Za-z]+~[\w.\-]+~\d+"
_OFT_TESTS = ("utest", "itest", "stest", "test", "tst")
_SPELLINGS = (
    (CODE, re.compile(rf"@satisfies[ \t]*:?[ \t]+(?P<ids>{_LIST})")),
    (TEST, re.compile(rf"@verifies[ \t]*:?[ \t]+(?P<ids>{_LIST})")),
    (EITHER, re.compile(rf"@relation\([ \t]*(?P<ids>{_LIST})(?=[ \t]*,[ \t]*(?:scope|role)[ \t]*=|[ \t]*\))")),
    (EITHER, re.compile(rf"\[(?:(?P<kind>[A-Za-z]+)(?:~[\w.\-]*~\d+)?)[ \t]*->[ \t]*(?P<ids>{_OFT_ID}(?:[ \t]*,[ \t]*{_OFT_ID})*)[^\]\n]*\]")),
    (EITHER, re.compile(rf"@need-ids[ \t]*:[ \t]*(?P<ids>{_LIST})")),
    (EITHER, re.compile(rf"\b(?:lobster-trace|req-Id|req-id|REQ-ID)[ \t]*:[ \t]*(?P<ids>{_LIST})")),
)
_QUICK = re.compile(r"@satisfies|@verifies|@relation\(|->|@need-ids|lobster-trace|req-[Ii]d|REQ-ID")


@dataclass(frozen=True, slots=True)
class Alias:
    """One tag in line `line` of a text; `kind` is code, test, or either (then the file decides). `start` and `end` are columns."""

    kind: str
    ids: tuple[str, ...]
    line: int
    start: int
    end: int


def has_aliases(text: str) -> bool:
    """Whether a search is worth its time."""
    return _QUICK.search(text) is not None


def find_aliases(text: str) -> Iterator[Alias]:
    """Tags in order of lines."""
    for number, line in enumerate(text.splitlines(), start=1):
        if not _QUICK.search(line):
            continue
        for kind, pattern in _SPELLINGS:
            for match in pattern.finditer(line):
                ids = tuple(word.strip() for word in match["ids"].split(","))
                yield Alias(_get_kind(kind, match), ids, number, match.start(), match.end())


def _get_kind(kind: str, match: re.Match[str]) -> str:
    """OpenFastTrace names the kind of the thing that covers: `[utest->req~x~1]` is a test wherever it stands."""
    artifact = match.groupdict().get("kind")
    if artifact is None:
        return kind
    return TEST if artifact in _OFT_TESTS else CODE
