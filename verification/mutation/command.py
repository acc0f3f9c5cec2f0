# SPDX-License-Identifier: Apache-2.0
"""`./mamori mutate`: arguments, output and exit status of the command.

@satisfies SWR-VER-004, SWR-VER-006, SWR-VER-007, SWR-VER-009      Design: docs/design/test_strength.md#score
"""

from __future__ import annotations

import argparse
import datetime
import math
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.arguments import Command, add_jobs, at_least_one
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK, EXIT_UNFINISHED
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.nearest_names import nearest_names
from verification.mutation import baseline
from verification.mutation.equivalent import read_list
from verification.mutation.journal import Journal
from verification.mutation.operators import make_mutants
from verification.mutation.run import Plan, Report, Selection, Tally, make_plan, make_table, try_mutants, write_json
from verification.mutation.score import Counts, calc_interval, count
from verification.mutation.sources import ALL_LAYERS, EXAMPLE, LAYERS, Layer, get_layer, list_files, read_sources
from verification.mutation.trial import SURVIVED, Result

PROGRESS_S = 10.0


class OutOfTimeError(Exception):
    """The time limit of the request has elapsed."""


@dataclass(frozen=True)
class Request:
    """The request of the user."""

    files: tuple[str, ...] = ()
    sample: int | None = None
    seed: int = 1
    jobs: int = 1
    only_list: bool = False
    store: bool = False
    missing: bool = False  # only files without a valid row
    minutes: int | None = None  # stop after this time; None: no limit
    results: Path | None = None  # keeps the results, and continues a stopped run


def mutate(request: Request) -> int:
    """@return exit status. @raise InputError for files outside the layers."""
    project = Project(ROOT)
    if request.store and request.sample is not None:
        raise InputError("mutate: --store keeps the result of all mutants; leave --sample out")
    files = choose_files(request.files, {layer: list_files(project.root, (layer,)) for layer in ALL_LAYERS})
    if request.store and any(get_layer(file) == EXAMPLE for file in files):
        raise InputError(f"mutate: --store: no result of {EXAMPLE.name} is stored; write --results PATH")
    try:
        if request.missing:
            missing = read_standing(project.root).open_mutants
            files = tuple(file for file in files if file in missing)
        selection = Selection(files, request.sample, request.seed)
        plan = make_plan(project.root, selection, read_list())
        if request.only_list:
            return show_plan(plan)
        tell = Progress(plan, request.minutes)
        journal = Journal(request.results, plan) if request.results else None
        report = run_layers(project.root, plan, request.jobs, Keeper(project.root, plan, tell) if request.store else tell, journal)
        standing = read_standing(project.root)
    except WorkError as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    except OutOfTimeError:
        if request.results:
            print(f"stopped after {request.minutes} min. To continue, repeat the command")
            return EXIT_UNFINISHED
        print(f"stopped after {request.minutes} min; files without a valid stored result: {len(read_standing(project.root).open_mutants)}. "
              "To continue, call ./mamori mutate --missing --store")  # fmt: skip
        return EXIT_UNFINISHED
    write_json(project.evidence / "mutation" / "mutation.json", report, selection, standing)
    for line in (make_table(report.files), *standing.describe(), *describe(report)):
        print(line)
    if request.store:
        print(f"stored: {baseline.STORE.relative_to(project.root)}")
    # The tried files are a part of a layer; its other files have stored rows. The stored result covers both.
    is_strong = not standing.findings if request.missing and request.store else report.passed
    return EXIT_OK if is_strong and report.is_consistent else EXIT_FAILED


def run_layers(root: Path, plan: Plan, jobs: int, progress: Callable[[Result, int, int], None], journal: Journal | None = None) -> Report:
    """Tries `plan` layer by layer, in a separate folder, so that two runs do not collide. @param journal has results of an earlier run, and
    gets those of this run. @raise WorkError."""
    folder = root / "build" / "mutation"
    tally = Tally(plan, progress)
    known = journal.read() if journal else []
    for result in known:
        tally.note(result)

    def note(result: Result) -> None:
        if journal:
            journal.add(result)
        tally.note(result)

    left = set(plan.mutants) - {result.mutant for result in known}
    for layer in ALL_LAYERS:
        mutants = [mutant for mutant in plan.mutants if mutant in left and get_layer(mutant.file) == layer]
        if mutants:
            sources = read_sources(root, folder / "cmake", layer, jobs)
            with tempfile.TemporaryDirectory(prefix="work-", dir=folder) as work:
                try_mutants(sources, mutants, plan.sources, Path(work), jobs, note)
    return tally.make_report()


def choose_files(wanted: Sequence[str], known: Mapping[Layer, Sequence[str]]) -> tuple[str, ...]:
    """@return the named files, those of the named layers, or those of LAYERS. @raise InputError for a file outside the layers."""
    folders = {layer.name: files for layer, files in known.items()}
    every = [file for files in folders.values() for file in files]
    chosen: list[str] = []
    for name in map(_normalise, wanted):
        if name not in every and name not in folders:
            nearest = nearest_names(name, every, "./mamori mutate --list shows them with their mutants")
            raise InputError(f"mutate: '{name}' is no source or header of kernel, safety, ports or {EXAMPLE.name}; {nearest}")
        chosen += folders.get(name, (name,))
    return tuple(chosen) or tuple(file for layer in LAYERS for file in known[layer])


def _normalise(name: str) -> str:
    path = Path(name).absolute()
    return path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else name


class Progress:
    """Reports every survivor immediately, and the other results periodically. @raise OutOfTimeError after `minutes`."""

    def __init__(self, plan: Plan, minutes: int | None) -> None:
        self._plan = plan
        self._told = time.monotonic()
        self._end = math.inf if minutes is None else self._told + 60.0 * minutes
        self._survived = 0

    def __call__(self, result: Result, done: int, total: int) -> None:
        if result.verdict == SURVIVED:
            self._survived += 1
            print(result.mutant.make_diff(self._plan.sources[result.mutant.file]), flush=True)
        if done == total or time.monotonic() - self._told >= PROGRESS_S:
            self._told = time.monotonic()
            print(f"[{done}/{total}] mutants tried, {self._survived} survived", flush=True)
        if done < total and time.monotonic() >= self._end:
            raise OutOfTimeError


class Keeper:
    """Stores the row of each file as soon as its last mutant was tried, so that an aborted run keeps its results."""

    def __init__(self, root: Path, plan: Plan, tell: Callable[[Result, int, int], None]) -> None:
        self._root = root
        self._plan = plan
        self._tell = tell
        self._left = Counter(mutant.file for mutant in plan.mutants)
        self._results: list[Result] = []

    def __call__(self, result: Result, done: int, total: int) -> None:
        file = result.mutant.file
        self._results.append(result)
        self._left[file] -= 1
        if self._left[file] == 0:
            store(self._root, file, self._plan.sources[file], count(self._results)[file])
        self._tell(result, done, total)


def show_plan(plan: Plan) -> int:
    """Prints one line per mutant, without trying mutants."""
    for mutant in plan.mutants:
        source = plan.sources[mutant.file]
        before, after = mutant.get_change(source)
        print(f"{mutant.file}:{mutant.get_line(source)}: {mutant.operator}: {before}  ->  {after}")
    print(f"mutants: {len(plan.mutants)}; files: {len(plan.sources)}")
    return EXIT_OK


def describe(report: Report) -> list[str]:
    """The findings, and the closing lines."""
    lines = [f"equivalent.toml: row names no mutant any more, remove it: {row}" for row in report.plan.unused]
    lines += [f"equivalent.toml: {result.killer} kills this mutant, so it is not equivalent: {row}"
              for row, result in report.wrong_rows]  # fmt: skip
    for result in report.survivors:
        line = result.mutant.get_line(report.plan.sources[result.mutant.file])
        before, after = result.mutant.get_change(report.plan.sources[result.mutant.file])
        lines.append(f"{result.mutant.file}:{line}: survived: {before}  ->  {after}")
    lines += [describe_score(layer, counts, report.plan.is_sample) for layer, counts in report.layers.items()]
    return lines + [describe_campaign(report, layer) for layer in report.layers if layer.program]


def describe_campaign(report: Report, layer: Layer) -> str:
    """The share of the campaign."""
    counts, killed = report.count_campaign(layer), report.layers[layer].killed
    rejected = report.count_rejected(layer)
    return (f"killed by the campaign: {counts.score:.1%} ({counts.killed} of {counts.valid} that compile; {layer.campaign_bar:.0%} is the bar); by other"
            f" tests: {killed - counts.killed - rejected}; by rules of the compiler: {rejected}")  # fmt: skip


def describe_score(layer: Layer, counts: Counts, is_sample: bool) -> str:
    """The closing line of a layer."""
    kind = "all mutants"
    if is_sample:
        low, high = calc_interval(counts.killed, counts.valid)
        kind = f"sample of {counts.tried}, 95 % interval {low:.1%} to {high:.1%}"
    return (f"mutation score of {layer.name}: {counts.score:.1%} ({counts.killed} of {counts.valid} killed; {kind};"
            f" {layer.bar:.0%} is the bar)")  # fmt: skip


def store(root: Path, file: str, source: bytes, counts: Counts) -> None:
    """Adds the counts of one file to the stored result, and drops removed files."""
    entries = baseline.read_store()
    argv = ("git", "-C", str(root), "rev-parse", "--short=12", "HEAD")
    commit = subprocess.run(argv, capture_output=True, text=True, check=False)
    date = datetime.datetime.now(datetime.UTC).date().isoformat()
    entries[file] = baseline.Entry(baseline.fingerprint(source), commit.stdout.strip() or "unknown", date, counts)
    baseline.write_store({name: entry for name, entry in entries.items() if (root / name).is_file()})


def read_standing(root: Path) -> baseline.Standing:
    """Compares the stored result with the current layers. @raise WorkError if the file of results is invalid."""
    sources = {file: (root / file).read_bytes() for file in list_files(root)}
    mutated = {
        file: baseline.Mutated(baseline.fingerprint(source), len(mutants))
        for file, source in sources.items()
        if (mutants := make_mutants(file, source))
    }
    return baseline.judge_store(baseline.read_store(), mutated)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("files", nargs="*", metavar="FILE",
                        help="source or header of kernel, safety, ports or examples/safe_arm, or the name of such a folder; default: all without the "
                             "example")  # fmt: skip
    parser.add_argument("--sample", type=at_least_one, metavar="N", help="try N of the changes (at least 1), chosen by the seed; default: all")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="integer that selects the sample; default: %(default)s")
    parser.add_argument("--list", action="store_true", help="show the changes without trying them")
    parser.add_argument("--store", action="store_true",
                        help="store the result of each file, as it is finished, in verification/mutation/baseline.toml, to be committed")  # fmt: skip
    parser.add_argument("--missing", action="store_true", help="only files without a stored result that is valid for their current content")
    parser.add_argument("--minutes", type=at_least_one, metavar="M",
                        help="stop after M minutes (at least 1), with status 4; with --store, the results of finished files are kept")  # fmt: skip
    parser.add_argument("--results", type=Path, metavar="PATH",
                        help="keep each result in this file; the same command continues a stopped run, and tries survivors again")  # fmt: skip
    add_jobs(parser)


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return mutate(Request(tuple(arguments.files), arguments.sample, arguments.seed, arguments.jobs, arguments.list, arguments.store, arguments.missing,
                          arguments.minutes, arguments.results))


COMMAND = Command(
    add_arguments, run, "the share of small faults in kernel, safety and ports that the tests find",
    "Changes one thing at a time in a copy of kernel, safety or a port and runs the tests of the layer. A change that no test finds is shown as "
    "a diff. Ends with the share of changes that were found, for each layer. The acceptance limits are 95 % for safety and 90 % for the others. With "
    "examples/safe_arm: changes of the limits and the wiring of the example, by its campaign and its tests; 98 % must be found, and 60 % by the "
    "campaign.",
    {1: "a share is below its limit, or something failed", 4: "stopped by --minutes before all changes were tried"},
    examples=("mutate --sample 20 --seed 7", "mutate examples/safe_arm --sample 400 --results build/arm_mutants.jsonl"))  # fmt: skip
