# SPDX-License-Identifier: Apache-2.0
"""Rejects deeply nested YAML, because the parser calls itself for each level and would otherwise crash the process.

@satisfies SWR-TRC-009, SWR-TRC-048      Design: docs/design/trace_formats.md#bad-input
"""

from __future__ import annotations

from typing import Any

DEPTH_MAX = 200
"""Maximum nesting of lists and tables, far above that of items and findings."""


def demand_shallow(text: str, loader: Any) -> None:
    """Raises ValueError for deeper nesting, and yaml.YAMLError for invalid YAML. Events are read one by one, so nesting needs no memory."""
    import yaml  # slow to load, and few projects have such a file

    depth = 0
    for event in yaml.parse(text, Loader=loader):
        if isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            depth += 1
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            depth -= 1
        if depth > DEPTH_MAX:
            raise ValueError(f"nests more than {DEPTH_MAX} lists and tables, which no tool writes")
