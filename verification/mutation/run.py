# SPDX-License-Identifier: Apache-2.0
"""One run: selects mutants, tries them on several benches in parallel, writes the evidence.

@satisfies SWR-VER-004, SWR-VER-005, SWR-VER-006      Design: docs/design/test_strength.md#score
"""

from __future__ import annotations

import json
import queue
import random
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from itertools import repeat
from pathlib import Path

from mamori_trace.base.text_file import write_text
from verification.mutation.baseline import Standing
from verification.mutation.equivalent import Row, match
from verification.mutation.operators import Mutant, make_mutants
from verification.mutation.score import LISTED, Counts, add_up, add_up_layers, calc_interval, count, is_met
from verification.mutation.sources import Layer, Sources, get_layer
from verification.mutation.trial import KILLED, SURVIVED, Result, Suspect, judge_together, make_companies, screen
from verification.mutation.workbench import TEST_TIMEOUT_S, Baseline, Bench

SCHEMA = "mamori.mutation/3"
SWEEP = 400  # mutants before the remaining ones are evaluated together
EXAMPLE_SWEEP = 80  # the same for an example, whose run is often stopped: the mutants of complete sweeps are a sample
Progress = Callable[[Result, int, int], None]


@dataclass(frozen=True)
class Selection:
    """The mutants to try. `size` None: all of them."""

    files: tuple[str, ...]
    size: int | None = None
    seed: int = 1


@dataclass(frozen=True)
class Plan:
    """A selection applied to the current sources."""

    sources: dict[str, bytes]
    mutants: tuple[Mutant, ...]
    listed: dict[Mutant, Row]
    unused: tuple[Row, ...]
    is_sample: bool


@dataclass(frozen=True)
class Report:
    """Results of a plan."""

    plan: Plan
    results: tuple[Result, ...]
    wrong_rows: tuple[tuple[Row, Result], ...]  # listed as equivalent, but a test kills the mutant

    @property
    def files(self) -> dict[str, Counts]:
        return count(self.results)

    @property
    def layers(self) -> dict[Layer, Counts]:
        return add_up_layers(self.files)

    @property
    def total(self) -> Counts:
        return add_up(self.files)

    @property
    def survivors(self) -> list[Result]:
        return [result for result in self.results if result.verdict == SURVIVED]

    @property
    def passed(self) -> bool:
        return self.is_consistent and all(
            is_met(counts, layer.bar, self.plan.is_sample) and is_met(self.count_campaign(layer), layer.campaign_bar, self.plan.is_sample)
            for layer, counts in self.layers.items()
        )

    def count_campaign(self, layer: Layer) -> Counts:
        """Mutants of a layer that the campaign killed, and those that it could have killed but did not."""
        tried = [result for result in self.results if get_layer(result.mutant.file) == layer and result.verdict in (KILLED, SURVIVED)]
        killed = sum(result.is_by_campaign for result in tried)
        return Counts(killed, sum(not result.is_by_compiler for result in tried) - killed)

    def count_rejected(self, layer: Layer) -> int:
        """Mutants of a layer that a rule rejects when it is compiled."""
        return sum(result.is_by_compiler for result in self.results if get_layer(result.mutant.file) == layer)

    @property
    def is_consistent(self) -> bool:
        """True if each row of the list of equivalent mutants names a mutant that no test finds."""
        return not self.plan.unused and not self.wrong_rows


def make_plan(root: Path, selection: Selection, rows: Sequence[Row]) -> Plan:
    """The same sources and selection give the same plan. A sample is in random order."""
    sources = {file: (root / file).read_bytes() for file in sorted(selection.files)}
    everything = [mutant for file, source in sources.items() for mutant in make_mutants(file, source)]
    listed, unused = match(rows, everything, sources)
    chosen = everything
    is_sample = selection.size is not None and selection.size < len(everything)
    if is_sample:
        chosen = random.Random(selection.seed).sample(everything, selection.size or 0)
    return Plan(sources, tuple(chosen), listed, tuple(unused), is_sample)


def try_mutants(
    sources: Sources, mutants: Sequence[Mutant], texts: Mapping[str, bytes], folder: Path, jobs: int,
    note: Callable[[Result], None], test_timeout_s: float = TEST_TIMEOUT_S,
) -> None:  # fmt: skip
    """Tries `mutants` of one layer and reports each result to `note`. @param texts of the current files. @raise WorkError if the tests fail
    on the unchanged layer."""
    baseline = Baseline(sources, folder, jobs, test_timeout_s)
    benches: queue.SimpleQueue[Bench] = queue.SimpleQueue()
    for number in range(jobs):
        benches.put(Bench(baseline, f"bench-{number}"))

    sweep = EXAMPLE_SWEEP if sources.has_campaign else SWEEP

    def screen_one(suspect: Suspect, stage: int) -> list[Result | Suspect]:
        with _borrow(benches) as bench:
            return [screen(bench, suspect, texts, stage)]

    def judge_some(suspects: Sequence[Suspect], stage: int) -> list[Result | Suspect]:
        with _borrow(benches) as bench:
            return judge_together(bench, suspects, texts, stage)

    def keep_suspects(found: Iterable[list[Result | Suspect]]) -> list[Suspect]:
        left: list[Suspect] = []
        for each in (each for some in found for each in some):
            if isinstance(each, Suspect):
                left.append(each)
            else:
                shutil.rmtree(baseline.get_folder(each.mutant), ignore_errors=True)
                note(each)
        return left

    with ThreadPoolExecutor(jobs) as pool:
        try:
            for start in range(0, len(mutants), sweep):
                suspects = [Suspect(mutant) for mutant in mutants[start : start + sweep]]
                for stage in range(len(baseline.stages)):
                    suspects = keep_suspects(pool.map(screen_one, suspects, repeat(stage)))
                    suspects = keep_suspects(pool.map(judge_some, make_companies(suspects, jobs), repeat(stage)))
        except BaseException:
            baseline.is_stopped = True
            pool.shutdown(wait=False, cancel_futures=True)
            raise


class Tally:
    """Results in order of arrival."""

    def __init__(self, plan: Plan, progress: Progress) -> None:
        self._plan = plan
        self._progress = progress
        self._results: list[Result] = []
        self._wrong: list[tuple[Row, Result]] = []

    def note(self, tried: Result) -> None:
        row = self._plan.listed.get(tried.mutant)
        if row is not None and tried.verdict == KILLED:
            self._wrong.append((row, tried))
        result = replace(tried, verdict=LISTED) if row is not None and tried.verdict == SURVIVED else tried
        self._results.append(result)
        self._progress(result, len(self._results), len(self._plan.mutants))

    def make_report(self) -> Report:
        """Sorted by location, independent of the order of arrival."""
        return Report(self._plan, tuple(sorted(self._results, key=lambda result: result.mutant)),
                      tuple(sorted(self._wrong, key=lambda wrong: wrong[1].mutant)))  # fmt: skip


@contextmanager
def _borrow(benches: queue.SimpleQueue[Bench]) -> Iterator[Bench]:
    bench = benches.get()
    try:
        yield bench
    finally:
        benches.put(bench)


def make_table(files: dict[str, Counts]) -> str:
    """One line per file and one for all."""
    width = max((len(file) for file in files), default=0)
    lines = [f"{'file':{width}}    score  killed  survived  listed  same code  not compiled"]
    for file, counts in (*files.items(), ("all files", add_up(files))):
        score = f"{counts.score:.1%}" if counts.valid else "-"
        lines.append(f"{file:{width}}  {score:>7}  {counts.killed:>6}  {counts.survived:>8}  {counts.listed:>6}"
                     f"  {counts.same_code:>9}  {counts.invalid:>12}")  # fmt: skip
    return "\n".join(lines)


def write_json(path: Path, report: Report, selection: Selection, stored: Standing) -> None:
    """Writes the file atomically. @param stored result of complete runs, shown together with this run."""
    content = {
        "schema": SCHEMA,
        "passed": report.passed,
        "sample": {"size": len(report.results), "seed": selection.seed} if report.plan.is_sample else None,
        "layers": {layer.name: _sum_up(counts, layer) for layer, counts in report.layers.items()},
        "stored": stored.to_json(),
        "files": [{"file": file, **asdict(counts), "score": counts.score} for file, counts in report.files.items()],
        "mutants": [_describe(result, report.plan) for result in report.results],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(content, indent=1))


def _sum_up(counts: Counts, layer: Layer) -> dict[str, object]:
    return {**asdict(counts), "score": counts.score, "interval": calc_interval(counts.killed, counts.valid), "bar": layer.bar}


def _describe(result: Result, plan: Plan) -> dict[str, object]:
    mutant, source = result.mutant, plan.sources[result.mutant.file]
    row: dict[str, object] = {"file": mutant.file, "line": mutant.get_line(source), "operator": mutant.operator,
                              "verdict": result.verdict, "killer": result.killer}  # fmt: skip
    if result.verdict in (SURVIVED, LISTED):
        row["diff"] = mutant.make_diff(source)
    if result.mutant in plan.listed:
        row["reason"] = plan.listed[result.mutant].reason
    return row
