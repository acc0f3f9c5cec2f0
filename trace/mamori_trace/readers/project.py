# SPDX-License-Identifier: Apache-2.0
"""Reads a complete project: requirements, sources, evidence, review lock."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.files import get_shown_path, list_paths
from mamori_trace.base.finding import Problem
from mamori_trace.model.code import CodeBase
from mamori_trace.model.evidence import INTEGRATION, UNIT, Evidence
from mamori_trace.model.project import Project, attach_sources
from mamori_trace.readers.analysis import read_analysis
from mamori_trace.readers.campaign import read_campaign, read_environment
from mamori_trace.readers.code_schema import read_code_schema
from mamori_trace.readers.cost import read_cost
from mamori_trace.readers.coverage import read_coverage
from mamori_trace.readers.cpp_tags import read_cpp_tags
from mamori_trace.readers.cpp_tests import read_cpp_tests
from mamori_trace.readers.decomposition import read_decomposition
from mamori_trace.readers.evidence_records import read_evidence_records
from mamori_trace.readers.git import read_commit_date, read_head
from mamori_trace.readers.ids import read_ids
from mamori_trace.readers.junit import read_junit
from mamori_trace.readers.kinds import read_kinds
from mamori_trace.readers.lock import read_lock
from mamori_trace.readers.markdown_items import read_items
from mamori_trace.readers.other_tests import read_other_tests
from mamori_trace.readers.python_sources import read_python
from mamori_trace.readers.reviews import read_reviews
from mamori_trace.readers.rule_pack import read_rule_pack
from mamori_trace.readers.schema import read_schema
from mamori_trace.readers.script_tags import read_script_tags
from mamori_trace.readers.size import read_size
from mamori_trace.readers.source_names import SourceNames
from mamori_trace.readers.sources import calc_sources
from mamori_trace.readers.techniques import read_techniques
from mamori_trace.readers.timing import read_timing
from mamori_trace.readers.toml_rows import is_date
from mamori_trace.readers.waivers import read_waivers


def find_evidence(root: Path) -> Path:
    """The evidence folder of the release build, or otherwise the only one. Raises InputError if there is none."""
    folders = _list_evidence(root)
    preferred = root / "build" / "host-release" / "evidence"
    if preferred in folders:
        return preferred
    if len(folders) == 1:
        return folders[0]
    if folders:
        names = ", ".join(get_shown_path(folder, root) for folder in folders)
        raise InputError(f"several evidence folders: {names}; choose one with --evidence")
    raise InputError(f"{root}: no evidence in build/*/evidence; run the tests first, or name the folder with --evidence")


def _list_evidence(root: Path) -> list[Path]:
    problems: list[Problem] = []
    folders = [path / "evidence" for path in list_paths(root, "build/*", root, problems)]
    if problems:
        raise InputError(f"{root / problems[0].place.file}: {problems[0].message}")
    return [folder for folder in folders if folder.is_dir()]


def read_requirements(root: Path) -> Project:
    """Only items and review lock, without code and evidence. Raises InputError without a requirements folder."""
    if not (root / "requirements").is_dir():
        raise InputError(f"{root}: no folder 'requirements' here; run in the project's folder, name it with --root, or begin one with `mamori trace init`")
    project = Project(root, read_schema(root))
    project.all_items = read_items(root, project.schema, project.problems)
    project.lock = read_lock(root, project.problems)
    project.former_ids = read_ids(root, project.problems)
    return project


def read_judgement(project: Project, rules: Sequence[str], date: str = "") -> None:
    """Project data besides the items: pack, waivers, records, techniques, kinds, and the date of the check. Raises InputError.

    `rules` are the ids that packs and waivers may name; the caller that runs the rules knows them.
    `date` empty: the day of the checked-out commit, or otherwise that of the evidence. The clock is never used, because the outcome would
    then change by itself.
    """
    project.pack = read_rule_pack(project.root, project.schema, rules)
    project.waivers = read_waivers(project.root, rules, project.problems)
    project.decomposition = read_decomposition(project.root, project.problems)
    project.reviews = read_reviews(project.root, project.schema, project.problems)
    project.techniques = read_techniques(project.root, project.problems)
    project.kinds = read_kinds(project.root, project.schema)
    project.date = date
    if not date and any(waiver.expires for waiver in project.waivers):
        made = str(project.evidence.environment.get("date_utc") or "")[:10]
        project.date = read_commit_date(project.root) or (made if is_date(made) else "")


def read_project(root: Path, evidence: Path | None, rules: Sequence[str], allow_missing: bool = False, date: str = "") -> Project:
    """The complete project. `rules` are the known rule ids.

    `evidence` None: searches the folder; a missing folder raises InputError unless results may be missing.
    """
    project = read_requirements(root)
    project.allow_missing = allow_missing
    project.head = read_head(root)
    project.code_schema = read_code_schema(root)
    code = CodeBase()
    project.tags = read_cpp_tags(root, project.problems, code)
    project.tags += read_script_tags(root, project.problems)
    project.tests = read_cpp_tests(root, project.problems)
    project.tests += read_other_tests(root, project.problems)
    tags, tests = read_python(root, project.problems, code)
    project.tags += tags
    project.tests += tests
    project.functions = code.bind()
    folder = _choose_evidence(root, evidence, allow_missing)
    if folder is not None:
        project.evidence = read_evidence(folder, project)
        attach_sources(project)
        if project.evidence.tells_sources:
            project.sources = calc_sources(root, project.code_schema.no_evidence)
        for result in project.evidence.results:
            if result.kind == UNIT and result.source is not None and project.code_schema.is_integration(result.source.file):
                result.kind = INTEGRATION
    read_judgement(project, rules, date)
    return project


def _choose_evidence(root: Path, evidence: Path | None, allow_missing: bool) -> Path | None:
    if evidence is not None:
        if not evidence.is_dir():
            raise InputError(f"{evidence}: no such evidence folder; run the tests first")
        return evidence
    if allow_missing and not _list_evidence(root):
        return None
    return find_evidence(root)


def read_evidence(folder: Path, project: Project) -> Evidence:
    """All files below one evidence folder."""
    evidence = Evidence(folder=folder.as_posix(), shown=get_shown_path(folder, project.root))
    evidence.results = read_junit(folder / "junit", project.root, project.problems)
    read_environment(folder, project.root, evidence, project.problems)
    read_campaign(folder, project.root, evidence, project.problems)
    read_timing(folder, project.root, evidence, project.problems)
    read_cost(folder, project.root, evidence, project.problems)
    read_size(folder, project.root, evidence, project.problems)
    read_evidence_records(folder, project.root, evidence, project.problems)
    evidence.unbind()
    names = SourceNames(project.root, {function.file for function in project.functions})
    read_coverage(folder, project.root, names, evidence, project.problems)
    read_analysis(folder, names, project.root, evidence, project.problems)
    return evidence
