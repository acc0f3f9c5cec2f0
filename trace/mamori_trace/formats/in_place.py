# SPDX-License-Identifier: Apache-2.0
"""Reads a project in the format of another tool into the model of the rules, without importing it.

@satisfies SWR-TRC-045, SWR-TRC-046, SWR-TRC-047      Design: docs/design/trace_formats.md#in-place
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.files import get_shown_path, list_paths
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.file_links import add_file_links
from mamori_trace.formats.items import Converted, convert
from mamori_trace.formats.mapping import read_mapping
from mamori_trace.formats.registry import read_format
from mamori_trace.formats.sources import read_sources
from mamori_trace.model.code import CodeBase
from mamori_trace.model.evidence import UNIT, CodeTag, Evidence, SourceTest, TestResult
from mamori_trace.model.project import Project, attach_sources, list_result_keys
from mamori_trace.model.rule_pack import Grades
from mamori_trace.readers.code_schema import read_code_schema
from mamori_trace.readers.evidence_records import read_evidence_records
from mamori_trace.readers.git import read_head
from mamori_trace.readers.ids import read_ids
from mamori_trace.readers.junit import read_junit_file
from mamori_trace.readers.lock import read_lock
from mamori_trace.readers.project import read_evidence, read_judgement
from mamori_trace.readers.sources import calc_sources

LOCK_NAME = "trace.lock"
_REVISION = re.compile(r"~\d+$")


@dataclass(slots=True)
class ForeignInput:
    """The inputs. `sources` None: the folder of `path`. `results` are JUnit files or folders of them."""

    format: str
    path: Path
    root: Path = Path(".")
    results: list[Path] = field(default_factory=list)
    sources: Path | None = None
    schema: Path | None = None
    evidence: Path | None = None
    allow_missing: bool = False
    date: str = ""

    @property
    def folder(self) -> Path:
        """The folder of `path`, or `path` if it is a folder."""
        return self.path if self.path.is_dir() else self.path.parent


def read_in_place(given: ForeignInput, rules: Sequence[str]) -> Project:
    """The project with all its evidence. `rules` are the known rule ids. Raises InputError if no check is possible."""
    mapping = read_mapping(given.format, given.schema)
    if not given.root.is_dir():
        raise InputError(f"{given.root}: no such folder; --root names the folder of the project")
    folder = given.folder
    root = given.root if folder.resolve().is_relative_to(given.root.resolve()) else folder
    problems: list[Problem] = []
    foreign = read_format(given.format, given.path, root, problems)
    converted = convert(foreign, mapping, problems)
    project = Project(root, converted.schema, converted.items, problems=problems, allow_missing=given.allow_missing)
    project.lock = read_lock(root, problems, folder / LOCK_NAME)
    project.former_ids = read_ids(root, problems)
    project.review_needed = project.lock is not None
    project.review_command += f" --format {given.format} {shlex.quote(str(given.path))}"
    project.head = read_head(folder)
    project.code_schema = read_code_schema(root)
    base = CodeBase()
    tags, tests = read_sources(given.sources or folder, root, problems, base if project.code_schema.traced or given.evidence else None)
    add_file_links(foreign.items, [root, folder, given.sources or folder], tags, tests, problems)
    base.scopes = [scope._replace(requirements=_resolve_all(scope.requirements, converted)) for scope in base.scopes]
    project.functions = base.bind()
    code = [CodeTag(target, item.place, item.id) for item in converted.code_items for target in converted.stands_for[item.id]]
    project.tags = [tag._replace(requirement=each) for tag in tags for each in _resolve(tag.requirement, tag.place, converted, problems)] + code
    project.tests = [test._replace(requirement=each) for test in tests for each in _resolve(test.requirement, test.place, converted, problems)]
    project.evidence = _read_evidence(given, project)
    project.evidence.results = _link_results(project.evidence.results, project.tests, converted, problems)
    attach_sources(project)
    _follow_polarity(project, converted)
    read_judgement(project, rules, given.date)
    project.pack.grades["design-missing"] = Grades()  # the rule keeps its own severity (off), because no format has design links
    return project


def _resolve_all(named: tuple[str, ...], converted: Converted) -> tuple[str, ...]:
    return tuple(dict.fromkeys(each for word in named for each in converted.stands_for.get(word, (word,))))


def _resolve(named: str, place: Place, converted: Converted, problems: list[Problem]) -> Iterable[str]:
    """The requirements of an id: the id itself, the requirements of a test or code item, or the current revision of an outdated id."""
    if named in converted.stands_for:
        return converted.stands_for[named]
    current = converted.revisions.get(_REVISION.sub("", named), named)
    if current != named:
        message = f"names {named}, and the item is at {current}; look again and name the new revision"
        problems.append(Problem("suspect-link", place, message, current))
    return (current,)


def _read_evidence(given: ForeignInput, project: Project) -> Evidence:
    """Results of the named files, and of a complete evidence folder if there is one."""
    if given.evidence is not None and not given.evidence.is_dir():
        raise InputError(f"{given.evidence}: no such evidence folder; run the tests first")
    evidence = read_evidence(given.evidence, project) if given.evidence else Evidence()
    folders: list[Path] = []
    evidence.results_shown = ", ".join(get_shown_path(path, project.root) for path in given.results) or "--results, which names no file"
    for path in given.results:
        if not path.exists():
            raise InputError(f"{path}: no such result file; run the tests first")
        files = list_paths(path, "*.xml", project.root, project.problems) if path.is_dir() else [path]
        if not files and not project.problems:
            raise InputError(f"{path}: holds no result file (*.xml); run the tests first")
        for file in files:
            evidence.results += read_junit_file(file, get_shown_path(file, project.root), UNIT, project.root, project.problems)
            folders += [file.parent, file.parent.parent]
    for folder in dict.fromkeys(folders):
        if folder != given.evidence:
            read_evidence_records(folder, project.root, evidence, project.problems)
    evidence.unbind()
    if evidence.tells_sources and not project.sources:
        project.sources = calc_sources(given.root, read_code_schema(given.root).no_evidence)
    return evidence


def _link_results(results: list[TestResult], tests: list[SourceTest], converted: Converted, problems: list[Problem]) -> list[TestResult]:
    """One result for each requirement that the result, or its test in the sources, names."""
    known: dict[tuple[str, str], list[SourceTest]] = {}
    for test in tests:
        known.setdefault((test.suite, test.name), []).append(test)
    linked = []
    for result in results:
        own = [word.strip() for word in result.requirement.split(",") if word.strip()]
        targets = [(each, result.polarity) for word in own for each in _resolve(word, result.place, converted, problems)]
        if not targets:
            sources = next((known[key] for key in list_result_keys(result) if key in known), [])
            targets = [(test.requirement, result.polarity or test.polarity) for test in sources]
        for requirement, polarity in dict.fromkeys(targets or [("", "")]):
            linked.append(replace(result, requirement=requirement, polarity=polarity))
    return linked


def _follow_polarity(project: Project, converted: Converted) -> None:
    """An item whose format has no polarity requires the polarity that its tests show."""
    for item in project.all_items:
        shown = {test.polarity for test in project.tests_of.get(item.id, [])} | {
            result.polarity or "nominal" for result in project.results_of.get(item.id, [])
        }
        if item.id not in converted.polar and shown == {"violation"}:
            item.polarity = ("violation",)
