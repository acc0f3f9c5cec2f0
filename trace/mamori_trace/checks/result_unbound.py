# SPDX-License-Identifier: Apache-2.0
"""Result files without an evidence record.

@satisfies SWR-TRC-102      Design: docs/design/trace.md#unbound-results
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.evidence import UNBOUND
from mamori_trace.model.project import Project

_RECORDS = "records.json"

RULE = Rule("result-unbound", ERROR, "An evidence record tells what produced each result.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    """One finding for each file that no other rule reports."""
    told = {problem.place.file for problem in project.problems}
    if project.allow_missing or any(file.endswith(_RECORDS) for file in told):
        return
    files = Counter(result.place.file for result in project.results if result.status == UNBOUND)
    files += Counter(case.place.file for case in project.evidence.cases if case.status == UNBOUND)
    for file, count in sorted(files.items()):
        if file in told:
            continue
        what = f"{count} result{'s have' if count > 1 else ' has'} no evidence record"
        yield Place(file, 1), f"{what}; run the tests by `mamori trace record --results {file} -- COMMAND`", ""
