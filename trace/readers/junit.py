# SPDX-License-Identifier: Apache-2.0
"""Reads JUnit XML as GoogleTest and pytest write it, with the line of every case.

A document type definition is refused before any entity could be expanded; a file that is cut off keeps nothing of it.

@satisfies SWR-TRC-004, SWR-TRC-009      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

import xml.parsers.expat
from pathlib import Path

from mamori.trace.model.evidence import CAMPAIGN, ERRORED, FAILED, PASSED, SKIPPED, UNIT, TestResult
from mamori.trace.model.finding import Place, Problem
from mamori.trace.readers.files import UNREADABLE, get_shown_path
from mamori.trace.readers.tag_aliases import RESULT_PROPERTIES

_WORST_FIRST = (ERRORED, FAILED, SKIPPED, PASSED)
_OUTCOMES = {"failure": FAILED, "error": ERRORED, "skipped": SKIPPED}
_MESSAGE_CHARACTERS_MAX = 2000


class _Refused(Exception):
    """The document holds what a result file never needs."""


def read_junit(folder: Path, root: Path, problems: list[Problem]) -> list[TestResult]:
    """Results of all XML files in `folder`, in order of file and line."""
    results: list[TestResult] = []
    for path in sorted(folder.glob("*.xml")):
        shown = get_shown_path(path, root)
        try:
            data = path.read_bytes()
        except OSError as error:
            problems.append(Problem(UNREADABLE, Place(shown, 1), f"cannot be read: {error.strerror or error}"))
            continue
        kind = CAMPAIGN if path.name == "campaign.xml" else UNIT
        results.extend(parse_junit(data, shown, kind, root, problems))
    return results


def parse_junit(data: bytes, shown: str, kind: str, root: Path, problems: list[Problem]) -> list[TestResult]:
    """Results of one file, or none and one problem."""
    collector = _Collector(shown, kind, root)
    try:
        collector.parser.Parse(data, True)
    except _Refused as error:
        problems.append(Problem(UNREADABLE, Place(shown, collector.parser.CurrentLineNumber), str(error)))
        return []
    except xml.parsers.expat.ExpatError as error:
        reason = xml.parsers.expat.ErrorString(error.code)
        problems.append(Problem(UNREADABLE, Place(shown, error.lineno), f"is not whole XML ({reason}); run the tests again"))
        return []
    return collector.results


class _Collector:
    """Gathers test cases while expat walks through the file."""

    def __init__(self, shown: str, kind: str, root: Path) -> None:
        self.results: list[TestResult] = []
        self._shown = shown
        self._kind = kind
        self._root = root
        self._case: TestResult | None = None
        self._in_outcome = False
        self.parser = xml.parsers.expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._take_text

    def _refuse_doctype(self, *_: object) -> None:
        raise _Refused("holds a document type definition (DTD, entities), which no test writes; refused unread")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag == "testcase":
            self._case = self._open_case(attributes)
        elif self._case is None:
            return
        elif tag in _OUTCOMES:
            self._in_outcome = True
            self._case.status = min(self._case.status, _OUTCOMES[tag], key=_WORST_FIRST.index)
            self._case.message = self._case.message or attributes.get("message", "")
        elif tag == "property":
            self._set_property(attributes.get("name", ""), attributes.get("value", ""))

    def _end(self, tag: str) -> None:
        if tag in _OUTCOMES:
            self._in_outcome = False
        elif tag == "testcase" and self._case is not None:
            self._case.message = self._case.message.strip()[:_MESSAGE_CHARACTERS_MAX]
            self.results.append(self._case)
            self._case = None

    def _take_text(self, text: str) -> None:
        """pytest puts the full failure here; it serves where no message attribute stands."""
        if self._in_outcome and self._case is not None and not self._case.message.strip():
            self._case.message += text

    def _open_case(self, attributes: dict[str, str]) -> TestResult:
        not_run = attributes.get("status") == "notrun" or attributes.get("result") == "suppressed"
        try:
            time_s = float(attributes.get("time", "0"))
        except ValueError:
            time_s = 0.0
        case = TestResult(
            suite=attributes.get("classname", ""),
            name=attributes.get("name", ""),
            status=SKIPPED if not_run else PASSED,
            requirement="",
            technique="",
            polarity="",
            message="disabled" if not_run else "",
            time_s=time_s,
            place=Place(self._shown, self.parser.CurrentLineNumber),
            source=self._read_source(attributes),
            kind=self._kind,
        )
        for name in ("requirement", "technique", "polarity"):  # GoogleTest before 1.8.1 writes properties as attributes
            setattr(case, name, attributes.get(name, ""))
        return case

    def _read_source(self, attributes: dict[str, str]) -> Place | None:
        if not attributes.get("file"):
            return None
        line = attributes.get("line", "1")
        return Place(get_shown_path(Path(attributes["file"]), self._root), int(line) if line.isdigit() else 1)

    def _set_property(self, name: str, value: str) -> None:
        name = RESULT_PROPERTIES.get(name, name)
        if self._case is not None and name in ("requirement", "technique", "polarity"):
            setattr(self._case, name, value)
