# SPDX-License-Identifier: Apache-2.0
"""Techniques that a project uses, with the phase of the V and the evidence of each.

@satisfies SWR-TRC-027      Design: docs/design/trace.md#techniques
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place

PHASES = ("planning", "requirements", "architecture", "design", "code", "unit test", "integration test", "system test", "validation",
          "modification")  # fmt: skip
"""Phases of the V from start to end, in the words of this tool."""


@dataclass(frozen=True, slots=True)
class Technique:
    """One row of requirements/schema/techniques.toml.

    `clause` names the clause of a standard. The evidence is `items` that require the technique, executed `tests` (words of the schema) and
    `documents` (file, or file#heading).
    """

    name: str
    clause: str
    phase: str
    items: tuple[str, ...]
    tests: tuple[str, ...]
    documents: tuple[str, ...]
    place: Place
