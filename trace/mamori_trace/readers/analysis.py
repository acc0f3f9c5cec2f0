# SPDX-License-Identifier: Apache-2.0
"""Reads findings of static analysis from the folder `static` of the evidence: SARIF, cppcheck's XML, clang-tidy's text and YAML.

@satisfies SWR-TRC-043      Design: docs/design/trace.md#static-analysis
"""

from __future__ import annotations

import json
import re
import urllib.parse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, get_shown_path, list_paths, read_text
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.xml_file import feed_file, make_parser
from mamori_trace.base.yaml_depth import demand_shallow
from mamori_trace.model.evidence import AnalysisFinding, Evidence
from mamori_trace.readers.source_names import SourceNames

_REMEDY = "run the analysis again"
_QUIET = ("note", "none", "information", "debug", "remark")
_TIDY = re.compile(r"^(?P<file>[^\s:][^:\n]*):(?P<line>\d+):\d+: (?:fatal )?(?P<level>warning|error): (?P<text>.*?)(?: \[(?P<rule>[\w.,\-]+)\])?$")
_FITTING_ERRORS = (KeyError, TypeError, ValueError, IndexError, AttributeError, RecursionError)
Row = tuple[str, str, str, int]  # rule, message, file name of the tool, line


def read_analysis(folder: Path, names: SourceNames, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Fills in the findings, each once, sorted by location. An incomplete file is one problem and gives no finding."""
    found: set[AnalysisFinding] = set()
    for path in list_paths(folder, "static/*", root, problems):
        reader = _READERS.get(path.suffix)
        if reader is None:
            continue
        shown = get_shown_path(path, root)
        before = len(problems)
        try:
            rows = reader(path, shown, problems)
        except _FITTING_ERRORS as error:
            words = str(error).partition("\n")[0]
            problems.append(Problem(UNREADABLE, Place(shown, 1), f"is no whole result of an analysis ({type(error).__name__} {words}); {_REMEDY}"))
        if len(problems) == before:
            found.update(_make_finding(row, shown, names) for row in rows)
    evidence.analysis = sorted(found)


def _make_finding(row: Row, shown: str, names: SourceNames) -> AnalysisFinding:
    """A finding outside the project is reported at the result file that contains it."""
    rule, message, file, line = row
    name = names.find_any(file)
    if name:
        return AnalysisFinding(Place(name, max(1, line)), rule, message)
    return AnalysisFinding(Place(shown, 1), rule, f"{file}:{line}: {message}" if file else message)


def _read_sarif(path: Path, shown: str, problems: list[Problem]) -> list[Row]:
    content = json.loads(read_text(path, shown, problems))
    if not str(content["version"]).startswith("2."):
        raise ValueError("version is not 2.x")
    return [_take_result(result) for run in content["runs"] for result in run.get("results") or () if _is_open(result)]


def _is_open(result: dict[str, Any]) -> bool:
    """Whether the finding counts: not a note, not suppressed, and present in this run."""
    accepted = any(one.get("status", "accepted") == "accepted" for one in result.get("suppressions") or ())
    is_fault = result.get("kind", "fail") in ("fail", "open", "review") and result.get("level", "warning") not in _QUIET
    return is_fault and not accepted and result.get("baselineState") != "absent"


def _take_result(result: dict[str, Any]) -> Row:
    rule = str(result.get("ruleId") or result.get("rule", {}).get("id") or "unnamed")
    message = str(result["message"].get("text") or result["message"].get("markdown") or rule)
    places = result.get("locations") or [{}]
    physical = places[0].get("physicalLocation", {})
    uri = urllib.parse.urlsplit(str(physical.get("artifactLocation", {}).get("uri", "")))
    return rule, message.partition("\n")[0], urllib.parse.unquote(uri.path), int(physical.get("region", {}).get("startLine", 1))


def _read_cppcheck(path: Path, shown: str, problems: list[Problem]) -> list[Row]:
    rows: list[Row] = []
    pending: list[str] = []
    begun = False

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal begun
        if not begun and tag != "results":
            raise FormatError(f"begins with <{tag[:40]}>, which cppcheck does not write; put its results alone into this folder")
        begun = True
        if tag == "error" and attributes.get("severity", "error") not in _QUIET:
            pending[:] = [attributes.get("id", "unnamed"), attributes.get("msg", "")]
        elif tag == "location" and pending:
            rows.append((pending[0], pending[1], attributes.get("file", ""), int(attributes.get("line", "1"))))
            pending.clear()

    def end(tag: str) -> None:
        if tag == "error" and pending:
            rows.append((pending[0], pending[1], "", 1))
            pending.clear()

    feed_file(make_parser(start, end, lambda text: None), path, shown, _REMEDY, problems)
    return rows


def _read_tidy_text(path: Path, shown: str, problems: list[Problem]) -> list[Row]:
    matches = filter(None, map(_TIDY.match, read_text(path, shown, problems).splitlines()))
    return [((match["rule"] or match["level"]).partition(",")[0], match["text"], match["file"], int(match["line"])) for match in matches]


def _read_tidy_yaml(path: Path, shown: str, problems: list[Problem]) -> list[Row]:
    import yaml  # slow to load, and few projects have such a file

    try:
        text, loader = read_text(path, shown, problems), getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        demand_shallow(text, loader)
        content = yaml.load(text, loader)
    except yaml.YAMLError as error:
        raise ValueError(str(error)) from None
    return list(_take_diagnostics(content))


def _take_diagnostics(content: dict[str, Any]) -> Iterator[Row]:
    for one in content["Diagnostics"] or ():
        if str(one.get("Level", "Warning")).lower() not in _QUIET:
            message = one.get("DiagnosticMessage") or one
            file = str(message.get("FilePath", ""))
            yield str(one["DiagnosticName"]), str(message["Message"]), file, _count_line(Path(file), int(message.get("FileOffset", 0)))


def _count_line(path: Path, offset: int) -> int:
    """clang-tidy's YAML counts bytes. @return 1 for a missing file."""
    try:
        return path.read_bytes().count(b"\n", 0, offset) + 1 if path.is_file() else 1
    except OSError:
        return 1


_READERS = {".sarif": _read_sarif, ".json": _read_sarif, ".xml": _read_cppcheck, ".txt": _read_tidy_text, ".log": _read_tidy_text,
            ".yaml": _read_tidy_yaml, ".yml": _read_tidy_yaml}  # fmt: skip
