# SPDX-License-Identifier: Apache-2.0
"""`./mamori bench`: build, measure, count, evaluate, show.

@satisfies SWR-BEN-003, SWR-BEN-005, SWR-BEN-008      Design: docs/design/bench.md#bench
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TextIO

from mamori_tools.host.arguments import Command, add_jobs
from mamori_tools.host.callgrind import ask_about, makes_system_calls, run_profiles
from mamori_tools.host.console import Screen
from mamori_tools.host.environment import collect_environment
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.process import Tick
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context, Step, all_passed, run_steps
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.nearest_names import nearest_names
from verification.bench import programs as tools
from verification.bench.bars import Bars, load_bars
from verification.bench.baseline import FILE, Baseline, CountResult, calc_count, judge_count, load_baseline, write_baseline
from verification.bench.grid import METRIC as GRID
from verification.bench.grid import add_grid, measure_grid
from verification.bench.judge import judge
from verification.bench.programs import NORMAL, QUICK, Effort, Programs
from verification.bench.record import Run, collect_host, make_record, write_record
from verification.bench.samples import Samples, read_samples
from verification.bench.table import show_run

EXACT = "exact"
BENCHES = {
    "port": "write and read of a port, one thread: 8 B, 64 B, 1 KB, 64 KB",
    "e2e": "the same with an end-to-end protected message: 8 B, 64 B, 1 KB",
    "scheduler": "a component per cycle, with and without supervision: 10, 100, 1000 components",
    "wake-up": "wake-up of another thread: the guarded host of the real-time port, and the floor",
    "fifo": "one entry of a FIFO between two processors: 8 B, 64 B, 1 KB; needs two processors",
    GRID: "lateness of wake-ups at 1 kHz: the grid of the real-time port, and cyclictest; needs a fixed priority",
    EXACT: "exact instruction counts (callgrind), and no heap or system call after start",
}
SEALED = ("port_8", "port_64", "e2e_port_32", "cycle_20", "supervised_cycle_20")
"""Operations that may neither use the heap nor make a system call. Their clock costs nothing, because clocks belong to ports."""


@dataclass(frozen=True)
class Request:
    """The request of the user. @raise InputError from check() for an unknown name, or a folder that is not writable."""

    only: tuple[str, ...] = ()
    is_quick: bool = False
    gates: bool = False
    accepts: bool = False
    out: Path | None = None
    wants_json: bool = False

    def check(self) -> None:
        for name in self.only:
            if name not in BENCHES:
                raise InputError(f"bench has no benchmark '{name}'; {nearest_names(name, BENCHES)}")
        if self.accepts and self.only and EXACT not in self.only:
            raise InputError(f"bench --accept is about exact counts; leave --only out, or name '{EXACT}' with it")
        if self.out is not None:
            try:
                self.out.mkdir(parents=True, exist_ok=True)
                with tempfile.TemporaryFile(dir=self.out):
                    pass
            except OSError as error:
                raise InputError(f"{self.out}: results cannot be written there ({error.strerror}); name a folder that you "
                                 "may write to") from error  # fmt: skip

    @property
    def names(self) -> tuple[str, ...]:
        """Benchmarks to run, in their fixed order."""
        if self.accepts:
            return (EXACT,)
        return tuple(name for name in BENCHES if not self.only or name in self.only)

    @property
    def metrics(self) -> tuple[str, ...]:
        return tuple(name for name in self.names if name != EXACT)

    @property
    def effort(self) -> Effort:
        return QUICK if self.is_quick else NORMAL


@dataclass
class Work:
    """The steps of one call and their findings."""

    request: Request
    bars: Bars
    baseline: Baseline | None
    programs: Programs
    samples_file: Path
    iceoryx2_reason: str = ""
    run: Run = field(default_factory=Run)

    def build(self, context: Context, tick: Tick, log: TextIO) -> None:
        if "port" in self.request.names:
            self.iceoryx2_reason = tools.build_iceoryx2(self.programs, tick, log)
        targets = [*(["mamori_bench"] if self.request.metrics else []), *(["mamori_exact"] if EXACT in self.request.names else [])]
        tools.build_programs(self.programs, targets, context.jobs, tick, log)

    def measure(self, context: Context, tick: Tick, log: TextIO) -> None:
        effort = self.request.effort
        samples = Samples({}, {}, "", "", effort.rounds)
        batched = [metric for metric in self.request.metrics if metric != GRID]
        if batched:
            tools.run_bench(self.programs, batched, effort, self.samples_file, tick, log)
            samples = name_reason(_read(self.samples_file), self.iceoryx2_reason)
        if GRID in self.request.metrics:
            samples = add_grid(samples, *measure_grid(self.programs, effort, self.samples_file.parent, tick, log))
        self.run = replace(self.run, samples=samples, ratios=judge(samples, self.bars))

    def count(self, context: Context, tick: Tick, log: TextIO) -> None:
        def tell(text: str) -> None:
            print(text, file=log, flush=True)
            tick(text)

        counts, proofs, baseline = count_all(self.programs.exact, self.bars, self.baseline, tell)
        self.baseline = baseline
        self.run = replace(self.run, counts=counts, proofs=proofs)

    def list_steps(self) -> tuple[Step, ...]:
        build = Step(name="build the benchmarks", function=self.build)
        measure = Step(name="measure", function=self.measure, needs=(build.name,))
        count = Step(name="count instructions", function=self.count, needs=(build.name,))
        return (build, *((measure,) if self.request.metrics else ()), *((count,) if EXACT in self.request.names else ()))


def _read(path: Path) -> Samples:
    try:
        return read_samples(path)
    except InputError as error:
        raise WorkError(str(error)) from error


def name_reason(samples: Samples, reason: str) -> Samples:
    """CMake reports only that the library of iceoryx2 is missing; the build of the library states why."""
    if not reason or tools.ICEORYX2 not in samples.absent:
        return samples
    return replace(samples, absent={**samples.absent, tools.ICEORYX2: reason})


def count_all(program: Path, bars: Bars, baseline: Baseline | None, tell: Tick
              ) -> tuple[list[CountResult], dict[str, str], Baseline]:  # fmt: skip
    """Counts the operations of every limit. @return evaluated counts, heap and system calls by operation, and the counts as a baseline.

    Without a baseline only the limits apply; new counts are accepted this way.
    """
    about = ask_about(program)
    compiler, c_library = str(about["compiler"]), str(about["c_library"])
    operations = dict.fromkeys([name for bar in bars.counts for name in bar.operations] + list(SEALED))
    profiles = run_profiles(program, operations, tell)
    counts = {bar.name: calc_count(bar, profiles) for bar in bars.counts}
    found = Baseline(compiler, c_library, counts)
    judged = [judge_count(bar, counts[bar.name], baseline or found, compiler, c_library) for bar in bars.counts]
    proofs = {name: describe_calls(profiles[name].heap_functions, makes_system_calls(program, name)) for name in SEALED}
    return judged, proofs, found


def describe_calls(heap: Sequence[str], makes_calls: bool) -> str:
    """@return the forbidden actions of an operation after start; empty if there are none."""
    words = [f"uses the heap ({', '.join(heap)})"] if heap else []
    return " and ".join([*words, *(["makes system calls"] if makes_calls else [])])


def list_benches() -> int:
    """Prints the available cases and the acceptance limits. @return exit status."""
    bars = load_bars()
    for name, text in BENCHES.items():
        print(f"{name:<10} {text}")
        for bar in bars.ratios:
            if bar.metric == name:
                limits = ", ".join(f"{limit:g} at {size}" for size, limit in bar.limits.items())
                print(f"{'':<10}   {bar.id} {bar.title}: {bar.kind}, ratio to {bar.against} at most {limits}")
        for growth in bars.growths:
            if growth.metric == name:
                print(f"{'':<10}   {growth.id} {growth.title}: {growth.kind}, at {growth.to_size} at most {growth.limit:g} times "
                      f"that at {growth.from_size}")  # fmt: skip
        for count in bars.counts if name == EXACT else ():
            limit = "" if count.limit is None else f", at most {count.limit}"
            print(f"{'':<10}   {count.id} {count.title}: not above the baseline{limit}")
    return EXIT_OK


def bench(request: Request, jobs: int) -> int:
    """@return exit status: 1 if a step failed, or, with --gate, if a gate failed."""
    request.check()
    project = Project(ROOT)
    bars = load_bars()
    baseline = load_baseline() if EXACT in request.names and not request.accepts else None
    folder = request.out or project.evidence / "bench"
    folder.mkdir(parents=True, exist_ok=True)
    context = Context(project, jobs, Screen(to_stderr=True))
    before = collect_host()
    with tempfile.TemporaryDirectory(prefix="mamori-bench-") as scratch:
        work = Work(request, bars, baseline, Programs(project), Path(scratch) / "samples.json")
        outcomes = run_steps(work.list_steps(), context)
    if not all_passed(outcomes):
        return EXIT_FAILED
    return show(work, context, folder, before)


def show(work: Work, context: Context, folder: Path, before: dict[str, object]) -> int:
    """Shows tables, record, picture and verdict of a finished run. @return exit status."""
    run, screen = work.run, context.screen
    environment = collect_environment(context.project, ["./mamori", *sys.argv[1:]])
    after = collect_host()
    record = make_record(run, environment, before, after, work.request.effort)
    if work.request.wants_json:
        print(json.dumps(record, indent=1))
    else:
        show_run(run, Screen())
    if work.request.accepts and work.baseline is not None:
        write_baseline(work.baseline)
        screen.say(f"accepted: {FILE.relative_to(ROOT)} holds these counts now; say in the commit why they changed")
    screen.say(f"record: {write_record(record, folder)}")
    if run.samples is not None:
        from verification.bench.picture import draw_run

        subtitle = (f"{environment['cpu']}, governor {before['governor']}, load {before['load_1_min']} .. {after['load_1_min']}; "
                    f"{run.samples.compiler} {run.samples.flags}; commit {str(environment['commit'])[:10]}; "
                    f"{run.samples.rounds} rounds")  # fmt: skip
        for path in draw_run(run, folder, subtitle):
            screen.say(f"picture: {path}")
    failed = run.failed
    hint = "" if work.request.gates or not failed else "; status 0 all the same, --gate makes it 1"
    screen.say(f"gates: {len(failed)} of {run.gate_count} failed{hint}", style="bold red" if failed else "")
    return EXIT_FAILED if failed and work.request.gates else EXIT_OK


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quick", action="store_true", help="fewer and shorter rounds: seconds instead of a minute")
    parser.add_argument("--gate", action="store_true", help="end with status 1 when a gate failed")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", action="extend",
                        help=f"only these benchmarks ({', '.join(BENCHES)}); default: all")  # fmt: skip
    parser.add_argument("--list", action="store_true", help="list the benchmarks and their acceptance limits; measures nothing")
    parser.add_argument("--accept", action="store_true", help="count instructions and store the counts as the new baseline")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results; default: build/host-release/evidence/bench")
    parser.add_argument("--json", action="store_true", help="print the record as JSON instead of tables")
    add_jobs(parser, "of the build")


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    if arguments.list:
        return list_benches()
    request = Request(tuple(arguments.only), arguments.quick, arguments.gate, arguments.accept, arguments.out, arguments.json)
    return bench(request, arguments.jobs)


COMMAND = Command(
    add_arguments, run, "times of the kernel relative to lower bounds and reference implementations; exact instruction counts",
    "Measures the kernel, lower bounds and reference implementations in one run and counts instructions exactly. Compares both results with their "
    "acceptance limits. An absent reference implementation is listed with the package to install. Writes bench.json, bench.svg and "
    "bench.png.",
    examples=("bench --quick --only port e2e",))  # fmt: skip
