# SPDX-License-Identifier: Apache-2.0
"""Waivers without a reason."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("waiver-without-reason", ERROR, "A waiver says why its finding is accepted.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for waiver in project.waivers:
        if not waiver.reason:
            yield waiver.place, f"the waiver of {waiver.rule} gives no reason, so it waives nothing", waiver.item
