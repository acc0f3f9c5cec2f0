# SPDX-License-Identifier: Apache-2.0
"""Evidence: tags in code, tests in sources, executed results, campaign cases, and their environment."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

from mamori_trace.base.finding import Place
from mamori_trace.model.coverage import CoverageRun

PASSED = "passed"
FAILED = "failed"
ERRORED = "error"
SKIPPED = "skipped"
NOT_SHOWN = "not shown here"
"""This host cannot produce the result: a privilege is missing, or the measurement was inconclusive."""
UNBOUND = "unbound"
"""Passed, but no evidence record names the origin of the result."""

STATUSES_WORST_FIRST = (ERRORED, FAILED, SKIPPED, UNBOUND, NOT_SHOWN, PASSED)

UNIT = "unit"
INTEGRATION = "integration"
CAMPAIGN = "campaign"


WHOLE_SUITE = "(whole suite)"
ANY_SUITE = "*"
"""Suite of a test whose source does not determine the suite of its result."""


class CodeTag(NamedTuple):
    """`@satisfies`: the code at `place` realises `requirement`. `symbol` is the class or function, or `file`."""

    requirement: str
    place: Place
    symbol: str


class SourceTest(NamedTuple):
    """A test as written in its source; `suite` and `name` identify its results. `by_comment`: the tag is a comment, so the results do not
    name the requirement."""

    requirement: str
    suite: str
    name: str
    technique: str
    polarity: str
    place: Place
    by_comment: bool = False

    @property
    def title(self) -> str:
        return f"{self.suite}.{self.name}" if self.name and self.suite not in ("", ANY_SUITE) else self.name or self.suite


@dataclass(slots=True)
class TestResult:
    """One executed test case. `requirement` is empty if the test names none; `flaky`: it passed, but not at the first attempt; `bound_to`:
    suite and name of its test in the sources."""

    __test__: ClassVar[bool] = False  # pytest would treat the class as a group of tests

    suite: str
    name: str
    status: str
    requirement: str
    technique: str
    polarity: str
    message: str
    time_s: float
    place: Place
    source: Place | None = None
    kind: str = UNIT
    flaky: bool = False
    bound_to: tuple[str, str] | None = None
    is_first: bool = True  # False for a copy of the case under a further requirement

    @property
    def title(self) -> str:
        return f"{self.suite}.{self.name}"

    @property
    def failing(self) -> bool:
        return self.status in (FAILED, ERRORED)


@dataclass(slots=True)
class CampaignCase:
    """One fault-injection case. `passed` requires the written verdict and every single check.

    `requirement_polarity` gives the polarity of a requirement if it differs from `polarity`.
    """

    id: str
    scenario: str
    title: str
    requirements: tuple[str, ...]
    polarity: str
    verdict: str
    checks: list[dict[str, Any]]
    expected: dict[str, Any]
    run: dict[str, Any]
    folder: str
    place: Place
    requirement_polarity: dict[str, str] = field(default_factory=dict)
    bound: bool = True

    def get_polarity(self, requirement: str) -> str:
        """The polarity that the case shows for `requirement`."""
        return self.requirement_polarity.get(requirement, self.polarity)

    @property
    def failed_checks(self) -> list[dict[str, Any]]:
        return [check for check in self.checks if check.get("passed") is not True]

    @property
    def passed(self) -> bool:
        return self.verdict == "pass" and not self.failed_checks

    @property
    def status(self) -> str:
        """One of PASSED, FAILED, NOT_SHOWN and UNBOUND."""
        if self.verdict == "inconclusive":
            return NOT_SHOWN
        return FAILED if not self.passed else PASSED if self.bound else UNBOUND


@dataclass(slots=True)
class TimingRun:
    """One system measured in real time by `mamori timing`; its reader has checked `record`. `folder` contains the pictures."""

    folder: str
    record: dict[str, Any]
    place: Place


@dataclass(slots=True)
class CostRun:
    """One system whose steps `mamori cost` counted; its reader has checked `record`."""

    folder: str
    record: dict[str, Any]
    place: Place


@dataclass(slots=True)
class SizeRun:
    """The memory of small systems on a controller; its reader has checked `record`."""

    record: dict[str, Any]
    place: Place


@dataclass(frozen=True, slots=True, order=True)
class AnalysisFinding:
    """A finding of a static analysis; `rule` is the name that its tool uses."""

    place: Place
    rule: str
    message: str


@dataclass(frozen=True, slots=True)
class FileRecord:
    """The row of one evidence file in `records.json`. `sources` is the hash of its sources, or empty.

    `now` is the current hash if the record covers chosen folders only; `intact`: the file matches its record.
    """

    shown: str
    sources: str
    now: str = ""
    intact: bool = True


@dataclass(slots=True)
class Evidence:
    """All files below one evidence folder. `folder` is its path as given, `shown` the path in findings.

    `results_shown` names result files that the user gave singly.
    """

    folder: str = ""
    shown: str = ""
    results_shown: str = ""
    results: list[TestResult] = field(default_factory=list)
    cases: list[CampaignCase] = field(default_factory=list)
    has_campaign: bool = False
    timing_runs: list[TimingRun] = field(default_factory=list)
    cost_runs: list[CostRun] = field(default_factory=list)
    size_runs: list[SizeRun] = field(default_factory=list)
    coverage_runs: list[CoverageRun] = field(default_factory=list)
    environment: dict[str, Any] = field(default_factory=dict)
    environment_place: Place = Place("environment.json", 1)
    analysis: list[AnalysisFinding] = field(default_factory=list)
    records: dict[str, FileRecord] = field(default_factory=dict)
    campaign_environment: dict[str, Any] = field(default_factory=dict)
    campaign_place: Place = Place("campaign/campaign.json", 1)

    @property
    def present(self) -> bool:
        return bool(self.folder)

    def unbind(self) -> None:
        """Changes `passed` to unbound for every result and case whose file has no intact record."""
        bound = {record.shown for record in self.records.values() if record.intact}
        for result in self.results:
            if result.status == PASSED and result.place.file not in bound:
                result.status = UNBOUND
        for case in self.cases:
            case.bound = case.place.file in bound

    @property
    def tells_sources(self) -> bool:
        """Whether the hash of the sources is known, and not only their commit."""
        environments = (self.environment, self.campaign_environment)
        return any(get_sources(one) for one in environments) or any(one.sources for one in self.records.values())


def get_sources(environment: dict[str, Any]) -> str:
    """Hash of the sources that an environment names, or nothing."""
    inputs = environment.get("inputs")
    made = inputs.get("sources") if isinstance(inputs, dict) else None
    return made if isinstance(made, str) else ""
