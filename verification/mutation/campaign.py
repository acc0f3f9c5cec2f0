# SPDX-License-Identifier: Apache-2.0
"""A fault campaign as a test of mutants: a mutant is killed by a case that its evaluator does not pass.

Each case is one test.

@satisfies SWR-VER-034      Design: docs/design/test_strength.md#example-arm
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

from mamori_tools.campaign.case import select
from mamori_tools.campaign.subject import load_plan, load_subject
from mamori_tools.host.project import ROOT, Project

Run = Callable[[Sequence[str]], tuple[int, str]]
"""Runs a command; returns status and output."""


class Campaign:
    """The cases of a plan, as `mamori campaign` runs and evaluates them."""

    def __init__(self, plan_file: Path, folder: Path) -> None:
        """@param folder for the input files of the runs."""
        plan = load_plan(plan_file)
        self._subject = load_subject(plan.subject)
        self._folder = folder
        expansion = self._subject.expand(select(plan, (), None), self._subject.get_files(Project(ROOT)))
        folder.mkdir(parents=True)
        for name, content in expansion.inputs.items():
            (folder / name).write_bytes(content)
        self._cases = {case.id: case for case in expansion.cases}

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self._cases)

    def run(self, name: str, program: Path, folder: Path, run: Run) -> tuple[int, str]:
        """Runs a case in the folder, which is emptied. @return status 1 and the failed checks, or status 0."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        case = self._cases[name]
        status, words = run(self._subject.command(case, program, self._folder, folder))
        problem = "" if status == 0 else f"exit status {status}: {words.strip()[-200:]}"
        evaluation = self._subject.evaluate(case, folder, problem)
        failed = ", ".join(check.name for check in evaluation.checks if not check.passed)
        return (0, "") if evaluation.verdict == "passed" else (1, failed)
