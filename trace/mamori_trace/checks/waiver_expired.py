# SPDX-License-Identifier: Apache-2.0
"""Waivers after their expiry date."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("waiver-expired", ERROR, "A waiver with a last day is not past it.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for waiver in project.waivers:
        if not waiver.is_expired(project.date):
            continue
        what = f"the waiver of {waiver.rule} held until {waiver.expires}"
        if project.date:
            yield waiver.place, f"{what}, and this is the state of {project.date}; mend what it is about, or decide anew", waiver.item
        else:
            yield waiver.place, f"{what}, and neither commit nor evidence tells the day of this state; add --date", waiver.item
