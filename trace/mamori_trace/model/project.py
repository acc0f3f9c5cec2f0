# SPDX-License-Identifier: Apache-2.0
"""The project: items, code, tests and evidence joined by ids, with the look-ups that rules and reports need."""

from __future__ import annotations

import difflib
import re
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from mamori_trace.base.finding import Problem
from mamori_trace.model.code import CodeSchema, Function
from mamori_trace.model.coverage import Coverage, CoverageRun, Reached
from mamori_trace.model.decomposition import Decomposition
from mamori_trace.model.evidence import ANY_SUITE, CAMPAIGN, PASSED, UNBOUND, WHOLE_SUITE, CampaignCase, CodeTag, Evidence, SourceTest, TestResult
from mamori_trace.model.ids import FormerId
from mamori_trace.model.item import Item, Schema
from mamori_trace.model.kinds import KindSchema
from mamori_trace.model.lock import ReviewLock
from mamori_trace.model.review_record import ReviewRecord
from mamori_trace.model.rule_pack import RulePack
from mamori_trace.model.technique import Technique
from mamori_trace.model.waiver import Waived, Waiver

_SECTIONS_MAX = 8
_DECORATIONS = (
    (re.compile(r"(?<=\S)\[.*\]$"), ""),  # pytest, JUnit 5
    (re.compile(r"(?<=\S)\([^()]*\)(?:\[[^\]]*\])?$"), ""),  # JUnit 5
    (re.compile(r" - [^/]+$"), " - *"),  # Catch2
    (re.compile(r"<.*>$"), "<*>"),  # doctest, Boost.Test
)
_BOOST_ROW = re.compile(r"_\d+")
_CPP_FILES = (".cpp", ".cc", ".cxx", ".hpp", ".h")


@dataclass
class Project:
    """All inputs. `all_items` contains every definition in file order; `items` the first definition of each id.

    `sources` is the hash of the sources, if the evidence has one. `date` is the day of the checked state (ISO 8601), or empty if unknown or
    not needed. `run_checks` sets `waived`, and `told`: (rule, item) of all findings.
    """

    root: Path
    schema: Schema
    all_items: list[Item] = field(default_factory=list)
    tags: list[CodeTag] = field(default_factory=list)
    tests: list[SourceTest] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    code_schema: CodeSchema = CodeSchema()
    evidence: Evidence = field(default_factory=Evidence)
    lock: ReviewLock | None = None
    head: str = ""
    sources: str = ""
    problems: list[Problem] = field(default_factory=list)
    allow_missing: bool = False
    release: bool = False
    pack: RulePack = field(default_factory=RulePack)
    waivers: list[Waiver] = field(default_factory=list)
    waived: list[Waived] = field(default_factory=list)
    told: frozenset[tuple[str, str]] = frozenset()
    decomposition: list[Decomposition] = field(default_factory=list)
    reviews: list[ReviewRecord] = field(default_factory=list)
    former_ids: dict[str, FormerId] = field(default_factory=dict)
    techniques: list[Technique] | None = None
    kinds: KindSchema = field(default_factory=KindSchema)
    date: str = ""
    review_needed: bool = True
    review_command: str = "mamori trace review"

    @cached_property
    def items(self) -> dict[str, Item]:
        first: dict[str, Item] = {}
        for item in self.all_items:
            first.setdefault(item.id, item)
        return first

    @cached_property
    def live_items(self) -> list[Item]:
        """Items that are not retired, sorted by id."""
        return [self.items[key] for key in sorted(self.items) if not self.items[key].retired]

    @cached_property
    def fingerprints(self) -> dict[str, str]:
        """Fingerprint of each item, by id."""
        return {key: item.calc_fingerprint() for key, item in self.items.items()}

    @cached_property
    def children_of(self) -> dict[str, list[Item]]:
        children: dict[str, list[Item]] = defaultdict(list)
        for item in self.live_items:
            for parent in dict.fromkeys(item.parents):
                children[parent].append(item)
        return children

    @cached_property
    def tags_of(self) -> dict[str, list[CodeTag]]:
        return _group(self.tags)

    @cached_property
    def traced_functions(self) -> list[Function]:
        """Functions of the layers that the project marks as traced."""
        return [function for function in self.functions if self.code_schema.is_traced(function.file)]

    @cached_property
    def coverage(self) -> Coverage:
        """The coverage of all tests together."""
        return Coverage(self.evidence.coverage_runs)

    def find_coverage(self, requirements: Iterable[str]) -> Coverage:
        """The coverage of the tests of these requirements if the evidence has coverage per test; otherwise the coverage of all tests."""
        titles = {one.title for name in requirements for one in (*self.results_of.get(name, ()), *self.tests_of.get(name, ()))}
        chosen = frozenset(titles & self._runs_by_test.keys())
        if not chosen:
            return self.coverage
        if chosen not in self._coverage_by_tests:
            self._coverage_by_tests[chosen] = Coverage(run for title in sorted(chosen) for run in self._runs_by_test[title])
        return self._coverage_by_tests[chosen]

    def measure(self, requirement: str) -> Reached:
        """The coverage of all functions that the requirement owns."""
        total = Reached()
        coverage = self.find_coverage([requirement])
        for function in self.functions_of.get(requirement, ()):
            total.add(coverage.measure(function))
        return total

    @cached_property
    def _runs_by_test(self) -> dict[str, list[CoverageRun]]:
        runs: dict[str, list[CoverageRun]] = defaultdict(list)
        for run in self.evidence.coverage_runs:
            if run.test:
                runs[run.test].append(run)
        return runs

    @cached_property
    def _coverage_by_tests(self) -> dict[frozenset[str], Coverage]:
        return {}

    @cached_property
    def functions_of(self) -> dict[str, list[Function]]:
        owned: dict[str, list[Function]] = defaultdict(list)
        for function in self.functions:
            for requirement in function.requirements:
                owned[requirement].append(function)
        return owned

    @cached_property
    def tests_of(self) -> dict[str, list[SourceTest]]:
        return _group(self.tests)

    @cached_property
    def results(self) -> list[TestResult]:
        """Counted results. A case that campaign.xml repeats counts once, unless both results differ."""
        told = {case.id: case.passed for case in self.evidence.cases}
        return [
            result
            for result in self.evidence.results
            if result.kind != CAMPAIGN or told.get(_get_case_id(result.name)) is not (not result.failing)
        ]

    @cached_property
    def results_of(self) -> dict[str, list[TestResult]]:
        return _group(result for result in self.results if result.requirement)

    @cached_property
    def cases_of(self) -> dict[str, list[CampaignCase]]:
        cases: dict[str, list[CampaignCase]] = defaultdict(list)
        for case in self.evidence.cases:
            for requirement in dict.fromkeys(case.requirements):
                cases[requirement].append(case)
        return cases

    @cached_property
    def tests_without_result(self) -> list[SourceTest]:
        """Source tests without a result, including tags in comments that belong to no test."""
        executed = {(*result.bound_to, result.requirement, result.source.file) for result in self.results if result.bound_to and result.source}
        return [
            test
            for test in self.tests
            if (test.name or test.by_comment) and (test.suite, test.name, test.requirement, test.place.file) not in executed
        ]

    @cached_property
    def unexecuted_of(self) -> dict[str, list[SourceTest]]:
        return _group(self.tests_without_result)

    @cached_property
    def cycles(self) -> list[list[str]]:
        """Parent cycles, each starting with its smallest id, sorted."""
        return _find_cycles({item.id: item.parents for item in self.live_items})

    def find_level_key(self, item_id: str) -> str:
        """The level of an item, or the level that the form of an unknown id indicates; otherwise empty."""
        item = self.items.get(item_id)
        level = None if item else self.schema.find_level(item_id)
        return item.level if item else level.key if level else ""

    def suggest(self, unknown: str, count: int = 3) -> list[str]:
        """The nearest known ids, best first. Ids of the same area come first, so a partial id is sufficient."""
        close = difflib.get_close_matches(unknown.upper(), self.items, n=count, cutoff=0.75)
        prefixed = sorted(key for key in self.items if key.startswith(unknown.upper()))
        return list(dict.fromkeys(close + prefixed))[:count]


def attach_sources(project: Project) -> None:
    """Gives each result the location of its test in the sources, which also separates unit tests from integration tests.

    A failed result counts for each requirement that its source names, even if the test ended before it named the requirement. A tag in a
    comment applies to each result, because the running test does not know the tag. A failed suite counts for each of its tests.
    """
    tests: dict[tuple[str, str], list[SourceTest]] = defaultdict(list)
    for test in project.tests:
        if test.name:
            tests[(test.suite, test.name)].append(test)
    results: list[TestResult] = []
    for result in project.evidence.results:
        found = _narrow(result, next((tests[key] for key in list_result_keys(result) if key in tests), []))
        results.append(result)
        if found:
            result.source = found[0].place
            result.bound_to = (found[0].suite, found[0].name)
            results.extend(_name_requirements(result, found))
    project.evidence.results = [*results, *_spread_failures(results)]


def _narrow(result: TestResult, tests: list[SourceTest]) -> list[SourceTest]:
    """If tests in several files have one name, selects those in the file that the result names, if any."""
    if len({test.place.file for test in tests}) < 2:
        return tests
    own = [test for test in tests if result.source is not None and test.place.file == result.source.file]
    if own:
        return own
    near: dict[int, list[SourceTest]] = defaultdict(list)
    parts = result.suite.split(".")
    for test in tests:
        folders = test.place.file.rpartition(".")[0].split("/")
        count = next((size for size in range(len(folders), 0, -1) if _holds(parts, folders[-size:])), 0)
        near[count].append(test)
    return near[max(near)]


def _holds(parts: list[str], inner: list[str]) -> bool:
    return any(parts[at : at + len(inner)] == inner for at in range(len(parts) - len(inner) + 1))


def _name_requirements(result: TestResult, tests: list[SourceTest]) -> list[TestResult]:
    """Sets the first requirement if the result has none. @return a copy of the result for each other requirement."""
    wanted: dict[str, SourceTest] = {}
    for test in tests:
        if test.by_comment or result.status not in (PASSED, UNBOUND):
            wanted.setdefault(test.requirement, test)
    copies = []
    for test in wanted.values():
        if test.requirement == result.requirement:
            continue
        target = replace(result) if result.requirement else result
        target.requirement = test.requirement
        target.technique = test.technique if target is not result else target.technique or test.technique
        target.polarity = test.polarity if target is not result else target.polarity or test.polarity
        if target is not result:
            copies.append(target)
    return copies


def _spread_failures(results: list[TestResult]) -> list[TestResult]:
    """Copies a failure that belongs to no single test, for each requirement of its suite; without a suite, of its file."""
    copies = []
    for bad in results:
        if bad.failing and not bad.requirement and bad.name in ("", WHOLE_SUITE):
            concerned = [one for one in results if one.place.file == bad.place.file and (not bad.suite or one.suite == bad.suite)]
            named = {(one.requirement, one.polarity): one for one in concerned if one.requirement}
            copies += [replace(bad, requirement=one.requirement, polarity=one.polarity, technique=one.technique) for one in named.values()]
    return copies


def _group(parts: Iterable) -> dict[str, list]:
    groups: dict[str, list] = defaultdict(list)
    for part in parts:
        groups[part.requirement].append(part)
    return groups


def _get_case_id(name: str) -> str:
    """`encoder_freeze-2[SYS-020]` -> `encoder_freeze-2`."""
    return name.partition("[")[0]


def list_result_keys(result: TestResult) -> list[tuple[str, str]]:
    """Suites and names that a source test of this result may have, the most specific first.

    GoogleTest adds instance names and numbers (`Instance/Suite/0`, `Name/3`). pytest adds packages (`a.b.test_c.TestD`) and parameters
    (`name[value]`), JUnit 5 a list of types (`name(int)[1]`). Catch2 and doctest add sections (`name/section`) and types (`name - int`,
    `name<int>`), Boost.Test numbers below the name (`suite.name` and `_0`).
    """
    full = result.name.strip()
    names = [full]
    cut = full
    for _ in range(_SECTIONS_MAX):
        cut, mark, _rest = cut.rpartition("/")
        names += [cut.strip()] if mark else []
    for pattern, put in _DECORATIONS:
        names += [changed for name in list(names) if (changed := pattern.sub(put, name)) != name]
    dotted = re.split(r"\.|::", result.suite)
    if _BOOST_ROW.fullmatch(full):
        names, dotted = [dotted[-1]], dotted[:-1] or [""]
    suites = result.suite.split("/") if "/" in result.suite else [dotted[-1], ".".join(dotted[-2:])]
    if result.suite.endswith(_CPP_FILES):
        suites = [result.suite.rpartition("/")[2], "global"]
    keys = [(suite, name) for name in names if name for suite in suites]
    return list(dict.fromkeys([*keys, (ANY_SUITE, full)]))


def _find_cycles(parents_of: dict[str, tuple[str, ...]]) -> list[list[str]]:
    """Visits each ancestor once (iterative depth-first search); a parent that is still on the path closes a cycle."""
    done: set[str] = set()
    cycles: list[list[str]] = []
    for start in sorted(parents_of):
        path: list[str] = []
        on_path: set[str] = set()
        stack: list[tuple[str, bool]] = [(start, False)]
        while stack:
            node, leaving = stack.pop()
            if leaving:
                path.pop()
                on_path.discard(node)
                done.add(node)
            elif node in on_path:
                ring = path[path.index(node) :]
                first = ring.index(min(ring))
                cycles.append(ring[first:] + ring[:first])
            elif node not in done:
                path.append(node)
                on_path.add(node)
                stack.append((node, True))
                stack.extend((parent, False) for parent in reversed(parents_of[node]) if parent in parents_of)
    return sorted(cycles)
