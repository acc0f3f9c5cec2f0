# SPDX-License-Identifier: Apache-2.0
"""Writes a plan in one format. Each writer defines the shape of the ids, the files, and the arguments of the command."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from faulty.more_writers import make_doorstop_id, make_trlc_id, write_doorstop, write_trlc
from faulty.page import Pages
from faulty.plan import Plan, Requirement
from faulty.sources import write_environment, write_results, write_sources

_SCHEMA = Path(__file__).parents[4] / "requirements" / "schema" / "items.toml"
_PREFIXES = ("STK", "SYS", "SWR")
_NAMES = ("Needs", "System requirements", "Software requirements")
_EVIDENCE = "build/host-release/evidence"


@dataclass(frozen=True)
class Writer:
    """`arguments` follow `mamori trace check`; ROOT is replaced by the folder of the project."""

    make_id: Callable[[int, int], str]
    write: Callable[[Plan, Pages], None]
    arguments: tuple[str, ...]


def _make_native_id(level: int, number: int) -> str:
    return f"SWR-GEN-{number:03}" if level == 2 else f"{_PREFIXES[level]}-{number:03}"


def _write_native(plan: Plan, pages: Pages) -> None:
    for each in plan.requirements:
        file = f"requirements/{('stakeholder', 'system', 'software')[each.level]}/generated.md"
        if file not in pages.files:
            pages.add(file, f"# {_NAMES[each.level]}")
        pages.add(file, "")
        pages.add(file, f"## {each.id} {each.title}", (each.id, "item"))
        pages.add(file, "")
        if each.statement:
            pages.add(file, each.statement, (each.id, "statement"))
            pages.add(file, "")
        rows = {"Rationale": "It is needed.", "Parents": ", ".join(each.parents) or "-", "SIL": each.sil, "Verify": each.verify,
                "Polarity": each.polarity, "Design": each.design, "Status": each.status}  # fmt: skip
        for name, value in rows.items():
            pages.add(file, f"- {name}: {value}", (each.id, name))
    pages.add("docs/design/generated.md", "# Generated")
    write_sources(plan, pages, "/// @satisfies {}", "", native=True)
    named = lambda test: {"requirement": test.result_requirement or test.requirement} if test.requirement else {}  # noqa: E731
    write_results(plan, pages, f"{_EVIDENCE}/junit", named)
    write_environment(plan, pages, _EVIDENCE)


def _make_sdoc_id(level: int, number: int) -> str:
    return f"{_PREFIXES[level]}-{number:03}"


def _write_sdoc(plan: Plan, pages: Pages) -> None:
    for level, name in enumerate(_NAMES):
        file = f"docs/{_PREFIXES[level].lower()}.sdoc"
        for line in ("[DOCUMENT]", f"TITLE: {name}", "", "[GRAMMAR]", "ELEMENTS:", "- TAG: REQUIREMENT", "  FIELDS:"):
            pages.add(file, line)
        for field in ("UID", "SIL", "VERIFY", "POLARITY", "STATUS", "TITLE", "STATEMENT", "RATIONALE"):
            pages.add(file, f"  - TITLE: {field}")
            pages.add(file, "    TYPE: String")
            pages.add(file, "    REQUIRED: False")
        for line in ("  RELATIONS:", "  - TYPE: Parent", "  - TYPE: File"):
            pages.add(file, line)
        for each in plan.list_level(level):
            _write_sdoc_node(each, pages, file)
    write_sources(plan, pages, "// @relation({}, scope=function)", "// @relation({}, scope=function)")
    write_results(plan, pages, "results", lambda test: {"requirement": test.result_requirement} if test.result_requirement else {})
    write_environment(plan, pages, "results")


def _write_sdoc_node(each: Requirement, pages: Pages, file: str) -> None:
    pages.add(file, "")
    pages.add(file, "[REQUIREMENT]")
    pages.add(file, f"UID: {each.id}", (each.id, "item"))
    pages.add(file, f"SIL: {each.sil}", (each.id, "SIL"))
    if each.verify != "test":
        pages.add(file, f"VERIFY: {each.verify}", (each.id, "Verify"))
    if each.polarity != "nominal":
        pages.add(file, f"POLARITY: {each.polarity}", (each.id, "Polarity"))
    pages.add(file, f"STATUS: {each.status.capitalize()}")
    pages.add(file, f"TITLE: {each.title}")
    if each.statement:
        pages.add(file, "STATEMENT: >>>", (each.id, "statement"))
        pages.add(file, each.statement)
        pages.add(file, "<<<")
    pages.add(file, "RATIONALE: It is needed.")
    if each.parents:
        pages.add(file, "RELATIONS:")
    for number, parent in enumerate(each.parents):
        pages.add(file, "- TYPE: Parent")
        pages.add(file, f"  VALUE: {parent}", *([(each.id, "Parents")] if number == 0 else []), (f"{each.id}>{parent}", "Parents"))


def _make_oft_id(level: int, number: int) -> str:
    return f"{('feat', 'req', 'dsn')[level]}~item-{number:03}~1"


def _write_oft(plan: Plan, pages: Pages) -> None:
    needs = ("req", "dsn", "impl, utest")
    for each in plan.requirements:
        file = f"docs/{('features', 'requirements', 'design')[each.level]}.md"
        if file not in pages.files:
            pages.add(file, f"# {_NAMES[each.level]}")
        shown = plan.revisions.get(each.id, each.id)
        for line in ("", f"## {each.title}"):
            pages.add(file, line)
        pages.add(file, f"`{shown}`", (each.id, "item"))
        pages.add(file, "")
        if each.status != "approved":
            pages.add(file, f"Status: {'rejected' if each.status == 'retired' else each.status}")
            pages.add(file, "")
        if each.statement:
            pages.add(file, each.statement, (each.id, "statement"))
            pages.add(file, "")
        if each.parents:
            pages.add(file, "Covers:")
            pages.add(file, "")
        for number, parent in enumerate(each.parents):
            pages.add(file, f"- `{parent}`", *([(each.id, "Parents")] if number == 0 else []))
        if each.parents:
            pages.add(file, "")
        pages.add(file, f"Needs: {needs[each.level]}")
    write_sources(plan, pages, "// [impl->{}]", "// [utest->{}]")
    write_results(plan, pages, "results", lambda test: {"requirement": test.result_requirement} if test.result_requirement else {})
    write_environment(plan, pages, "results")


def _make_needs_id(level: int, number: int) -> str:
    return f"{_PREFIXES[level]}_{number:03}"


def _write_needs(plan: Plan, pages: Pages) -> None:
    file = "docs/needs.json"
    for line in ("{", ' "current_version": "1.0",', ' "project": "Generated",', ' "versions": {', '  "1.0": {', '   "needs": {'):
        pages.add(file, line)
    for number, each in enumerate(plan.requirements):
        kind = ("stk_req", "sys_req", "sw_req")[each.level]
        rows = [("id", each.id, "id"), ("title", each.title, "title"), ("type", kind, "type"), ("docname", "generated", ""),
                ("status", each.status, "Status"), ("content", each.statement, "statement"), ("safety", each.sil, "SIL"),
                ("verify", each.verify if each.verify != "test" else "", "Verify"),
                ("polarity", each.polarity if each.polarity != "nominal" else "", "Polarity"),
                ("links", each.parents, "Parents")]  # fmt: skip
        pages.add(file, f'    "{each.id}": {{', (each.id, "item"))
        for index, (name, value, part) in enumerate(rows):
            comma = "," if index + 1 < len(rows) else ""
            marks = [(each.id, part)] if part and (value or part == "statement") else []
            pages.add(file, f'     "{name}": {json.dumps(value)}{comma}', *marks)
        pages.add(file, "    }" + ("," if number + 1 < len(plan.requirements) else ""))
    for line in ("   }", "  }", " }", "}"):
        pages.add(file, line)
    write_sources(plan, pages, "// @need-ids: {}", "// @need-ids: {}")
    write_results(plan, pages, "results", lambda test: {"Verifies": test.result_requirement or test.requirement} if test.requirement else {})
    write_environment(plan, pages, "results")


WRITERS = {
    "native": Writer(_make_native_id, _write_native, ("--root", "ROOT")),
    "strictdoc": Writer(_make_sdoc_id, _write_sdoc, ("--format", "strictdoc", "ROOT", "--results", "ROOT/results")),
    "oft": Writer(_make_oft_id, _write_oft, ("--format", "oft", "ROOT", "--results", "ROOT/results")),
    "needs": Writer(_make_needs_id, _write_needs, ("--format", "needs", "ROOT", "--results", "ROOT/results")),
    "doorstop": Writer(make_doorstop_id, write_doorstop, ("--format", "doorstop", "ROOT", "--results", "ROOT/results")),
    "trlc": Writer(make_trlc_id, write_trlc, ("--format", "trlc", "ROOT", "--results", "ROOT/results")),
}


def add_native_schema(root: Path) -> None:
    (root / "requirements" / "schema").mkdir(parents=True, exist_ok=True)
    shutil.copy(_SCHEMA, root / "requirements" / "schema")
