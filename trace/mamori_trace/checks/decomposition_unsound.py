# SPDX-License-Identifier: Apache-2.0
"""Decomposition records with an invalid argument."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.decomposition import Decomposition
from mamori_trace.model.project import Project

RULE = Rule("decomposition-unsound", ERROR, "The items that a decomposition record names carry the SIL of the parent.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for record in project.decomposition:
        for carrier in record.carried_by:
            fault = _find_fault(project, record, carrier)
            if fault:
                yield record.place, f"{record.child} leaves the SIL of {record.parent} to {carrier}, which {fault}", record.child


def _find_fault(project: Project, record: Decomposition, carrier: str) -> str:
    item, parent = project.items.get(carrier), project.items.get(record.parent)
    if item is None or parent is None:
        near = ", ".join(project.suggest(carrier))
        return "is defined nowhere" + (f"; nearest: {near}" if near else "") if item is None else ""
    if carrier == record.child:
        return "is the child itself"
    if not item.approved:
        return f"is {item.status or 'malformed'}"
    if parent.id not in item.parents:
        return f"does not refine {parent.id}"
    rank = {sil: index for index, sil in enumerate(project.schema.sil)}
    lower = item.sil and parent.sil and rank[item.sil] < rank[parent.sil]
    return f"has SIL {item.sil}, lower than SIL {parent.sil}" if lower else ""
