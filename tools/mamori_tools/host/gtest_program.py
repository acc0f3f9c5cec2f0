# SPDX-License-Identifier: Apache-2.0
"""Queries a GoogleTest program for its cases, to detect result files with missing cases.

@satisfies SWR-CLI-032      Design: docs/design/launcher.md#tests-of-a-project
"""

from __future__ import annotations

import os
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Mapping
from pathlib import Path

Case = tuple[str, str]
"""Suite and name."""

LIST_S = 60.0
_MARKS = (b"--gtest_list_tests", b"@G--gtest_", b"libgtest.so", b"libgmock.so")
_OUTPUT = "--gtest_output"


def is_gtest_program(path: str) -> bool:
    """Whether GoogleTest is linked into the file or used as a shared library."""
    try:
        data = Path(path).read_bytes()
    except OSError:
        return False
    return data.startswith(b"\x7fELF") and any(mark in data for mark in _MARKS)


def list_cases(command: tuple[str, ...], folder: Path, environment: Mapping[str, str]) -> list[Case] | None:
    """The cases that `command` selects; None if the program does not list them in GoogleTest's format."""
    with tempfile.TemporaryDirectory(prefix="mamori-list-") as place:
        path = Path(place) / "cases.xml"
        argv = [*command, "--gtest_list_tests", f"{_OUTPUT}=xml:{path}"]
        try:
            subprocess.run(argv, cwd=folder, env=dict(environment), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, check=False, timeout=LIST_S)  # fmt: skip
        except (OSError, subprocess.TimeoutExpired):
            return None
        return read_cases(path)


def read_cases(path: Path) -> list[Case] | None:
    """The cases of a result file or a list; None if the file is missing or malformed."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError):
        return None
    return [(suite.get("name", ""), case.get("name", "")) for suite in root.iter("testsuite") for case in suite.iter("testcase")]


def find_own_output(command: tuple[str, ...], folder: Path) -> Path | None:
    """The XML file in the command line, which the environment cannot change; None without such a file.

    Returns a folder, which is not readable as a file, if the output is not XML or not a single file.
    """
    own = None
    for word in command[1:]:
        name, mark, value = word.partition("=")
        if name in (_OUTPUT, _OUTPUT[1:]) and mark:
            kind, _, path = value.partition(":")
            own = folder / (path or "test_detail.xml") if kind == "xml" else folder
    return own


def modify(environment: Mapping[str, str], settings: Iterable[str], changes: Iterable[str]) -> dict[str, str]:
    """The environment of a test: `settings` are its property ENVIRONMENT, `changes` its ENVIRONMENT_MODIFICATION."""
    result = dict(environment)
    result.update(text.split("=", 1) for text in settings if "=" in text)  # type: ignore[misc]
    for text in changes:
        name, _, rest = text.partition("=")
        kind, _, value = rest.partition(":")
        before = result.get(name, "")
        if kind == "set":
            result[name] = value
        elif kind == "unset":
            result.pop(name, None)
        elif kind == "reset":
            result.pop(name, None)
            if name in environment:
                result[name] = environment[name]
        else:
            separator = {"string": "", "path_list": os.pathsep, "cmake_list": ";"}.get(kind.rpartition("_")[0])
            if separator is not None:
                parts = (value, before) if kind.endswith("_prepend") else (before, value)
                result[name] = separator.join(part for part in parts if part)
    return result
