# SPDX-License-Identifier: Apache-2.0
"""Writes a plan for the other tools: OpenFastTrace Markdown with tagged sources, StrictDoc documents with related sources.

Items, statements, links, functions and tests equal those of the native project. OpenFastTrace reads no test results, so it gets none.
StrictDoc reads them from files with the corresponding names.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from verification.trace_bench.large_project import Plan, Requirement, Source, format_source, format_tests, get_test

_KINDS = {"STK": "feat", "SYS": "req", "SWR": "dsn"}
_NEEDS = {"STK": "req", "SYS": "dsn", "SWR": "impl, utest"}


def write_openfasttrace(plan: Plan, root: Path) -> None:
    """Writes three documents and the sources to `root`, which is deleted first."""
    shutil.rmtree(root, ignore_errors=True)
    for level, items in (("STK", plan.needs), ("SYS", plan.system), ("SWR", plan.software)):
        _write(root / "doc" / f"{level.lower()}.md", f"# {level} items\n\n" + "".join(map(_format_specification, items)))
    _write_sources(root, plan.sources, plan.tests, "/// [impl->dsn~{lower}~1]", "    // [utest->dsn~{lower}~1]")


def write_strictdoc(plan: Plan, root: Path) -> None:
    """Writes three documents, the sources and the results to `root`, which is deleted first."""
    shutil.rmtree(root, ignore_errors=True)
    features = '[\n  "REQUIREMENT_TO_SOURCE_TRACEABILITY",\n  "SOURCE_FILE_LANGUAGE_PARSERS",\n]'
    _write(root / "strictdoc.toml", f'[project]\ntitle = "Large project"\nfeatures = {features}\n')
    for level, items in (("STK", plan.needs), ("SYS", plan.system), ("SWR", plan.software)):
        _write(root / "doc" / f"{level.lower()}.sdoc", f"[DOCUMENT]\nTITLE: {level} items\n\n" + "\n".join(map(_format_node, items)))
    tag = "/// @relation({id}, scope=function)"
    _write_sources(root, plan.sources, plan.tests, tag, "    // @relation({id}, scope=line)")
    cases = "".join(
        f'    <testcase name="{name}" status="run" result="completed" time="0.001" classname="{suite}"/>\n'
        for suite, name in map(get_test, plan.software)
    )
    head = f'<testsuites tests="{len(plan.software)}" failures="0" disabled="0" errors="0" time="1" name="AllTests">\n'
    _write(root / "results" / "all.gtest.junit.xml", f'<?xml version="1.0" encoding="UTF-8"?>\n{head}{cases}</testsuites>\n')


def _format_specification(item: Requirement) -> str:
    covers = "".join(f"- `{_get_name(parent)}`\n" for parent in item.parents)
    return (
        f"## {item.title}\n\n`{_get_name(item.id)}`\n\n{item.statement}\n\nRationale:\n\n{item.rationale}\n\n"
        + (f"Covers:\n\n{covers}\n" if covers else "")
        + f"Needs: {_NEEDS[item.level]}\n\n"
    )


def _get_name(item_id: str) -> str:
    """`SWR-AR01-00100` -> `dsn~swr-ar01-00100~1`."""
    return f"{_KINDS[item_id.partition('-')[0]]}~{item_id.lower()}~1"


def _format_node(item: Requirement) -> str:
    relations = "".join(f"- TYPE: Parent\n  VALUE: {parent}\n" for parent in item.parents)
    return (
        f"[REQUIREMENT]\nUID: {item.id}\nTITLE: {item.title}\nSTATEMENT: >>>\n{item.statement}\n<<<\n"
        f"RATIONALE: >>>\n{item.rationale}\n<<<\n" + (f"RELATIONS:\n{relations}" if relations else "")
    )


def _write_sources(root: Path, sources: Iterable[Source], tests: Iterable[Source], tag: str, test_tag: str) -> None:
    for source in sources:
        _write(root / source.path, format_source(source, tag))
    for source in tests:
        _write(root / source.path, format_tests(source, test_tag))


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")
