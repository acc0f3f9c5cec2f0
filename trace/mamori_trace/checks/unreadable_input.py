# SPDX-License-Identifier: Apache-2.0
"""Inputs that could not be read."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("unreadable-input", ERROR, "Every input file is whole and readable.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for problem in project.problems:
        if problem.rule == RULE.id:
            yield problem.place, problem.message, problem.item
