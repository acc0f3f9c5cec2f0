# SPDX-License-Identifier: Apache-2.0
"""The tests of a user project as a step: every test of `ctest -N` must have a result of this run, or the step fails.

@satisfies SWR-CLI-032, SWR-CLI-033      Design: docs/design/launcher.md#tests-of-a-project
"""

from __future__ import annotations

import json
import re
import shutil
import xml.etree.ElementTree as ElementTree
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

from mamori_tools.host import ctest_run, gtest_program
from mamori_tools.host.ctest_run import ProjectTest, Record
from mamori_tools.host.junit import count_results
from mamori_tools.host.process import Tick
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context
from mamori_trace.base.errors import WorkError
from mamori_trace.base.text_file import write_text
from mamori_trace.base.whole_file import whole_file

PROGRAMS = "programs.json"
"""Names the program that wrote each result file; stored with the files of the second test folder."""

_SHOWN = 3
_SLUG_LENGTH = 60
_OWN_VERDICT = ("WILL_FAIL", "PASS_REGULAR_EXPRESSION")
"""Properties with which CTest passes a test although its program fails: the cases of the program then do not count."""


@dataclass
class Collected:
    """Results of the run for each test."""

    files: dict[int, list[Path]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)


def get_folder(project: Project) -> Path:
    """The second test folder."""
    return project.build / "mamori_tests"


def run_project_tests(context: Context, tick: Tick, log: TextIO) -> None:
    """Runs all tests once and writes one result file per test process. @raise WorkError if a result is missing."""
    project, folder = context.project, get_folder(context.project)
    tests = ctest_run.list_tests(project.build)
    if not tests:
        raise WorkError(f"{project.build}: ctest finds no test; call enable_testing() and add_test() in CMakeLists.txt")
    ctest_run.prepare(tests, project.build, folder)
    own = {test.number: _get_own_output(test) for test in tests}
    before = {path: _get_stamp(path) for path in own.values() if path is not None}
    status = ctest_run.run_tests(folder, context.jobs, Path(log.name), project.root, tick)
    records = ctest_run.read_records(folder)
    listed = _list_cases(tests, context.jobs)
    _copy_own_outputs(tests, own, before, folder)
    collected = _collect(tests, records, listed, folder, project.junit)
    _write_programs(tests, collected, folder)
    for text in collected.missing:
        print(f"result-missing: {text}", file=log, flush=True)
    if collected.missing:
        more = len(collected.missing) - _SHOWN
        shown = "; ".join(collected.missing[:_SHOWN]) + (f"; and {more} more, see the log" if more > 0 else "")
        raise WorkError(f"result-missing: {shown}")
    if status != 0 and not count_results(path for files in collected.files.values() for path in files).failed:
        raise WorkError(f"ctest ended with status {status}")


def find_program(project: Project, result: Path) -> Path | None:
    """The program that wrote the result file of a test of the project."""
    try:
        programs = json.loads((get_folder(project) / PROGRAMS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    path = programs.get(result.name)
    return Path(path) if path and Path(path).is_file() else None


def _get_own_output(test: ProjectTest) -> Path | None:
    return gtest_program.find_own_output(test.command, test.folder)


def _get_stamp(path: Path) -> tuple[int, int, int] | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


def _list_cases(tests: list[ProjectTest], jobs: int) -> dict[int, list[gtest_program.Case]]:
    """The cases of every test that is a GoogleTest program. A disabled test does not run, so it has no cases."""
    base = ctest_run.make_environment()
    known: dict[str, bool] = {}

    def list_one(test: ProjectTest) -> list[gtest_program.Case] | None:
        if not known[test.command[0]]:
            return None
        environment = gtest_program.modify(base, test.get_words("ENVIRONMENT"), test.get_words("ENVIRONMENT_MODIFICATION"))
        return gtest_program.list_cases(test.command, test.folder, environment)

    asked = [test for test in tests if test.command and not test.properties.get("DISABLED")]
    for test in asked:
        if test.command[0] not in known:
            known[test.command[0]] = gtest_program.is_gtest_program(test.command[0])
    with ThreadPoolExecutor(max(1, jobs)) as pool:
        answers = list(pool.map(list_one, asked))
    return {test.number: cases for test, cases in zip(asked, answers, strict=True) if cases}


def _copy_own_outputs(tests: list[ProjectTest], own: dict[int, Path | None], before: dict[Path, tuple[int, int, int] | None],
                      folder: Path) -> None:  # fmt: skip
    """A file that the command line names is copied if it is new and belongs only to this test."""
    count = Counter(path for path in own.values() if path is not None)
    for test in tests:
        path = own[test.number]
        if path is not None and count[path] == 1 and path.is_file() and _get_stamp(path) != before[path]:
            target = ctest_run.get_result_folder(folder, test)
            target.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target / "own.xml")


def _collect(tests: list[ProjectTest], records: dict[str, list[Record]], listed: dict[int, list[gtest_program.Case]], folder: Path,
             junit: Path) -> Collected:  # fmt: skip
    collected = Collected()
    last = {test.name: test for test in tests}  # tests with the same name share a folder
    shared = Counter(test.name for test in tests)
    waiting = {name: sorted(ctest_run.get_result_folder(folder, test).glob("*.xml")) for name, test in last.items()}
    for test in tests:
        record = records[test.name].pop(0) if records.get(test.name) else None
        if record is None:
            collected.missing.append(f"test '{test.name}': ctest has no record of it")
            continue
        files = waiting[test.name] if shared[test.name] == 1 else _match_shared(waiting[test.name], listed.get(test.number))
        waiting[test.name] = [path for path in waiting[test.name] if path not in files]
        whole = [path for path in files if gtest_program.read_cases(path) is not None]
        is_counted = record.verdict != "passed" or not any(test.properties.get(name) for name in _OWN_VERDICT)
        failed = count_results(whole).failed > 0
        target = collected.files.setdefault(test.number, [])
        if is_counted:
            for path in whole:
                target.append(_give(path, junit, test, len(target)))
        expects_cases = record.verdict == "passed" and is_counted and listed.get(test.number)
        if (record.verdict == "failed" and not failed) or (not target and not expects_cases):
            target.append(_write_record(record, junit, test, len(target)))
        if is_counted and record.verdict == "passed":
            collected.missing += _find_missing(test, whole, files, listed)
    return collected


def _match_shared(files: list[Path], listed: list[gtest_program.Case] | None) -> list[Path]:
    """The first file that contains the cases of the test; None for other kinds of tests."""
    return next(([path] for path in files if listed and set(gtest_program.read_cases(path) or ()) >= set(listed)), [])


def _find_missing(test: ProjectTest, whole: list[Path], files: list[Path], listed: dict[int, list[gtest_program.Case]]) -> list[str]:
    """The missing cases of a test that CTest reports as passed."""
    torn = [path.name for path in files if path not in whole]
    if torn:
        return [f"test '{test.name}' passed, and its result file {torn[0]} is malformed; run it alone and look at its end"]
    wanted = listed.get(test.number, [])
    if whole and _is_sharded(test):
        return []  # a shard runs a part of its list; the trace check finds cases that no shard ran
    present = {case for path in whole for case in gtest_program.read_cases(path) or ()}
    lost = [case for case in wanted if case not in present]
    if not lost:
        return []
    own = _get_own_output(test)
    remedy = "; remove --gtest_output from its command or give it a file of its own" if own is not None and not whole else ""
    names = ", ".join(".".join(case) for case in lost[:_SHOWN])
    return [f"test '{test.name}' passed with {len(wanted) - len(lost)} of {len(wanted)} cases (no result: {names}){remedy}"]


def _is_sharded(test: ProjectTest) -> bool:
    return any(text.startswith("GTEST_TOTAL_SHARDS=") for name in ("ENVIRONMENT", "ENVIRONMENT_MODIFICATION")
               for text in test.get_words(name))  # fmt: skip


def _name_result(junit: Path, test: ProjectTest, index: int) -> Path:
    """A readable name with a number that makes it unique."""
    slug = re.sub(r"[^A-Za-z0-9]+", "-", test.name).strip("-")[:_SLUG_LENGTH]
    return junit / f"{test.number:04}{f'.{index}' if index else ''}{'-' if slug else ''}{slug}.xml"


def _give(path: Path, junit: Path, test: ProjectTest, index: int) -> Path:
    target = _name_result(junit, test, index)
    with whole_file(target) as part:
        shutil.copyfile(path, part)
    return target


def _write_record(record: Record, junit: Path, test: ProjectTest, index: int) -> Path:
    """One result, from the record of CTest."""
    suite = ElementTree.Element("testsuite", name="ctest")
    case = ElementTree.SubElement(suite, "testcase", name=test.name, classname=test.name, time=record.seconds)
    if record.verdict != "passed":
        ElementTree.SubElement(case, "failure" if record.verdict == "failed" else "skipped", message=record.message)
    target = _name_result(junit, test, index)
    with whole_file(target) as part:
        ElementTree.ElementTree(suite).write(part, encoding="utf-8", xml_declaration=True)
    return target


def _write_programs(tests: list[ProjectTest], collected: Collected, folder: Path) -> None:
    programs = {path.name: test.command[0] for test in tests if test.command for path in collected.files.get(test.number, ())}
    write_text(folder / PROGRAMS, json.dumps(programs, indent=1) + "\n")
