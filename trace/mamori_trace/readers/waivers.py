# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/waivers.toml.

@satisfies SWR-TRC-021      Design: docs/design/trace.md#waivers
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Problem
from mamori_trace.model.waiver import Waiver
from mamori_trace.readers.toml_rows import Columns, is_date, read_rows, suggest

WAIVERS_PATH = "requirements/waivers.toml"
_COLUMNS = Columns(texts=("rule", "item", "file", "reason", "expires", "by"), needed=("rule", "by"))
_NEVER = "waiver-"


def read_waivers(root: Path, rules: Iterable[str], problems: list[Problem]) -> list[Waiver]:
    """Waivers in file order. An invalid waiver is a problem and has no effect."""
    known = [rule for rule in rules if rule != UNREADABLE and not rule.startswith(_NEVER)]
    waivers: list[Waiver] = []
    for row, place in read_rows(root / WAIVERS_PATH, "mamori.waivers/1", "waiver", _COLUMNS, root, problems):
        waiver = Waiver(place=place, **row)
        fault = _find_fault(waiver, known)
        if fault:
            problems.append(Problem(UNREADABLE, place, fault))
        else:
            waivers.append(waiver)
    return waivers


def _find_fault(waiver: Waiver, known: list[str]) -> str:
    if waiver.rule not in known:
        return f"rule '{waiver.rule}' is none that can be waived{suggest(waiver.rule, known)}"
    if not waiver.item and not waiver.file:
        return "names neither item nor file; a waiver for everything would be a rule that is off"
    if waiver.expires and not is_date(waiver.expires):
        return f"expires: '{waiver.expires}' is no day of the form 2026-11-30"
    return ""
