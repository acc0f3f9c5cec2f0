# SPDX-License-Identifier: Apache-2.0
"""Waivers that cover no finding."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("waiver-unused", ERROR, "A waiver that holds is about a finding that there is.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    used = {each.waiver for each in project.waived}
    for waiver in project.waivers:
        if waiver in used or not waiver.reason or waiver.is_expired(project.date):
            continue
        subject = " in ".join(filter(None, (waiver.item, waiver.file)))
        yield waiver.place, f"no finding of {waiver.rule} about {subject}; remove the waiver", waiver.item
