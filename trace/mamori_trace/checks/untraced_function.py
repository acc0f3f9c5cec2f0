# SPDX-License-Identifier: Apache-2.0
"""Functions without a requirement.

@satisfies SWR-TRC-031      Design: docs/design/trace.md#traced-layers
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("untraced-function", ERROR, "A requirement owns every function of the layers that requirements/schema/code.toml names.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for function in project.traced_functions:
        if not function.requirements:
            yield function.place, f"no requirement owns {function.name}: tag it, its class or its file with @satisfies", ""
