# SPDX-License-Identifier: Apache-2.0
"""Reads Cobertura XML: lines and branches. Its document type names an external file, which is not loaded.

@satisfies SWR-TRC-032      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

import re
from pathlib import Path

from mamori_trace.base.errors import FormatError
from mamori_trace.base.finding import Problem
from mamori_trace.base.xml_file import feed_file, make_parser
from mamori_trace.model.coverage import CoverageRun
from mamori_trace.readers.source_names import SourceNames

_SHARE = re.compile(r"\((\d+)/(\d+)\)")


class _Collector:
    """Collects lines while expat parses the file. Methods repeat lines of their class, so the higher count is used."""

    def __init__(self, names: SourceNames, run: CoverageRun) -> None:
        self._names = names
        self._run = run
        self._sources: list[str] = []
        self._in_source = False
        self._name = ""
        self.found_root = False

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if not self.found_root and tag != "coverage":
            raise FormatError(f"begins with <{tag}>, which is no Cobertura; put coverage files alone into this folder")
        self.found_root = True
        if tag == "source":
            self._in_source = True
            self._sources.append("")
        elif tag == "class":
            self._name = self._find(attributes.get("filename", ""))
        elif tag == "line" and self._name:
            self._take_line(attributes)

    def end(self, tag: str) -> None:
        if tag == "source":
            self._in_source = False
        elif tag == "class":
            self._name = ""

    def text(self, text: str) -> None:
        if self._in_source:
            self._sources[-1] += text

    def _find(self, filename: str) -> str:
        joined = (f"{source.strip().rstrip('/')}/{filename}" for source in self._sources if source.strip() not in ("", "."))
        return next(filter(None, map(self._names.find, (*joined, filename))), "")

    def _take_line(self, attributes: dict[str, str]) -> None:
        try:
            number, hits = int(attributes["number"]), int(attributes["hits"])
        except (KeyError, ValueError):
            raise FormatError("holds a line without number and hits; measure again") from None
        file = self._run.get_file(self._name)
        file.lines[number] = max(hits, file.lines.get(number, 0))
        share = _SHARE.search(attributes.get("condition-coverage", "")) if attributes.get("branch", "").lower() == "true" else None
        if share:
            reached, known = file.branches.get(number, (0, 0))
            file.branches[number] = (max(reached, int(share[1])), max(known, int(share[2])))


def take_cobertura(path: Path, names: SourceNames, run: CoverageRun, problems: list[Problem]) -> bool:
    """Fills `run`. @return whether the file is complete; otherwise, one more problem is reported."""
    collector = _Collector(names, run)
    parser = make_parser(collector.start, collector.end, collector.text, doctype=True)
    return feed_file(parser, path, run.place.file, "measure again", problems)
