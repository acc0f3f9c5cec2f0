# SPDX-License-Identifier: Apache-2.0
"""Finds, builds and runs one harness.

@satisfies SWR-VER-010, SWR-VER-011      Design: docs/design/test_strength.md#fuzzing
"""

from __future__ import annotations

import re
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

COMPILER = "clang++-19"
SUFFIX = "_fuzz.cpp"
# vptr needs type information, which the kernel lacks.
SANITIZERS = "address,undefined"
FLAGS = ("-std=c++17", "-O1", "-g", "-fno-omit-frame-pointer", "-fno-exceptions", "-fno-rtti", "-fno-sanitize=vptr",
         "-fno-sanitize-recover=all", "-ffp-contract=off", "-UNDEBUG")  # fmt: skip
INPUT_TIMEOUT_S = 10  # one input that takes longer is a finding
MEMORY_MIB = 2048
GRACE_S = 60.0
POLL_S = 0.2
PROGRESS_S = 10.0
STATUS = re.compile(r"^#(?P<executions>\d+)\s.*\bcov: (?P<coverage>\d+)", re.MULTILINE)
FINAL = re.compile(r"^stat::number_of_executed_units:\s*(?P<executions>\d+)", re.MULTILINE)


class FuzzError(Exception):
    """Nothing could be fuzzed: what failed, and its words."""


@dataclass(frozen=True)
class Harness:
    """One file with LLVMFuzzerTestOneInput, its stored corpus, and the folder of its run."""

    source: Path
    build: Path

    @property
    def name(self) -> str:
        return self.source.name.removesuffix(SUFFIX)

    @property
    def corpus(self) -> Path:
        return self.source.parent / "corpus" / self.name

    @property
    def program(self) -> Path:
        return self.build / self.name / f"{self.name}_fuzz"

    @property
    def new_inputs(self) -> Path:
        return self.build / self.name / "new"

    @property
    def findings(self) -> Path:
        return self.build / self.name / "findings"

    @property
    def log(self) -> Path:
        return self.build / self.name / "run.log"


@dataclass(frozen=True)
class Run:
    """What came of one harness."""

    harness: Harness
    executions: int
    coverage: int  # edges of the program that were reached
    seconds: float
    new_inputs: int
    findings: tuple[Path, ...]
    problem: str = ""  # why it failed; nothing when it did not

    @property
    def passed(self) -> bool:
        return not self.problem


def find_harnesses(folder: Path, build: Path) -> list[Harness]:
    """Harnesses in `folder`, by name."""
    return [Harness(path, build) for path in sorted(folder.glob(f"*{SUFFIX}"))]


def build_harnesses(harnesses: Sequence[Harness], sources: Sequence[Path], includes: Sequence[Path], jobs: int) -> None:
    """Compiles `sources` once, and each harness with them. @raise FuzzError with the compiler's words."""
    objects = harnesses[0].build / "objects"
    shutil.rmtree(objects, ignore_errors=True)
    objects.mkdir(parents=True)
    folders = [f"-I{path}" for path in includes]

    def compile_one(path: Path) -> Path:
        output = objects / f"{path.stem}.o"
        _compile((COMPILER, *FLAGS, f"-fsanitize=fuzzer-no-link,{SANITIZERS}", *folders, "-c", str(path), "-o", str(output)))
        return output

    def link_one(harness: Harness) -> None:
        harness.program.parent.mkdir(parents=True, exist_ok=True)
        _compile((COMPILER, *FLAGS, f"-fsanitize=fuzzer,{SANITIZERS}", *folders, str(harness.source), *map(str, compiled),
                  "-o", str(harness.program)))  # fmt: skip

    with ThreadPoolExecutor(jobs) as pool:
        compiled = list(pool.map(compile_one, sources))
        list(pool.map(link_one, harnesses))


def _compile(argv: Sequence[str]) -> None:
    try:
        done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    except FileNotFoundError as error:
        raise FuzzError(f"'{argv[0]}' is not installed; ./mamori fuzz installs it") from error
    if done.returncode != 0:
        raise FuzzError(f"'{' '.join(argv)}' ended with status {done.returncode}:\n{done.stderr.strip()}")


def run_harness(harness: Harness, seconds: int, say: Callable[[str], None]) -> Run:
    """Fuzzes for `seconds`, or until the first finding. New inputs and findings stay in the build folder."""
    shutil.rmtree(harness.new_inputs, ignore_errors=True)
    harness.new_inputs.mkdir(parents=True)
    harness.findings.mkdir(exist_ok=True)
    before = set(harness.findings.iterdir())
    folders = [harness.new_inputs, *([harness.corpus] if harness.corpus.is_dir() else [])]
    argv = (str(harness.program), *map(str, folders), f"-max_total_time={seconds}", "-print_final_stats=1",
            f"-timeout={INPUT_TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MIB}", f"-artifact_prefix={harness.findings}/")  # fmt: skip
    start = time.monotonic()
    status = _watch(harness, argv, seconds, say)
    text = harness.log.read_text(encoding="utf-8", errors="replace")
    progress = list(STATUS.finditer(text))
    final = FINAL.search(text)
    executions = int(final["executions"]) if final else int(progress[-1]["executions"]) if progress else 0
    coverage = int(progress[-1]["coverage"]) if progress else 0
    found = tuple(sorted(set(harness.findings.iterdir()) - before))
    problem = f"ended with status {status}" if status != 0 else "" if executions > 0 else "executed nothing"
    return Run(harness, executions, coverage, time.monotonic() - start, len(list(harness.new_inputs.iterdir())), found, problem)


def _watch(harness: Harness, argv: Sequence[str], seconds: int, say: Callable[[str], None]) -> int:
    """@return exit status of the program, whose output goes to its log."""
    told = start = time.monotonic()
    with harness.log.open("wb") as log:
        child = subprocess.Popen(argv, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        try:
            while True:
                try:
                    return child.wait(POLL_S)
                except subprocess.TimeoutExpired:
                    now = time.monotonic()
                if now - start > seconds + GRACE_S:
                    child.kill()
                elif now - told >= PROGRESS_S:
                    told = now
                    lines = STATUS.findall(harness.log.read_text(encoding="utf-8", errors="replace"))
                    executions, coverage = lines[-1] if lines else ("0", "0")
                    say(f"{harness.name}: {now - start:.0f} s, {executions} executions, {coverage} edges")
        finally:
            if child.poll() is None:
                child.kill()
                child.wait()


def keep_inputs(harness: Harness) -> int:
    """Adds to the stored corpus those new inputs that reach something it does not. @return how many. @raise FuzzError."""
    harness.corpus.mkdir(parents=True, exist_ok=True)
    before = len(list(harness.corpus.iterdir()))
    _compile((str(harness.program), "-merge=1", str(harness.corpus), str(harness.new_inputs)))
    return len(list(harness.corpus.iterdir())) - before
