# SPDX-License-Identifier: Apache-2.0
"""Tries mutants: each alone by its most likely tests, and the surviving mutants together by all other tests.

A few tests find most mutants. The remaining mutants would have to be compiled into every test that includes their file, mostly without
effect. They are therefore combined in one copy, which all tests check once. Test cases that fail on the copy are repeated for each mutant
alone, and only that result kills a mutant. A surviving mutant has therefore passed every case of every test, alone or together with others.

@satisfies SWR-VER-005, SWR-VER-008      Design: docs/design/test_strength.md#counted-mutants
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from verification.mutation.operators import Mutant
from verification.mutation.sources import Unit
from verification.mutation.workbench import TIMED_OUT, Bench

KILLED = "killed"
SURVIVED = "survived"
INVALID = "does not compile"
EQUIVALENT = "same object code"

LIKELY = 4  # number of tests that try a mutant alone
LIKELY_CASES = 12  # the same for cases of a campaign, which need only one program
COMPANY = 20  # mutants that are tried together

# The compiler evaluates tables and their checks. A mutant that such a check rejects is killed by the check.
COMPILE_TIME_CHECK = re.compile(
    r"static assertion failed|static assertion expression is not an integral constant"
    r"|must be initialized by a constant expression|is not a constant expression"
)
FAILED_CASE = re.compile(r"^\[  FAILED  \] (\w[\w/]*\.[\w/]+)", re.MULTILINE)
BY_COMPILER = "compiler, "  # killer, before the unit
BY_CAMPAIGN = "campaign/"  # killer, before the case
CASES_FAILED = 1  # exit status of a test program that ran to its end
AT_ONCE = ("--gtest_fail_fast",)
FIRST_ERROR = re.compile(r"error: (?P<text>[^\n]*)")


@dataclass(frozen=True)
class Result:
    """The result of one mutant, and the test that killed it."""

    mutant: Mutant
    verdict: str
    killer: str = ""

    @property
    def is_by_campaign(self) -> bool:
        return self.killer.startswith(BY_CAMPAIGN)

    @property
    def is_by_compiler(self) -> bool:
        return self.killer.startswith(BY_COMPILER)


@dataclass(frozen=True)
class Suspect:
    """A mutant that has passed the likely tests alone, and the units whose objects it changed."""

    mutant: Mutant
    passed: frozenset[str] = frozenset()
    differing: tuple[Unit, ...] = ()


@dataclass(frozen=True)
class Fate:
    """Why the mutants of a trial differ from the original. `cases`: the failed cases of the test, if not all failed."""

    verdict: str
    killer: str = ""
    cases: tuple[str, ...] = ()


class Trial:
    """Mutants that are in the copy of a bench at the same time, and the units compiled from it so far."""

    def __init__(self, bench: Bench, mutants: Sequence[Mutant], sources: Mapping[str, bytes]) -> None:
        """@param mutants at different locations."""
        self._bench = bench
        self._texts = apply(mutants, sources)
        self._is_alone = len(mutants) == 1
        self._objects = bench.baseline.get_folder(mutants[0]) if self._is_alone else bench.folder / "together"
        self._objects.mkdir(parents=True, exist_ok=True)
        self._left = {unit.path: unit for unit in bench.baseline.find_units(self._texts)}
        is_header = any(file.endswith(".hpp") for file in self._texts)
        self._bound = {unit.path for unit in bench.baseline.find_bound()} if is_header else set()
        self._changed: dict[str, Path] = {}
        self.differing: list[Unit] = []

    def concerns(self, test: Unit) -> bool:
        """Whether the program of `test` may differ from the original."""
        parts = {test.path, *self._bench.baseline.links[test.path]}
        return test.path in self._bound or not parts.isdisjoint(self._left) or not parts.isdisjoint(self._changed)

    def run(self, test: Unit, options: Sequence[str]) -> Fate | None:
        """Compiles the units of the program of `test`, and runs the program if its bytes have changed. @return None if it passes."""
        parts = {test.path, *self._bench.baseline.links[test.path]}
        for unit in [self._left[path] for path in sorted(parts & self._left.keys())]:
            if fate := self.compile(unit):
                return fate
        if test.path not in self._bound and parts.isdisjoint(self._changed):
            return None
        self._bench.put(self._texts)
        status, words = self._bench.run_test(test, self._changed, self._bench.baseline.calc_timeout(test), *options)
        if status == 0:
            return None
        cases = tuple(FAILED_CASE.findall(words)) if status == CASES_FAILED else ()
        return Fate(KILLED, f"{test.path} {words}" if words == TIMED_OUT else test.path, cases)

    def compile(self, unit: Unit) -> Fate | None:
        """Compiles `unit` unless it was already compiled. @return why the compiler rejects it, or None."""
        if unit.path not in self._left:
            return None
        self._bench.put(self._texts)
        output = self._objects / (unit.path.replace("/", "_") + ".o")
        if not (self._is_alone and output.exists()):
            status, words = self._bench.compile(unit, output)
            if status != 0:
                error = FIRST_ERROR.search(words)
                is_check = error is not None and COMPILE_TIME_CHECK.search(error["text"])
                return Fate(KILLED, f"{BY_COMPILER}{unit.path}") if is_check else Fate(INVALID)
        del self._left[unit.path]
        if output.read_bytes() != self._bench.baseline.get_object(unit).read_bytes():
            self._changed[unit.path] = output
            self.differing.append(unit)
        return None

    def has_same_code(self, units: Iterable[Unit]) -> bool:
        """Whether the optimised code of all `units` equals that of the original."""
        self._bench.put(self._texts)
        return all(self._bench.hash_assembler(unit) == self._bench.baseline.get_assembler(unit)
                   for unit in units if unit.path not in self._bound)  # fmt: skip


def apply(mutants: Sequence[Mutant], sources: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files that `mutants` change, with all changes applied."""
    texts: dict[str, bytes] = {}
    for mutant in sorted(mutants, reverse=True):  # the last location first, so that earlier locations stay valid
        texts[mutant.file] = mutant.apply(texts.get(mutant.file, sources[mutant.file]))
    return texts


def screen(bench: Bench, suspect: Suspect, sources: Mapping[str, bytes], stage: int = 0) -> Result | Suspect:
    """Tries `suspect` alone by its most likely tests of a stage."""
    mutant = suspect.mutant
    trial = Trial(bench, (mutant,), sources)
    passed: set[str] = set()
    for test in bench.baseline.order_tests((mutant.file,), stage):
        if not trial.concerns(test):
            continue
        if fate := trial.run(test, AT_ONCE):
            return _note(bench, mutant, fate, test)
        passed.add(test.path)
        if len(passed) == (LIKELY_CASES if test.case else LIKELY):
            break
    return Suspect(mutant, suspect.passed | passed, tuple(dict.fromkeys((*suspect.differing, *trial.differing))))


def judge_together(bench: Bench, suspects: Sequence[Suspect], sources: Mapping[str, bytes], stage: int = 0) -> list[Result | Suspect]:
    """Tries `suspects` together by all tests of a stage that they have not passed yet. @return results in the order of `suspects`; suspects
    that survive another than the last stage."""
    court = Court(bench, suspects, sources)
    files = {suspect.mutant.file for suspect in suspects}
    for test in bench.baseline.order_tests(files, stage):
        court.try_all(test)
    if stage < len(bench.baseline.stages) - 1:
        return court.adjourn()
    for unit in bench.baseline.find_units(files):
        if not unit.is_test:
            court.compile_all(unit)
    return court.close()


class Court:
    """Suspects that are tried together; killed ones are removed."""

    def __init__(self, bench: Bench, suspects: Sequence[Suspect], sources: Mapping[str, bytes]) -> None:
        self._bench = bench
        self._sources = sources
        self._suspects = tuple(suspects)
        self._alive = list(suspects)
        self._results: dict[Mutant, Result] = {}
        self._differing: dict[str, Unit] = {}
        self._together = self._gather()

    def try_all(self, test: Unit) -> None:
        """Runs `test` for all suspects together, and its failing cases for each suspect alone."""
        due = [suspect for suspect in self._alive if test.path not in suspect.passed]
        if due and self._together.concerns(test):
            fate = self._together.run(test, AT_ONCE if len(self._alive) == 1 else ())
            options = (f"--gtest_filter={':'.join(fate.cases)}", *AT_ONCE) if fate is not None and fate.cases else AT_ONCE
            self._decide(due, test, fate, lambda trial: trial.run(test, options))

    def compile_all(self, unit: Unit) -> None:
        """The same for a unit that must only compile."""
        if self._alive:
            self._decide(self._alive, unit, self._together.compile(unit), lambda trial: trial.compile(unit))

    def adjourn(self) -> list[Result | Suspect]:
        """@return the results of the killed ones, and the others with all units that differ in one of them."""
        self._keep(self._together.differing)
        alive = {suspect.mutant: replace(suspect, differing=tuple(dict.fromkeys((*suspect.differing, *self._differing.values()))))
                 for suspect in self._alive}  # fmt: skip
        return [alive.get(suspect.mutant) or self._results[suspect.mutant] for suspect in self._suspects]

    def close(self) -> list[Result | Suspect]:
        """@return the results of all suspects."""
        self._keep(self._together.differing)
        for suspect in self._alive:
            self._keep(suspect.differing)
        units = self._sort_by_code()
        for suspect in self._alive:
            own = {unit.path for unit in suspect.differing}
            is_same = self._alone(suspect).has_same_code(sorted(units, key=lambda unit: (units[unit], unit.path not in own)))
            self._results[suspect.mutant] = Result(suspect.mutant, EQUIVALENT if is_same else SURVIVED)
        return [self._results[suspect.mutant] for suspect in self._suspects]

    def _sort_by_code(self) -> dict[Unit, bool]:
        """The units that may differ, and whether their optimised code is unchanged with all remaining mutants applied. Changed units show
        the difference of a single mutant soonest."""
        units = list(self._differing.values())
        if len(self._alive) < 2:
            return dict.fromkeys(units, False)
        return {unit: self._together.has_same_code((unit,)) for unit in units}

    def _decide(self, due: Sequence[Suspect], unit: Unit, fate: Fate | None, attempt: Callable[[Trial], Fate | None]) -> None:
        """@param fate result of all suspects together. @param attempt returns the result of a single suspect."""
        if fate is None:
            return
        fates = {due[0]: fate} if len(self._alive) == 1 else {suspect: attempt(self._alone(suspect)) for suspect in due}
        found = {suspect: fate for suspect, fate in fates.items() if fate is not None}
        for suspect, fate in found.items():
            self._results[suspect.mutant] = _note(self._bench, suspect.mutant, fate, unit)
        if found:
            self._keep(self._together.differing)
            self._alive = [suspect for suspect in self._alive if suspect not in found]
            self._together = self._gather()

    def _gather(self) -> Trial:
        return Trial(self._bench, [suspect.mutant for suspect in self._alive], self._sources)

    def _keep(self, units: Iterable[Unit]) -> None:
        self._differing.update((unit.path, unit) for unit in units)

    def _alone(self, suspect: Suspect) -> Trial:
        return Trial(self._bench, (suspect.mutant,), self._sources)


def make_companies(suspects: Sequence[Suspect], count: int) -> list[list[Suspect]]:
    """Distributes `suspects` to at least `count` groups of at most COMPANY. Adjacent suspects are separated, and all mutants of a group
    have different locations."""
    companies: list[list[Suspect]] = [[] for _ in range(max(count, -(-len(suspects) // COMPANY)))]
    for suspect in suspects:
        company = next((each for each in sorted(companies, key=len) if len(each) < COMPANY and _fits(suspect, each)), None)
        if company is None:
            companies.append([suspect])
        else:
            company.append(suspect)
    return [company for company in companies if company]


def _fits(suspect: Suspect, company: Sequence[Suspect]) -> bool:
    mutant = suspect.mutant
    others = [other.mutant for other in company if other.mutant.file == mutant.file]
    return all(mutant.end <= other.start or other.end <= mutant.start for other in others)


def _note(bench: Bench, mutant: Mutant, fate: Fate, unit: Unit) -> Result:
    if (unit.is_test or unit.case) and fate.verdict == KILLED and not fate.killer.startswith(BY_COMPILER):
        bench.baseline.note_kill(mutant.file, unit)
    return Result(mutant, fate.verdict, fate.killer)
