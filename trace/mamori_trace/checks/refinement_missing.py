# SPDX-License-Identifier: Apache-2.0
"""Items that no item of the level that has to refine them refines.

@satisfies SWR-TRC-113      Design: docs/design/trace.md#kinds-and-links
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project
from mamori_trace.model.query import list_descendants

RULE = Rule("refinement-missing", OFF, "Each approved item has a descendant of the level that `refined_by` names.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    levels = project.schema.levels
    for item in project.live_items:
        wanted = levels[item.level].refined_by
        if wanted and item.approved and all(project.items[name].level != wanted for name in list_descendants(project, item)):
            yield item.place, f"{item.id} is refined by no {wanted} item ({levels[wanted].name})", item.id
