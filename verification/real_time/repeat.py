# SPDX-License-Identifier: Apache-2.0
"""Repeats the inconclusive test programs of a preset, at most twice; a program with a failed test never.

@satisfies SWR-VER-023      Design: docs/design/test_strength.md#real-time-verdicts
"""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Sequence
from pathlib import Path

from mamori_tools.host.project import ROOT, Project

REPEATS_MAX = 2


def read_verdict(path: Path) -> str:
    """Verdict of one test program from its JUnit file: passed, failed or inconclusive. @return failed also for an incomplete
    file."""
    try:
        cases = list(ElementTree.parse(path).iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return "failed"
    if any(case.find("failure") is not None or case.find("error") is not None for case in cases):
        return "failed"
    return "inconclusive" if list_figures(path) else "passed"


def list_figures(path: Path) -> list[str]:
    """One line per inconclusive test: its name and the figures of the host."""
    figures = []
    for case in ElementTree.parse(path).iter("testcase"):
        properties = {item.get("name"): item.get("value", "") for item in case.iter("property")}
        if case.find("skipped") is not None and properties.get("verdict") == "inconclusive":
            figures.append(f"{case.get('classname', '')}.{case.get('name', '')}: {properties.get('figure', '')}")
    return figures


def repeat_inconclusive(path: Path, run: Callable[[], object]) -> tuple[str, int]:
    """Calls `run`, which rewrites `path`, while the result is inconclusive, at most twice.
    @return the last verdict and the number of repetitions."""
    for repeats in range(REPEATS_MAX):
        verdict = read_verdict(path)
        if verdict != "inconclusive":
            return verdict, repeats
        run()
    return read_verdict(path), REPEATS_MAX


def repeat_preset(preset: str, junit: Path, names: Sequence[str] = ()) -> bool:
    """All test programs of `preset` with a result file. @return false if one failed meanwhile."""
    is_well = True
    for path in sorted(junit.glob("*.xml")):
        if (names and path.stem not in names) or read_verdict(path) != "inconclusive":
            continue
        command = ("ctest", "--preset", preset, "--no-tests=error", "--tests-regex", f"^{path.stem}$")

        def run(command: Sequence[str] = command) -> None:
            subprocess.run(command, cwd=ROOT, check=False)

        for figure in list_figures(path):
            print(f"inconclusive: {figure}", flush=True)
        verdict, repeats = repeat_inconclusive(path, run)
        print(f"{path.stem}: {verdict} after {repeats} repetitions", flush=True)
        is_well = is_well and verdict != "failed"
    return is_well


def main(arguments: Sequence[str]) -> int:
    """`repeat PRESET [TEST ...]`."""
    preset = arguments[0]
    return 0 if repeat_preset(preset, Project(ROOT, preset).junit, arguments[1:]) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
