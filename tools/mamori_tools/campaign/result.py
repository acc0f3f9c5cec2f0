# SPDX-License-Identifier: Apache-2.0
"""Verdicts as evidence: campaign.json and JUnit (docs/design/trace.md#evidence-files), each written atomically."""

from __future__ import annotations

import json
import shlex
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from mamori_tools.campaign.case import Case, Check, Evaluation, Verdict
from mamori_trace.base.text_file import write_text

SCHEMA = "mamori.campaign/1"
TECHNIQUE = "fault_injection"
VERDICT_WORDS: Mapping[Verdict, str] = {"passed": "pass", "failed": "fail", "inconclusive": "inconclusive"}


@dataclass(frozen=True)
class CaseResult:
    """An evaluated case. `command` ran it in `wall_s` [s]; `description` is the statement of the subject about it; `reproduction` states
    how to repeat it."""

    case: Case
    evaluation: Evaluation
    command: tuple[str, ...]
    wall_s: float
    description: Mapping[str, Any]
    reproduction: str

    @property
    def run(self) -> Mapping[str, Any]:
        return self.evaluation.run

    @property
    def checks(self) -> tuple[Check, ...]:
        return self.evaluation.checks

    @property
    def verdict(self) -> Verdict:
        return self.evaluation.verdict

    @property
    def passed(self) -> bool:
        return self.verdict == "passed"

    @property
    def failure(self) -> str:
        """The failed checks in words; empty if the case passed."""
        return "; ".join(f"{check.name}: wanted {check.wanted}, was {check.measured}"
                         for check in self.checks if not check.passed)  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        case = self.case
        return {
            "id": case.id,
            "scenario": case.scenario,
            "title": case.title,
            "requirements": list(case.requirements),
            "requirement_polarity": dict(case.requirements),
            **self.description,
            "run": dict(self.run),
            "folder": case.id,
            "command": shlex.join(self.command),
            "checks": [asdict(check) for check in self.checks],
            "verdict": VERDICT_WORDS[self.verdict],
        }  # fmt: skip


@dataclass(frozen=True)
class CampaignResult:
    """All evaluated cases, in the order of the plan. `result_hash` covers everything that does not depend on host and time of the runs.

    `kept`: number of cases from an earlier call. `notes`: unused parts of the inputs, in words.
    """

    cases: tuple[CaseResult, ...]
    environment: Mapping[str, Any]
    result_hash: str
    kept: int
    notes: tuple[str, ...]

    @property
    def failed_cases(self) -> tuple[CaseResult, ...]:
        return tuple(each for each in self.cases if each.verdict == "failed")

    @property
    def passed(self) -> bool:
        """True if there is a case and none failed."""
        return bool(self.cases) and not self.failed_cases

    def count(self, verdict: Verdict) -> int:
        return sum(each.verdict == verdict for each in self.cases)

    def write(self, evidence: Path) -> None:
        """Writes `campaign/campaign.json` and `junit/campaign.xml` below `evidence`. Raises InputError."""
        content = {"schema": SCHEMA, "environment": dict(self.environment), "cases": [each.to_json() for each in self.cases]}
        write_text(evidence / "campaign" / "campaign.json", json.dumps(content, indent=1, allow_nan=False) + "\n")
        write_text(evidence / "junit" / "campaign.xml", self.to_junit())

    def to_junit(self) -> str:
        """Each case, once per requirement that it verifies."""
        suite = ElementTree.Element("testsuite", name="campaign")
        for each in self.cases:
            for requirement, polarity in each.case.requirements.items():
                suite.append(_make_testcase(each, requirement, polarity))
        suite.set("tests", str(len(suite)))
        suite.set("failures", str(len(suite.findall("testcase/failure"))))
        suite.set("errors", "0")
        suite.set("skipped", str(len(suite.findall("testcase/skipped"))))
        suite.set("time", f"{sum(each.wall_s for each in self.cases):.3f}")
        suites = ElementTree.Element("testsuites")
        suites.append(suite)
        ElementTree.indent(suites)
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(suites, encoding="unicode") + "\n"


def _make_testcase(result: CaseResult, requirement: str, polarity: str) -> ElementTree.Element:
    case = result.case
    element = ElementTree.Element("testcase", classname=case.scenario, name=f"{case.id}[{requirement}]",
                                  time=f"{result.wall_s:.3f}")  # fmt: skip
    properties = ElementTree.SubElement(element, "properties")
    for name, value in (("requirement", requirement), ("technique", TECHNIQUE), ("polarity", polarity)):
        ElementTree.SubElement(properties, "property", name=name, value=value)
    if result.verdict == "inconclusive":
        ElementTree.SubElement(element, "skipped")
        ElementTree.SubElement(properties, "property", name="verdict", value="inconclusive")
    elif not result.passed:
        failure = ElementTree.SubElement(element, "failure", message=_clean(result.failure))
        failure.text = _clean(f"{result.failure}; {result.reproduction}")
    return element


def _clean(text: str) -> str:
    """Removes control characters, which XML forbids; the last output of a program may contain some."""
    return "".join(letter if letter.isprintable() else " " for letter in text)
