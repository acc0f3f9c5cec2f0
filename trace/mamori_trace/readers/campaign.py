# SPDX-License-Identifier: Apache-2.0
"""Reads campaign.json and environment.json (docs/design/trace.md#evidence-files).

@satisfies SWR-TRC-005      Design: docs/design/trace.md#evidence-files
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from mamori_trace.base.files import UNREADABLE, get_shown_path
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.json_file import read_json
from mamori_trace.model.evidence import CampaignCase, Evidence

_CASE_ID = re.compile(r'"id"\s*:\s*("(?:\\.|[^"\\])*")')


def read_environment(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Fills in the environment; a missing file leaves it empty, which a rule reports."""
    path = folder / "environment.json"
    evidence.environment_place = Place(get_shown_path(path, root), 1)
    if path.exists():
        table = read_json(path, "mamori.environment/1", root, problems)
        evidence.environment = table[0] if table else {}


def read_campaign(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the campaign cases; a missing file means that no campaign was run."""
    path = folder / "campaign" / "campaign.json"
    evidence.campaign_place = Place(get_shown_path(path, root), 1)
    if not path.exists():
        return
    table = read_json(path, "mamori.campaign/1", root, problems)
    if table is None:
        return
    content, text = table
    evidence.has_campaign = True
    environment = content.get("environment")
    evidence.campaign_environment = environment if isinstance(environment, dict) else {}
    lines = _find_id_lines(text)
    rows = content.get("cases")
    for index, row in enumerate(rows if isinstance(rows, list) else []):
        try:
            evidence.cases.append(make_case(row, evidence.campaign_place.file, lines))
        except (KeyError, TypeError, ValueError) as error:
            message = f"case {index}: {type(error).__name__} {error}; run the campaign again"
            problems.append(Problem(UNREADABLE, evidence.campaign_place, message))
    if not isinstance(rows, list):
        problems.append(Problem(UNREADABLE, evidence.campaign_place, "holds no list 'cases'; run the campaign again"))


def _find_id_lines(text: str) -> dict[str, int]:
    """Line of each `"id": "..."`; the first occurrence of each value."""
    lines: dict[str, int] = {}
    line, counted = 1, 0
    for match in _CASE_ID.finditer(text):
        line += text.count("\n", counted, match.start())
        counted = match.start()
        lines.setdefault(json.loads(match[1], strict=False), line)
    return lines


def make_case(row: dict[str, Any], shown: str = "campaign/campaign.json", lines: Mapping[str, int] = MappingProxyType({})) -> CampaignCase:
    """One row of campaign.json. `shown` names its file, `lines` the line of each id.

    Raises KeyError, TypeError or ValueError if the row violates the format."""
    case_id = row["id"]
    run = row["run"]
    checks = row["checks"]
    if not isinstance(case_id, str) or not isinstance(run, dict) or not isinstance(checks, list):
        raise TypeError("'id', 'run' or 'checks' has the wrong kind of value")
    if row["verdict"] not in ("pass", "fail", "inconclusive"):
        raise ValueError(f"verdict {row['verdict']!r} is not 'pass', 'fail' or 'inconclusive'")
    if row["verdict"] == "pass" and not checks:
        raise ValueError("verdict 'pass' without a single check")
    return CampaignCase(
        id=case_id,
        scenario=str(row["scenario"]),
        title=str(row["title"]),
        requirements=tuple(str(each) for each in row["requirements"]),
        polarity=str(row["polarity"]),
        verdict=row["verdict"],
        checks=[dict(check) for check in checks],
        expected=dict(row["expected"]),
        run=run,
        folder=str(row["folder"]),
        place=Place(shown, lines.get(case_id, 1)),
        requirement_polarity={str(key): str(value) for key, value in dict(row.get("requirement_polarity") or {}).items()},
    )
