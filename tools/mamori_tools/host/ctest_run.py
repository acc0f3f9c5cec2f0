# SPDX-License-Identifier: Apache-2.0
"""Reads CTest's list of the tests of a project, and runs them with a separate result folder for each test process.

CTest runs a second test folder, which includes the tests of the project with all their properties and adds an environment variable to each.
GoogleTest selects a file name when a program starts: two processes that share a folder would lose results.

@satisfies SWR-CLI-032      Design: docs/design/launcher.md#tests-of-a-project
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from mamori_tools.host.process import Tick, run_logged
from mamori_trace.base.errors import WorkError

_GTEST = "GTEST_"
_SETTINGS = ("DartConfiguration.tcl", "CTestCustom.cmake", "CTestCustom.ctest")
"""Files of a build folder that change how CTest runs its tests, such as the default time limit."""


@dataclass(frozen=True)
class ProjectTest:
    """One test of `ctest -N`. `number` counts from 1, as in CTest."""

    number: int
    name: str
    command: tuple[str, ...]
    properties: dict[str, object] = field(default_factory=dict)

    @property
    def folder(self) -> Path:
        return Path(str(self.properties.get("WORKING_DIRECTORY", ".")))

    def get_words(self, name: str) -> tuple[str, ...]:
        """A property with a list value."""
        value = self.properties.get(name, ())
        return (value,) if isinstance(value, str) else tuple(value)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Record:
    """CTest's result of one test: `passed`, `failed` or `skipped`, and the reason."""

    verdict: str
    seconds: str
    message: str = ""


def list_tests(build: Path) -> list[ProjectTest]:
    """The tests of `ctest -N`. @raise WorkError if CTest cannot list them."""
    try:
        done = subprocess.run(["ctest", "--test-dir", str(build), "--show-only=json-v1"], env=make_environment(),
                              capture_output=True, check=False, stdin=subprocess.DEVNULL)  # fmt: skip
        tests = json.loads(done.stdout)["tests"] if done.returncode == 0 else None
    except (OSError, ValueError, KeyError) as error:
        raise WorkError(f"{build}: ctest cannot list the tests ({error}); run ctest -N there") from error
    if tests is None:
        said = " ".join(done.stderr.decode(errors="replace").split())
        raise WorkError(f"{build}: ctest cannot list the tests (status {done.returncode}: {said[:200]}); run ctest -N there")
    listed = []
    for number, test in enumerate(tests, start=1):
        properties = {row["name"]: row["value"] for row in test.get("properties", ())}
        listed.append(ProjectTest(number, test["name"], tuple(test.get("command", ())), properties))
    return listed


def make_environment() -> dict[str, str]:
    """The environment of all tests: excludes GoogleTest filters and repetitions from the shell of the caller."""
    return {name: value for name, value in os.environ.items() if not name.startswith(_GTEST)}


def prepare(tests: list[ProjectTest], build: Path, folder: Path) -> None:
    """Creates the second test folder without earlier results. @raise OSError."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in _SETTINGS:
        if (build / name).is_file():
            shutil.copy(build / name, folder)
    lines = [f"subdirs({_quote(str(build))})"]
    count = Counter(test.name for test in tests)
    for test in tests:
        variable = _quote(f"{_GTEST}OUTPUT=set:xml:{get_result_folder(folder, test)}/")
        lock = f" RESOURCE_LOCK {_quote(f'mamori same name {test.name}')}" if count[test.name] > 1 else ""
        lines.append(f"set_tests_properties({_quote(test.name)} PROPERTIES ENVIRONMENT_MODIFICATION {variable}{lock})")
    (folder / "CTestTestfile.cmake").write_text("\n".join(lines) + "\n", encoding="utf-8", errors="surrogateescape")


def get_result_folder(folder: Path, test: ProjectTest) -> Path:
    """Result folder of the process of `test`. Its name is a number, because test names may contain characters that file names cannot.

    Tests with the same name share the folder of the last one, because CTest sets a property by name. They therefore run in sequence.
    """
    return folder / "results" / f"{test.number:04}"


def run_tests(folder: Path, jobs: int, log: Path, root: Path, tick: Tick) -> int:
    """@return the exit status of CTest."""
    argv = ["ctest", "--test-dir", str(folder), "--output-on-failure", "--parallel", str(jobs), "--no-tests=error",
            "--output-junit", str(folder / "ctest.xml")]  # fmt: skip
    return run_logged(argv, log, root, tick, make_environment())


def read_records(folder: Path) -> dict[str, list[Record]]:
    """Record of the run by CTest itself, by test name. @raise WorkError if CTest has not written it."""
    path = folder / "ctest.xml"
    try:
        cases = list(ElementTree.parse(path).iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        raise WorkError(f"{path}: no record of the run by ctest ({error}); see the log") from error
    records: dict[str, list[Record]] = {}
    for case in cases:
        records.setdefault(case.get("name", ""), []).append(_read_record(case))
    return records


def _read_record(case: ElementTree.Element) -> Record:
    """CTest reports a test as skipped also if it could not start it (missing program, file or fixture). That counts as a failure."""
    status, seconds = case.get("status", ""), case.get("time", "0")
    output = " ".join((case.findtext("system-out") or "").split())
    if status == "run":
        return Record("passed", seconds)
    if status == "disabled":
        return Record("skipped", seconds, "disabled")
    skipped = case.find("skipped")
    reason = skipped.get("message", "") if skipped is not None else ""
    if status == "notrun" and reason.startswith("SKIP_"):
        return Record("skipped", seconds, reason)
    failure = case.find("failure")
    reason = reason or (failure.get("message", "") if failure is not None else "")
    return Record("failed", seconds, f"ctest: {reason or 'crash, time limit or wrong exit status'}; {output[-400:]}".rstrip("; "))


def _quote(text: str) -> str:
    """A bracket argument of CMake, in which no character has a special meaning."""
    level = 0
    while f"]{'=' * level}]" in text or text.endswith("]" + "=" * level):
        level += 1
    return f"[{'=' * level}[{text}]{'=' * level}]"
