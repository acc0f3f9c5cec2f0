# SPDX-License-Identifier: Apache-2.0
"""Converts the memory of small systems to a table of the page: bytes per feature.

@satisfies SWR-VER-031      Design: docs/design/proofs.md#size
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mamori_trace.model.evidence import SizeRun
from mamori_trace.model.project import Project
from mamori_trace.reports.timing_view import Cell, Column, Table, make_table


@dataclass(slots=True)
class SizeView:
    """The images of one record."""

    run: SizeRun
    findings: list[str]
    table: Table


def make_size_views(project: Project) -> list[SizeView]:
    """At most one view, because there is one record."""
    return [SizeView(run, [f"{image['name']}: {finding}" for image in run.record["images"] for finding in image["findings"]],
                     _make_images(run.record)) for run in project.evidence.size_runs]  # fmt: skip


def _make_images(record: dict[str, Any]) -> Table:
    columns = (
        Column("system", is_number=False), Column("with", is_number=False), Column("bytes", "text"), Column("more", "text"),
        Column("kernel and safety", "text"), Column("limit", "text"), Column("bytes", "RAM without stacks"),
        Column("more", "RAM without stacks"), Column("limit", "RAM without stacks"), Column("aim", is_number=False),
    )  # fmt: skip
    base = next(image for image in record["images"] if image["name"] == record["base"])

    def make(image: dict[str, Any]) -> list[Cell]:
        parts = image["parts"]
        return [
            Cell(image["name"], is_name=True), Cell(image["title"], is_long=True),
            Cell(str(image["text"]), is_bad=image["text"] > image["text_max"]), Cell(f"{image['text'] - base['text']:+}"),
            Cell(str(parts.get("kernel", 0) + parts.get("safety", 0))), Cell(str(image["text_max"])),
            Cell(str(image["ram"]), is_bad=image["ram"] > image["ram_max"]), Cell(f"{image['ram'] - base['ram']:+}"),
            Cell(str(image["ram_max"])), Cell(_describe_aim(image), is_bad=image["missed"]),
        ]  # fmt: skip

    return make_table("Bytes per feature", columns, record["images"], make, shown=len(record["images"]), where="size.txt")


def _describe_aim(image: dict[str, Any]) -> str:
    aims = (("text", image["text"], image["text_aim"]), ("RAM", image["ram"], image["ram_aim"]))
    return ", ".join(f"{what} {aim} {'missed' if value > aim else 'met'}" for what, value, aim in aims if aim is not None)
