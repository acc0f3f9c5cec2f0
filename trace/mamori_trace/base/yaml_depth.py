# SPDX-License-Identifier: Apache-2.0
"""Rejects deeply nested YAML. The parser calls itself for each level and would otherwise end the process.

@satisfies SWR-TRC-009, SWR-TRC-048      Design: docs/design/trace_formats.md#bad-input
"""

from __future__ import annotations

from typing import Any

DEPTH_MAX = 200
"""Lists and tables within each other. No writer of items or of findings comes near."""


def demand_shallow(text: str, loader: Any) -> None:
    """Raises ValueError for deeper nesting, and yaml.YAMLError for invalid YAML. Events are read singly, so depth needs no memory."""
    import yaml  # slow to load, and few projects have such a file

    depth = 0
    for event in yaml.parse(text, Loader=loader):
        if isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            depth += 1
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            depth -= 1
        if depth > DEPTH_MAX:
            raise ValueError(f"nests more than {DEPTH_MAX} lists and tables, which no tool writes")
