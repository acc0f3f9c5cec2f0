# SPDX-License-Identifier: Apache-2.0
"""Creates a large clean project: requirements on three levels, C++ sources and tests, results, review lock. Equal sizes give equal bytes.

`Plan` contains the project; `write_native` writes it for the trace tool, `peer_projects` for the reference implementations.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from mamori_trace.actions.records import make_rows, write_rows
from mamori_trace.actions.review import review_links
from mamori_trace.readers.evidence_records import list_recorded
from mamori_trace.readers.lock import write_lock
from mamori_trace.readers.project import read_requirements

SCHEMA = Path(__file__).resolve().parents[2] / "requirements" / "schema" / "items.toml"
COMMIT_WITHOUT_GIT = "0123456789abcdef0123456789abcdef01234567"
EVIDENCE = "build/host-release/evidence"
LEAST = 20
"""Requirements of the smallest project in which each level has an item."""

_AREA_ITEMS = 100
_SOURCE_FUNCTIONS = 5
_TEST_SOURCES = 10
_SUBJECTS = ("supervisor", "scheduler", "recorder", "gate", "monitor", "channel", "encoder", "limiter", "clock", "queue")
_ACTIONS = ("report", "store", "refuse", "count", "compare", "signal", "latch", "forward", "measure", "release")
_OBJECTS = ("the frame", "the sample", "the sequence number", "the position", "the torque limit", "the time stamp", "the state word",
            "the checksum", "the queue depth", "the supply voltage")  # fmt: skip


@dataclass(frozen=True, slots=True)
class Requirement:
    """One item of the plan. `level` is STK, SYS or SWR; `number` counts within the level from 0."""

    id: str
    level: str
    number: int
    title: str
    statement: str
    rationale: str
    parents: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Source:
    """One C++ source: `path` below the project, the requirements that its functions satisfy, in order."""

    path: str
    requirements: tuple[Requirement, ...]


@dataclass(frozen=True)
class Plan:
    """A project of `count` requirements. Of ten requirements, one is a need, three are system and six are software requirements."""

    count: int

    @cached_property
    def needs(self) -> list[Requirement]:
        return [self._make("STK", number, ()) for number in range(self.count // 10)]

    @cached_property
    def system(self) -> list[Requirement]:
        needs = self.needs
        return [self._make("SYS", number, (needs[number % len(needs)].id,)) for number in range(self.count * 3 // 10)]

    @cached_property
    def software(self) -> list[Requirement]:
        system = self.system
        rest = self.count - len(self.needs) - len(system)
        return [self._make("SWR", number, (system[number % len(system)].id,)) for number in range(rest)]

    @property
    def all(self) -> list[Requirement]:
        return [*self.needs, *self.system, *self.software]

    @cached_property
    def sources(self) -> list[Source]:
        """Sources with five functions each: 10,000 requirements have 1,200 sources."""
        parts = _slice(self.software, _SOURCE_FUNCTIONS)
        return [Source(f"code/area_{_get_area(part[0])}/unit_{index:04d}.cpp", tuple(part)) for index, part in enumerate(parts)]

    @cached_property
    def tests(self) -> list[Source]:
        """One test for each software requirement, fifty per file."""
        parts = _slice(self.software, _SOURCE_FUNCTIONS * _TEST_SOURCES)
        return [Source(f"code/area_{_get_area(part[0])}/tests/group_{index:03d}_test.cpp", tuple(part)) for index, part in enumerate(parts)]

    def _make(self, level: str, number: int, parents: tuple[str, ...]) -> Requirement:
        subject, action = _SUBJECTS[number % 10], _ACTIONS[number // 10 % 10]
        thing, cycle = _OBJECTS[(number // 100 + number) % 10], number % 97 + 1
        name = f"SWR-AR{number // _AREA_ITEMS:02d}-{number:05d}" if level == "SWR" else f"{level}-{number:05d}"
        verb = "needs" if level == "STK" else "shall"
        statement = (
            f"The {subject} {verb} to {action} {thing} within {cycle} control cycles."
            if level == "STK"
            else f"The {subject} {verb} {action} {thing} within {cycle} control cycles after request {number} of the {level} set."
        )
        rationale = f"Without it the {subject} of unit {number} would leave {thing} open for more than {cycle} cycles."
        return Requirement(name, level, number, f"{subject.capitalize()} {action}s {thing}, case {number}", statement, rationale, parents)


def get_folder(plan: Plan, kind: str, base: Path) -> Path:
    """Folder of the project for this plan, below `base`."""
    return base / f"{kind}_{plan.count}"


def get_function(requirement: Requirement) -> str:
    """Name of the C++ function that satisfies the requirement."""
    return f"handle_case_{requirement.number:05d}"


def get_test(requirement: Requirement) -> tuple[str, str]:
    """(suite, name) of the test that verifies the requirement."""
    return f"Area{_get_area(requirement)}Test", f"HandlesCase{requirement.number:05d}"


def write_native(plan: Plan, root: Path, with_git: bool = False) -> None:
    """Writes the project to `root`, which is deleted first.

    @param with_git makes `root` a repository of one commit, which the evidence names, as in a real project.
    """
    if plan.count < LEAST:
        raise ValueError(f"a project of {plan.count} requirements has no three levels; ask for at least {LEAST}")
    shutil.rmtree(root, ignore_errors=True)
    schema = SCHEMA.read_text(encoding="utf-8").replace(r"\d{3}'", r"\d{3,6}'")
    _write(root / "requirements" / "schema" / "items.toml", schema)
    _write(root / ".gitignore", "/build/\n/report/\n")
    for name, text in list_documents(plan):
        _write(root / name, text)
    for source in plan.sources:
        _write(root / source.path, format_source(source, "/// @satisfies {id}"))
    for source in plan.tests:
        _write(root / source.path, format_tests(source, "    verifies(\"{id}\");"))
    _write_results(plan, root / EVIDENCE / "junit")
    project = read_requirements(root)
    review_links(project, set(project.items), "2026-01-05", "the maintainers")
    assert project.lock is not None  # the lock stores the reviews
    write_lock(root, project.lock)
    commit = _make_commit(root) if with_git else COMMIT_WITHOUT_GIT
    _write(root / EVIDENCE / "environment.json", json.dumps(_make_environment(commit), indent=1) + "\n")
    inputs = {"sources": "", "tool_chain": "", "configuration": "large project"}
    write_rows(root / EVIDENCE, make_rows(root / EVIDENCE, list_recorded(root / EVIDENCE), inputs, lambda _: None))


def list_documents(plan: Plan) -> Iterator[tuple[str, str]]:
    """(path, text) of each Markdown file: a hundred items per file, and the design document to which they refer."""
    folders = {"STK": "stakeholder", "SYS": "system", "SWR": "software"}
    for level, items in (("STK", plan.needs), ("SYS", plan.system), ("SWR", plan.software)):
        for index, part in enumerate(_slice(items, _AREA_ITEMS)):
            blocks = "".join(_format_block(item, index) for item in part)
            yield f"requirements/{folders[level]}/area_{index:02d}.md", f"# {level} items, area {index:02d}\n\n{blocks}"
    for index, _ in enumerate(_slice(plan.software, _AREA_ITEMS)):
        parts = "".join(f"## Part {number}\n\nDecision {number} of the area: {_OBJECTS[number]} stays local.\n\n" for number in range(10))
        yield f"docs/design/area_{index:02d}.md", f"# Area {index:02d}\n\n{parts}"


def format_source(source: Source, tag: str) -> str:
    """C++ with one function for each requirement. @param tag line that names `{id}`, in the notation of the reader."""
    functions = "\n".join(
        f"/// Answers case {each.number}: counts up to the limit and keeps what was left.\n"
        f"/// @param[in] request number of cycles asked for, 0 .. 4294967295.\n"
        f"/// @return the cycles that are granted.\n"
        f"{tag.format(id=each.id, lower=each.id.lower())}\n"
        f"std::uint32_t {get_function(each)}(std::uint32_t request) noexcept {{\n"
        f"    constexpr std::uint32_t kLimit{{{each.number % 97 + 1}U}};\n"
        f"    if (request > kLimit) {{\n"
        f"        return kLimit;\n"
        f"    }}\n"
        f"    return request;\n"
        f"}}\n"
        for each in source.requirements
    )
    head = "// SPDX-License-Identifier: Apache-2.0\n#include <cstdint>\n\nnamespace sample {\n\n"
    return f"{head}{functions}\n}}  // namespace sample\n"


def format_tests(source: Source, tag: str) -> str:
    """GoogleTest source with one test for each requirement. @param tag as in `format_source`."""
    head = "// SPDX-License-Identifier: Apache-2.0\n#include <gtest/gtest.h>\n\n"
    tests = []
    for each in source.requirements:
        suite, name = get_test(each)
        line = tag.format(id=each.id, lower=each.id.lower())
        tests.append(f"TEST({suite}, {name}) {{\n{line}\n    EXPECT_EQ(sample::{get_function(each)}(0U), 0U);\n}}\n")
    return head + "\n".join(tests)


def _format_block(item: Requirement, area: int) -> str:
    rows = {
        "Rationale": item.rationale,
        "Parents": ", ".join(item.parents) or "-",
        "SIL": "1",
        "Verify": "review" if item.level == "STK" else "test",
        "Polarity": "nominal",
        "Design": f"docs/design/area_{area:02d}.md#part-{item.number % 10}" if item.level == "SWR" else "-",
        "Status": "approved",
    }
    return f"## {item.id} {item.title}\n\n{item.statement}\n\n" + "".join(f"- {key}: {value}\n" for key, value in rows.items()) + "\n"


def _write_results(plan: Plan, folder: Path) -> None:
    """One JUnit file for each area, in the form of GoogleTest."""
    for index, part in enumerate(_slice(plan.software, _AREA_ITEMS)):
        cases = []
        for each in part:
            suite, name = get_test(each)
            cases.append(
                f'    <testcase name="{name}" file="code/sample_test.cpp" line="{each.number + 1}" status="run" result="completed" '
                f'time="0.001" timestamp="2026-01-05T08:00:00.000" classname="{suite}">\n      <properties>\n'
                f'        <property name="requirement" value="{each.id}"/>\n'
                '        <property name="technique" value="requirements_based"/>\n'
                '        <property name="polarity" value="nominal"/>\n      </properties>\n    </testcase>\n'
            )
        count = f'tests="{len(part)}" failures="0" disabled="0" errors="0" time="0.1"'
        head = f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites {count} name="AllTests">\n  <testsuite name="Area{index:02d}Test" {count}>\n'
        _write(folder / f"area_{index:02d}.xml", head + "".join(cases) + "  </testsuite>\n</testsuites>\n")


def _make_environment(commit: str) -> dict[str, object]:
    return {
        "schema": "mamori.environment/1", "commit": commit, "dirty": False, "date_utc": "2026-01-05T08:00:00+00:00",
        "command": "made by the generator of large projects", "os": "none", "cpu": "none", "cores": 1, "compilers": {}, "packages": {},
        "python": "none",
    }  # fmt: skip


def _make_commit(root: Path) -> str:
    """Makes `root` a git repository of one commit with fixed names and dates. @return its hash."""
    who = {"NAME": "the maintainers", "EMAIL": "maintainers@localhost", "DATE": "2026-01-05T08:00:00+0000"}
    fixed = {f"GIT_{role}_{key}": value for role in ("AUTHOR", "COMMITTER") for key, value in who.items()}
    clean = {"PATH": "/usr/local/bin:/usr/bin:/bin", "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null", **fixed}
    steps = (("init", "-q", "-b", "main"), ("add", "."), ("commit", "-q", "-m", "Large project"), ("rev-parse", "HEAD"))
    for step in steps:
        answer = subprocess.run(["git", "-C", str(root), *step], env=clean, capture_output=True, text=True, check=True)
    return answer.stdout.strip()


def _get_area(requirement: Requirement) -> str:
    return f"{requirement.number // _AREA_ITEMS:02d}"


def _slice(items: list[Requirement], size: int) -> list[list[Requirement]]:
    return [items[start : start + size] for start in range(0, len(items), size)]


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")
