# SPDX-License-Identifier: Apache-2.0
"""Findings as SARIF 2.1.0 (OASIS), which code forges and editors show next to the lines.

@satisfies SWR-TRC-026      Design: docs/design/trace.md#sarif
"""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from importlib import metadata
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import quote

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Finding, Place
from mamori_trace.checks import describe_rules, list_rules
from mamori_trace.model.project import Project
from mamori_trace.model.waiver import Waiver

VERSION = "2.1.0"
FINGERPRINT = "mamoriFinding/v1"
_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_BASE = "SRCROOT"
_LINE_NUMBERS = re.compile(r"(?<=:)\d+\b|(?<=\bline )\d+\b")


def format_sarif(project: Project, findings: list[Finding]) -> str:
    """One run: the rules, the counted findings, and the waived findings as suppressed results."""
    rules = list_rules()
    places = {rule.id: index for index, rule in enumerate(rules)}
    waivers: dict[Finding, Waiver] = {each.finding: each.waiver for each in project.waived}
    ordered = sorted([*findings, *waivers], key=Finding.sort_key)
    prints = _calc_fingerprints(ordered)
    results = [
        _make_result(finding, places[finding.rule], fingerprint, waivers.get(finding))
        for finding, fingerprint in zip(ordered, prints, strict=True)
    ]
    about = describe_rules()
    run = {
        "tool": {
            "driver": {
                "name": "mamori trace",
                "version": _read_version(),
                "rules": [
                    {
                        "id": rule.id,
                        "shortDescription": {"text": about[rule.id]},
                        "fullDescription": {"text": rule.about},
                        "help": {"text": f"{about[rule.id]} {rule.about} See docs/design/trace.md."},
                        "defaultConfiguration": {"level": _make_level(rule.severity), "enabled": rule.severity != "off"},
                    }
                    for rule in rules
                ],
            }
        },
        "automationDetails": {"id": "mamori/trace/check/"},
        "originalUriBaseIds": {_BASE: {"description": {"text": "The folder of the project."}}},
        "invocations": [{"executionSuccessful": not any(finding.rule == UNREADABLE for finding in findings)}],
        "columnKind": "unicodeCodePoints",
        "properties": {"commit": project.head},
        "results": results,
    }
    content = {"$schema": _SCHEMA, "version": VERSION, "runs": [run]}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _make_result(finding: Finding, rule_index: int, fingerprint: str, waiver: Waiver | None) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": rule_index,
        "level": _make_level(finding.severity),
        "message": {"text": finding.message},
        "locations": [_make_location(finding.place)],
        "partialFingerprints": {FINGERPRINT: fingerprint},
    }
    if finding.item:
        result["properties"] = {"item": finding.item}
    if waiver is not None:
        until = f", until {waiver.expires}" if waiver.expires else ""
        suppression = {"kind": "external", "status": "accepted", "justification": f"{waiver.reason} ({waiver.by}{until})"}
        result["suppressions"] = [{**suppression, "location": _make_location(waiver.place)}]
    return result


def _make_location(place: Place) -> dict[str, Any]:
    """Relative to the project folder, so that the file is valid on every host; files outside keep their complete path."""
    path = PurePosixPath(place.file)
    artifact = {"uri": path.as_uri()} if path.is_absolute() else {"uri": quote(place.file), "uriBaseId": _BASE}
    return {"physicalLocation": {"artifactLocation": artifact, "region": {"startLine": max(place.line, 1)}}}


def _make_level(severity: str) -> str:
    """Level in SARIF: a rule that is off by default is `none`."""
    return "none" if severity == "off" else severity


def _calc_fingerprints(findings: list[Finding]) -> list[str]:
    """Identifies a finding after lines moved: rule, file, item and message without line numbers; equal ones are numbered."""
    seen: Counter[str] = Counter()
    prints = []
    for finding in findings:
        text = "\n".join((finding.rule, finding.place.file, finding.item, _LINE_NUMBERS.sub("", finding.message)))
        seen[text] += 1
        prints.append(hashlib.sha256(f"{text}\n{seen[text]}".encode()).hexdigest()[:32])
    return prints


def _read_version() -> str:
    """Version of the tool; empty for a source tree that is not installed."""
    try:
        return metadata.version("mamori")
    except metadata.PackageNotFoundError:
        return "0"
