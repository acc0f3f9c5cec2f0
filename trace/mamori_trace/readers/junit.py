# SPDX-License-Identifier: Apache-2.0
"""Reads JUnit XML of GoogleTest, pytest, CTest and Surefire, with the line of every case.

A document type definition is rejected before any entity can expand; a truncated file gives no results.

@satisfies SWR-TRC-004, SWR-TRC-009, SWR-TRC-041, SWR-TRC-042, SWR-TRC-101      Design: docs/design/trace_formats.md#results-of-other-tools
"""

from __future__ import annotations

import io
import math
import re
from dataclasses import replace
from pathlib import Path

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import get_shown_path, list_paths
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.xml_file import feed, feed_file, make_parser
from mamori_trace.model.evidence import CAMPAIGN, ERRORED, FAILED, NOT_SHOWN, PASSED, SKIPPED, UNIT, WHOLE_SUITE, TestResult
from mamori_trace.readers.tag_text import RESULT_PROPERTIES

_WORST_FIRST = (ERRORED, FAILED, SKIPPED, PASSED)
_OUTCOMES = {"failure": FAILED, "error": ERRORED, "skipped": SKIPPED}
_RETRIES = ("flakyFailure", "flakyError", "rerunFailure", "rerunError")
_STATUS_WORDS = {"fail": FAILED, "failed": FAILED, "failure": FAILED, "error": ERRORED, "notrun": SKIPPED, "disabled": SKIPPED,
                 "skipped": SKIPPED, "ignored": SKIPPED, "suppressed": SKIPPED}  # fmt: skip
"""Permitted values of the attributes `status` (CTest, GoogleTest) and `result` (GoogleTest); other values do not count against the case."""
_VERDICT = "verdict"
_HOST_WORDS = ("inconclusive", "not-shown", "no-privilege")
_OF_HOST = re.compile(rf"\bverdict=(?:{'|'.join(_HOST_WORDS)})\b|\bprivileges?\b", re.IGNORECASE)
"""Text in the message of a skipped case: the host is the cause. The property `verdict` has the same meaning."""
_ROOTS = ("testsuites", "testsuite")
_MESSAGE_CHARACTERS_MAX = 2000
_REMEDY = "run the tests again"


def read_junit(folder: Path, root: Path, problems: list[Problem]) -> list[TestResult]:
    """Results of all XML files in `folder`, in order of file and line."""
    results: list[TestResult] = []
    for path in list_paths(folder, "*.xml", root, problems):
        kind = CAMPAIGN if path.name == "campaign.xml" else UNIT
        results += read_junit_file(path, get_shown_path(path, root), kind, root, problems)
    return results


def read_junit_file(path: Path, shown: str, kind: str, root: Path, problems: list[Problem]) -> list[TestResult]:
    """Results of one file, or none and one problem."""
    collector = _Collector(shown, kind, root)
    return collector.results if feed_file(collector.parser, path, shown, _REMEDY, problems) else []


def parse_junit(data: bytes, shown: str, kind: str, root: Path, problems: list[Problem]) -> list[TestResult]:
    """Results of one file in memory, or none and one problem."""
    collector = _Collector(shown, kind, root)
    return collector.results if feed(collector.parser, io.BytesIO(data), shown, _REMEDY, problems) else []


class _Collector:
    """Collects test cases while expat parses the file. Texts are truncated to the maximum message length."""

    def __init__(self, shown: str, kind: str, root: Path) -> None:
        self.results: list[TestResult] = []
        self.shown = shown
        self.parser = make_parser(self._start, self._end, self._take_text)
        self.parser.buffer_text = True
        self._kind = kind
        self._root = root
        self._case: TestResult | None = None
        self._named: list[str] = []
        self._verdict = ""
        self._suites: list[str] = []
        self._takes_text = False
        self._sources: dict[str, str] = {}

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        if tag in _ROOTS:
            self._suites.append(attributes.get("name", ""))
        elif not self._suites:
            raise FormatError(f"begins with <{tag[:40]}>, which is no JUnit; put files of results alone into this folder")
        elif tag == "testcase":
            self._case = self._open_case(attributes)
        elif tag == "property":
            self._set_property(attributes.get("name", ""), attributes.get("value", ""))
        elif tag in _OUTCOMES:
            self._take_outcome(tag, attributes)
        elif self._case is not None and tag in _RETRIES:
            self._case.flaky = True

    def _take_outcome(self, tag: str, attributes: dict[str, str]) -> None:
        """A failure outside all cases belongs to the complete suite."""
        if self._case is None and tag == "skipped":
            return
        if self._case is None:
            self._case = self._open_case({"classname": self._suites[-1], "name": WHOLE_SUITE})
        self._case.status = min(self._case.status, _OUTCOMES[tag], key=_WORST_FIRST.index)
        self._case.message = self._case.message or attributes.get("message", "")[:_MESSAGE_CHARACTERS_MAX]
        self._takes_text = not self._case.message.strip()

    def _end(self, tag: str) -> None:
        if tag in _OUTCOMES:
            self._takes_text = False
        if self._case is not None and (tag == "testcase" or (tag in _OUTCOMES and self._case.name == WHOLE_SUITE)):
            self._close_case(self._case)
            self._case = None
        if tag in _ROOTS:
            self._suites.pop()

    def _close_case(self, case: TestResult) -> None:
        """One result for each requirement that the case names. A case whose last attempt failed is a failure, not flaky."""
        case.message = case.message.strip()[:_MESSAGE_CHARACTERS_MAX]
        of_host = self._verdict in _HOST_WORDS
        if (case.status == SKIPPED and (of_host or _OF_HOST.search(case.message))) or (case.status == PASSED and of_host):
            case.status = NOT_SHOWN
        self._verdict = ""
        case.flaky = case.flaky and case.status == PASSED
        named = list(dict.fromkeys(filter(None, [case.requirement, *self._named])))
        self._named = []
        case.requirement = named[0] if named else ""
        self.results.append(case)
        self.results.extend(replace(case, requirement=name, is_first=False) for name in named[1:])

    def _take_text(self, text: str) -> None:
        """pytest writes the full failure here; used if there is no message attribute."""
        if self._takes_text and self._case is not None and len(self._case.message) < _MESSAGE_CHARACTERS_MAX:
            self._case.message += text[:_MESSAGE_CHARACTERS_MAX] if self._case.message else text.lstrip()[:_MESSAGE_CHARACTERS_MAX]

    def _open_case(self, attributes: dict[str, str]) -> TestResult:
        words = [word.lower() for name in ("status", "result") if (word := attributes.get(name))]
        status = min([_STATUS_WORDS[word] for word in words if word in _STATUS_WORDS], key=_WORST_FIRST.index, default=PASSED)
        return TestResult(
            suite=attributes.get("classname", ""),
            name=attributes.get("name", ""),
            status=status,
            # GoogleTest before 1.8.1 writes properties as attributes.
            requirement=attributes.get("requirement", ""),
            technique=attributes.get("technique", ""),
            polarity=attributes.get("polarity", ""),
            message="disabled" if status == SKIPPED and "skipped" not in (attributes.get("status"), attributes.get("result")) else "",
            time_s=_read_time(attributes.get("time", "0")),
            place=Place(self.shown, self.parser.CurrentLineNumber),
            source=self._read_source(attributes),
            kind=self._kind,
        )

    def _read_source(self, attributes: dict[str, str]) -> Place | None:
        file = attributes.get("file")
        if not file:
            return None
        if file not in self._sources:
            self._sources[file] = get_shown_path(Path(file), self._root)
        line = attributes.get("line", "")
        return Place(self._sources[file], int(line) if line.isascii() and line.isdigit() and len(line) < 10 else 1)

    def _set_property(self, name: str, value: str) -> None:
        if self._case is None:
            return
        if name == "requirement":
            self._case.requirement = self._case.requirement or value
            self._named.append(value)
        elif name in ("technique", "polarity"):
            setattr(self._case, name, value)
        elif name == _VERDICT:
            self._verdict = value.strip().lower()
        elif name in RESULT_PROPERTIES:
            self._named += [word.strip() for word in value.split(",")]


def _read_time(text: str) -> float:
    """Seconds; 0 if there is no number that can be added up."""
    try:
        time_s = float(text)
    except ValueError:
        return 0.0
    return time_s if math.isfinite(time_s) else 0.0
