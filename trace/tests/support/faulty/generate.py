# SPDX-License-Identifier: Apache-2.0
"""Writes a project of one format with one fault, and returns the expected findings."""

from __future__ import annotations

import random
import shutil
from dataclasses import dataclass
from pathlib import Path

from faulty.faults import FAULTS
from faulty.page import Pages
from faulty.plan import COMMIT, Plan, make_plan
from faulty.writers import WRITERS, Writer, add_native_schema
from mamori_trace.actions.review import review_links
from mamori_trace.checks import list_rule_ids
from mamori_trace.formats.in_place import LOCK_NAME, ForeignInput, read_in_place
from mamori_trace.model.lock import ReviewLock
from mamori_trace.readers.lock import LOCK_PATH, write_lock
from mamori_trace.readers.project import read_requirements

REVIEWER = "the maintainers"
DATE = "2026-11-21"


@dataclass(frozen=True)
class Seeded:
    """An expected finding: it names `word` and is at `file:line`."""

    word: str
    file: str
    line: int


@dataclass(frozen=True)
class Generated:
    """`arguments` follow `mamori trace check`."""

    arguments: list[str]
    seeded: list[Seeded]


def generate(format_name: str, fault: str, root: Path, count: int = 100, seed: int = 1) -> Generated:
    """Writes the project to `root`, which is empty. An empty `fault` gives the clean project."""
    writer = WRITERS[format_name]
    plan = make_plan(writer.make_id, count)
    row = FAULTS[fault] if fault else None
    native = format_name == "native"
    if native:
        add_native_schema(root)
    if row and row.reviewed and format_name != "oft":
        _write(plan, writer, root)
        _review(format_name, root)
        shutil.rmtree(root / "docs")  # a later entry may be a file named docs
    seeds = row.spoil(plan, random.Random(seed)) if row else []
    pages = _write(plan, writer, root)
    if native and not (row and row.reviewed):
        _review(format_name, root)
    arguments = [word.replace("ROOT", str(root)) for word in writer.arguments]
    if row and row.evidence:
        _write_head(root)
        if not native:
            arguments += ["--evidence", str(root / "results")]
    return Generated(arguments, [Seeded(word, *_find(pages, key, parts, root, native)) for word, key, parts in seeds])


def _find(pages: Pages, key: str, parts: tuple[str, ...], root: Path, native: bool) -> tuple[str, int]:
    """The location in a written file, or the first line of the lock that names the id."""
    if parts != ("lock",):
        return pages.find(key, *parts)
    name = LOCK_PATH if native else LOCK_NAME
    lines = (root / name).read_text(encoding="utf-8").splitlines()
    return name, next(number for number, line in enumerate(lines, start=1) if key in line.split())


def _write(plan: Plan, writer: Writer, root: Path) -> Pages:
    pages = Pages()
    writer.write(plan, pages)
    for file, lines in plan.beside.items():
        for line, key in lines:
            pages.add(file, line, *([(key, "row")] if key else []))
    pages.write(root)
    return pages


def _review(format_name: str, root: Path) -> None:
    native = format_name == "native"
    project = read_requirements(root) if native else read_in_place(ForeignInput(format_name, root, root, allow_missing=True), list_rule_ids())
    review_links(project, set(project.items), DATE, REVIEWER)
    write_lock(root, project.lock or ReviewLock(), None if native else root / LOCK_NAME)


def _write_head(root: Path) -> None:
    """The part of a git repository that shows the checked-out commit."""
    for folder in ("objects", "refs"):
        (root / ".git" / folder).mkdir(parents=True)
    (root / ".git" / "HEAD").write_text(COMMIT + "\n", encoding="utf-8")
