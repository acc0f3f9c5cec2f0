# SPDX-License-Identifier: Apache-2.0
"""The real-time campaigns for the campaign engine (`mamori campaign PLAN`): each case is one run of a program with its own seed.

@satisfies SWR-CMP-008      Design: docs/design/test_strength.md#courses
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.campaign.case import Case, Check, Evaluation, Plan, Scenario, Selection
from mamori_tools.campaign.plan_parts import read_name, read_requirements, read_scenario_name, read_scenarios, read_seed
from mamori_tools.campaign.subject import Expansion
from mamori_tools.host.project import Project
from mamori_trace.base.errors import WorkError
from mamori_trace.base.marked_yaml import Node
from verification.faults.evaluation.evaluator import Result
from verification.faults.run import CAMPAIGNS, Campaign, evaluate_file

COURSE = "course.json"
RUNS_MAX = 10_000

_TOP_KEYS = frozenset({"schema", "subject", "seed", "scenarios"})
_SCENARIO_KEYS = frozenset({"name", "title", "requirements", "size", "storm", "defect", "runs"})


@dataclass(frozen=True)
class RunScenario(Scenario):
    """One row of a plan: `runs` runs with the arguments `size` of the program."""

    size: tuple[int, ...]
    has_storm: bool
    defect: str
    runs: int

    @property
    def case_count(self) -> int:
        return self.runs


@dataclass(frozen=True)
class RunCase(Case):
    """One run."""

    arguments: tuple[str, ...]
    defect: str


@dataclass(frozen=True)
class RealTimeSubject:
    """See mamori_tools.campaign.subject.Subject."""

    campaign: Campaign
    kinds: Collection[str] = ()  # the seed, not the plan, selects the kinds of faults
    jobs_max: int | None = 1

    @property
    def name(self) -> str:
        return self.campaign.name

    def get_program(self, project: Project) -> Path:
        return self.campaign.get_program(project.build)

    def get_files(self, project: Project) -> Mapping[str, Path]:
        return {}

    def read_plan(self, root: Node, path: Path) -> Plan:
        root.as_mapping(_TOP_KEYS)
        return Plan(path, self.name, read_seed(root.get("seed")), read_scenarios(root, self._read_scenario))

    def expand(self, selection: Selection, files: Mapping[str, Path]) -> Expansion:
        return Expansion(tuple(self._make_cases(selection)))

    def command(self, case: Case, program: Path, inputs: Path, folder: Path) -> tuple[str, ...]:
        assert isinstance(case, RunCase)
        defect = ("--defect", case.defect) if case.defect else ()
        return (str(program), *case.arguments, *defect, "--out", str(folder / COURSE))

    def evaluate(self, case: Case, folder: Path, problem: str) -> Evaluation:
        try:
            if problem:
                raise WorkError(problem)
            result = evaluate_file(folder / COURSE)
        except WorkError as error:
            return Evaluation({}, (Check("run", "a complete course", str(error), False),), "failed")
        return make_evaluation(result)

    def describe(self, case: Case) -> dict[str, Any]:
        assert isinstance(case, RunCase)
        return {"polarity": "violation", "expected": {"verdict": "failed" if case.defect else "passed"}}

    def _read_scenario(self, node: Node) -> RunScenario:
        entries = node.as_mapping(_SCENARIO_KEYS)
        has_storm = entries["storm"].as_bool() if "storm" in entries else False
        if has_storm and not self.campaign.has_storm:
            raise entries["storm"].error(f"the subject {self.name} has no page-fault storm; remove it")
        return RunScenario(
            read_scenario_name(node), node.get("title").as_text(), read_requirements(node.get("requirements")), node,
            size=self._read_size(node.get("size")),
            has_storm=has_storm,
            defect=read_name(entries["defect"], self.campaign.defects) if "defect" in entries else "",
            runs=_read_count(entries["runs"]) if "runs" in entries else 1,
        )  # fmt: skip

    def _read_size(self, node: Node) -> tuple[int, ...]:
        size = tuple(_read_count(item, 2**63) for item in node.as_list())
        if len(size) != len(self.campaign.sizes):
            raise node.error(f"{len(size)} numbers; write {', '.join(self.campaign.sizes)}")
        return size

    def _make_cases(self, selection: Selection) -> Sequence[RunCase]:
        cases = []
        for scenario in selection.scenarios:
            assert isinstance(scenario, RunScenario)
            for number in range(min(scenario.runs, selection.instants or scenario.runs)):
                seed = (selection.plan.seed + number) % 2**64
                arguments = self.campaign.make_arguments(scenario.size, seed, scenario.has_storm)
                cases.append(RunCase(f"{scenario.name}-{number + 1}", scenario.name, scenario.title, seed, scenario.requirements, arguments,
                                     scenario.defect))  # fmt: skip
        return cases


def make_evaluation(result: Result) -> Evaluation:
    """A check for the run, and one for each part that a requirement depends on."""
    if not result.has_priority:
        check = Check("privileges", "fixed priorities", "any thread of the host delays the windows", False)
        return Evaluation(result.to_json(), (check,), "inconclusive")
    findings = {"run": result.finding, **result.parts}
    checks = tuple(Check(name, "passed", finding.reason or finding.verdict, finding.verdict == "passed") for name, finding in findings.items())
    verdicts = [finding.verdict for finding in findings.values()]
    worst = next(verdict for verdict in ("failed", "inconclusive", "passed") if verdict in verdicts)
    return Evaluation(result.to_json(), checks, worst)


def _read_count(node: Node, end: int = RUNS_MAX + 1) -> int:
    count = node.as_int()
    if not 1 <= count < end:
        raise node.error(f"{count}; write a number from 1 to {end - 1}")
    return count


TIME, SERVICE, PARTITION = (RealTimeSubject(CAMPAIGNS[name]) for name in ("time", "service", "partition"))
