# SPDX-License-Identifier: Apache-2.0
"""`./mamori fuzz`: runs harnesses for a limited time and reports their results.

@satisfies SWR-VER-010, SWR-VER-011      Design: docs/design/test_strength.md#fuzzing
"""

from __future__ import annotations

import argparse
import json
import re
import shlex
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.arguments import Command, add_jobs, at_least_one
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.nearest_names import nearest_names
from mamori_trace.base.text_file import write_text
from verification.fuzz.harness import Harness, Run, build_harnesses, find_harnesses, keep_inputs, run_harness

FOLDER = Path(__file__).resolve().parent
SCHEMA = "mamori.fuzz/1"
SHOWN_LINES = 20
FAULT = re.compile(r"ERROR: |runtime error: |deadly signal")


@dataclass(frozen=True)
class Request:
    """The request of the user."""

    names: tuple[str, ...] = ()
    seconds: int = 30
    jobs: int = 1
    keep: bool = False


def fuzz(request: Request, folder: Path = FOLDER, root: Path = ROOT) -> int:
    """Runs the harnesses of `folder` against the kernel and safety layers below `root`. @return exit status; 1 if a harness has a finding
    or did nothing, or if there is none. @raise InputError for an unknown harness."""
    project = Project(root)
    try:
        harnesses = choose(find_harnesses(folder, root / "build" / "fuzz"), request.names, folder)
        print(f"building {len(harnesses)} harnesses with address and undefined-behaviour sanitizers", flush=True)
        sources = sorted(path for layer in ("kernel", "safety") for path in (root / layer / "src").rglob("*.cpp"))
        build_harnesses(harnesses, sources, list_includes(root), request.jobs)
        with ThreadPoolExecutor(request.jobs) as pool:
            runs = list(pool.map(lambda one: run_harness(one, request.seconds, _say), harnesses))
        kept = {run.harness.name: keep_inputs(run.harness) for run in runs if run.passed} if request.keep else {}
    except WorkError as error:
        print(error, file=sys.stderr)
        return EXIT_FAILED
    write_json(project.evidence / "fuzz" / "fuzz.json", runs, request.seconds)
    for line in describe(runs, kept):
        print(line)
    return EXIT_OK if all(run.passed for run in runs) else EXIT_FAILED


def choose(harnesses: Sequence[Harness], names: Sequence[str], folder: Path) -> list[Harness]:
    """@raise WorkError if there are no harnesses. @raise InputError for an unknown name."""
    if not harnesses:
        raise WorkError(f"{folder} holds no <name>_fuzz.cpp; nothing was fuzzed")
    known = {harness.name: harness for harness in harnesses}
    for name in names:
        if name not in known:
            raise InputError(f"fuzz: there is no harness '{name}'; {nearest_names(name, known)}")
    return [known[name] for name in dict.fromkeys(names)] or list(harnesses)


def list_includes(root: Path) -> list[Path]:
    """Public headers of the layers that run on a controller."""
    return sorted(path for layer in ("kernel", "safety", "ports") for path in (root / layer).glob("**/include"))


def describe(runs: Sequence[Run], kept: dict[str, int]) -> list[str]:
    """One line per harness; for each failed harness also the input, its log, and the command that repeats it."""
    lines = []
    for run in runs:
        rate = run.executions / run.seconds if run.seconds > 0.0 else 0.0
        name = run.harness.name
        line = (f"{name}: {'passed' if run.passed else 'FAILED'}: {run.executions} executions in {run.seconds:.0f} s"
                f" ({rate:.0f}/s), {run.coverage} edges, {run.new_inputs} new inputs")  # fmt: skip
        lines.append(line + (f", {kept[name]} kept" if name in kept else ""))
        if not run.passed:
            lines += [f"    | {words}" for words in read_fault(run.harness.log)]
            lines.append(f"    {run.problem}; log: {run.harness.log}")
            for finding in run.findings:
                lines.append(f"    finding: {finding}")
                lines.append(f"    again:   {shlex.join((str(run.harness.program), str(finding)))}")
    findings = sum(len(run.findings) for run in runs)
    lines.append(f"fuzz: {len(runs)} harnesses, {findings} findings")
    return lines


def read_fault(log: Path) -> list[str]:
    """The first message of the sanitizer, or, without one, the last lines."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    first = next((number for number, line in enumerate(lines) if FAULT.search(line)), max(0, len(lines) - SHOWN_LINES))
    return lines[first : first + SHOWN_LINES]


def write_json(path: Path, runs: Sequence[Run], seconds: int) -> None:
    """Writes the file atomically."""
    content = {
        "schema": SCHEMA,
        "seconds": seconds,
        "harnesses": [
            {"name": run.harness.name, "executions": run.executions, "edges": run.coverage, "wall_s": round(run.seconds, 1),
             "new_inputs": run.new_inputs, "findings": [path.name for path in run.findings], "problem": run.problem}
            for run in runs
        ],
    }  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(content, indent=1))


def _say(text: str) -> None:
    print(text, flush=True)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("names", nargs="*", metavar="NAME", help="a harness, <NAME>_fuzz.cpp; default: all")
    parser.add_argument("--seconds", type=at_least_one, default=30, metavar="N",
                        help="time for each harness in seconds (at least 1); default: %(default)s")  # fmt: skip
    parser.add_argument("--keep", action="store_true", help="store new inputs that reach code which the stored inputs do not reach")
    add_jobs(parser)


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return fuzz(Request(tuple(arguments.names), arguments.seconds, arguments.jobs, arguments.keep))


COMMAND = Command(
    add_arguments, run, "random bytes for everything that reads bytes, under the sanitizers",
    "Builds the harnesses of verification/fuzz with address and undefined-behaviour sanitizers. Gives them random bytes, beginning with their "
    "stored inputs. When a harness finds something, the input and the command that repeats it are shown.",
    {1: "a harness found something, or something failed"},
    examples=("fuzz --seconds 60 --keep",))  # fmt: skip
