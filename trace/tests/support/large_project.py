# SPDX-License-Identifier: Apache-2.0
"""A project of any size in memory, for the limits of time and size: three levels, results for a part of the items."""

from __future__ import annotations

from pathlib import Path

from trace_sample import ENVIRONMENT, SCHEMA

from mamori_trace.base.finding import Place
from mamori_trace.model.evidence import CodeTag, Evidence, SourceTest, TestResult
from mamori_trace.model.item import Item, Level, Schema
from mamori_trace.model.project import Project
from mamori_trace.readers.schema import read_schema

ITEM_COUNT = 10_000
RESULT_COUNT = 6_000
SOURCE_COUNT = 1_200
_AREAS = tuple("SUP SAF ARM TIM LOG BUS E2E KIN MOT PWR".split())
_VERBS = ("report", "refuse", "bound", "record", "supervise", "latch", "compare", "announce")
_THINGS = ("a silent entity", "a late frame", "a corrupted position", "an unknown state", "a lost message", "an overspeed of joint")


def make_large_project(root: Path, item_count: int = ITEM_COUNT, result_count: int = RESULT_COUNT) -> Project:
    """`item_count` items: 1 % needs, 9 % system requirements, 90 % software requirements."""
    schema = _allow_long_ids(read_schema(SCHEMA.parents[2]))
    project = Project(root, schema, allow_missing=True)
    _write_designs(root, item_count)
    needs, systems = max(1, item_count // 100), max(1, item_count * 9 // 100)
    software = item_count - needs - systems
    project.all_items = [_make_item("STK", number, ()) for number in range(needs)]
    project.all_items += [_make_item("SYS", number, (f"STK-{number % needs:05}",)) for number in range(systems)]
    project.all_items += [_make_item("SWR", number, (f"SYS-{number % systems:05}",)) for number in range(software)]
    names = [item.id for item in project.all_items[needs + systems :]]
    project.tags = [
        CodeTag(name, Place(f"kernel/src/unit_{number % SOURCE_COUNT:04}.cpp", 10 + number % 400), f"mamori::Unit{number}::step")
        for number, name in enumerate(names)
    ]
    project.evidence = Evidence(folder=root.as_posix(), shown="build", environment=ENVIRONMENT)
    project.evidence.results = [_make_result(number, names[number % len(names)]) for number in range(result_count)]
    project.tests = [
        SourceTest(result.requirement, result.suite, result.name, result.technique, result.polarity, result.place)
        for result in project.evidence.results
    ]
    return project


def _write_designs(root: Path, item_count: int) -> None:
    """The design document that the items name."""
    folder = root / "docs" / "design"
    folder.mkdir(parents=True, exist_ok=True)
    for part in range(40):
        heads = "".join(f"## Decision {number}\n" for number in range(part, item_count, 40))
        (folder / f"part_{part}.md").write_text(heads, encoding="utf-8")


def _allow_long_ids(schema: Schema) -> Schema:
    """Ids with three digits end at 999."""
    import dataclasses
    import re

    def widen(level: Level) -> Level:
        return dataclasses.replace(level, pattern=re.compile(level.pattern.pattern.replace("{3}", "{3,6}")))

    return dataclasses.replace(schema, levels={key: widen(level) for key, level in schema.levels.items()})


def _make_item(level: str, number: int, parents: tuple[str, ...]) -> Item:
    area = f"{_AREAS[number % len(_AREAS)]}-" if level == "SWR" else ""
    verb, thing = _VERBS[number % len(_VERBS)], _THINGS[number % len(_THINGS)]
    file = f"requirements/{level.lower()}/part_{number // 100:03}.md"
    return Item(
        id=f"{level}-{area}{number:05}", title=f"{verb.capitalize()} {thing} {number}", level=level, place=Place(file, 3 + 14 * (number % 100)),
        statement=f"The unit {number} shall {verb} {thing} within {number % 50 + 1} cycles and keep what it decided until the next start.",
        rationale=f"What happened in cycle {number} must be found without help from what failed.", parents=parents,
        sil=("QM", "1", "2", "3")[number % 4], verify=("test",) if level != "STK" else ("review",), polarity=("nominal",),
        design=f"docs/design/part_{number % 40}.md#decision-{number}", status="approved",
    )  # fmt: skip


def _make_result(number: int, requirement: str) -> TestResult:
    status = "failed" if number % 997 == 0 else "skipped" if number % 499 == 0 else "passed"
    place = Place(f"kernel/tests/unit_{number % SOURCE_COUNT:04}_test.cpp", 20 + number // SOURCE_COUNT)
    return TestResult(
        suite=f"Unit{number % SOURCE_COUNT:04}Test", name=f"Behaviour{number}IsAsDemanded", status=status, requirement=requirement,
        technique="requirements_based", polarity="nominal", message="" if status == "passed" else f"expected {number}, got 0",
        time_s=0.001 * (number % 7), place=place, source=place,
    )  # fmt: skip
