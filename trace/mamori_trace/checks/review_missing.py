# SPDX-License-Identifier: Apache-2.0
"""Items that require a review or analysis without a record of one."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("review-missing", OFF, "Each review and analysis that an approved item demands is recorded for the item as it stands.")

METHODS = ("review", "analysis")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    last = {(record.item, record.method): record for record in project.reviews}
    for item in project.live_items:
        if not item.approved or not item.sil or project.schema.levels[item.level].from_children:
            continue
        for method in METHODS:
            if method not in item.verify:
                continue
            record = last.get((item.id, method))
            now = item.calc_fingerprint()
            if record is None:
                message = f"{item.id} demands {method} and none is recorded in requirements/reviews.toml (fingerprint {now})"
                yield item.find_place("Verify"), message, item.id
            elif record.fingerprint != now:
                message = f"{item.id} changed since its {method} on {record.date} ({record.place}); look again (fingerprint {now})"
                yield item.find_place("Verify"), message, item.id
