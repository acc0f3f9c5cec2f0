# SPDX-License-Identifier: Apache-2.0
"""Finds, builds and runs one harness.

@satisfies SWR-VER-010, SWR-VER-011      Design: docs/design/test_strength.md#fuzzing
"""

from __future__ import annotations

import base64
import binascii
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.text_file import write_text

COMPILER = "clang++-19"
SUFFIX = "_fuzz.cpp"
# The option vptr needs type information, which the kernel lacks.
SANITIZERS = "address,undefined"
FLAGS = ("-std=c++17", "-O1", "-g", "-fno-omit-frame-pointer", "-fno-exceptions", "-fno-rtti", "-fno-sanitize=vptr",
         "-fno-sanitize-recover=all", "-ffp-contract=off", "-UNDEBUG")  # fmt: skip
INPUT_TIMEOUT_S = 10  # an input that takes longer is a finding
MEMORY_MIB = 2048
GRACE_S = 60.0
POLL_S = 0.2
PROGRESS_S = 10.0
STATUS = re.compile(r"^#(?P<executions>\d+)\s.*\bcov: (?P<coverage>\d+)", re.MULTILINE)
FINAL = re.compile(r"^stat::number_of_executed_units:\s*(?P<executions>\d+)", re.MULTILINE)


@dataclass(frozen=True)
class Harness:
    """One file with LLVMFuzzerTestOneInput, its stored corpus, and the folder of its run.

    A corpus is one text file with a line for each input: its name and its bytes in base64."""

    source: Path
    build: Path

    @property
    def name(self) -> str:
        return self.source.name.removesuffix(SUFFIX)

    @property
    def corpus(self) -> Path:
        return self.source.parent / "corpus" / f"{self.name}.txt"

    @property
    def inputs(self) -> Path:
        """Folder of the corpus files for the program."""
        return self.build / self.name / "corpus"

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
    """Result of one harness."""

    harness: Harness
    executions: int
    coverage: int  # number of reached edges of the program
    seconds: float
    new_inputs: int
    findings: tuple[Path, ...]
    problem: str = ""  # why it failed; empty if it passed

    @property
    def passed(self) -> bool:
        return not self.problem


def find_harnesses(folder: Path, build: Path) -> list[Harness]:
    """Harnesses in `folder`, sorted by name."""
    return [Harness(path, build) for path in sorted(folder.glob(f"*{SUFFIX}"))]


def build_harnesses(harnesses: Sequence[Harness], sources: Sequence[Path], includes: Sequence[Path], jobs: int) -> None:
    """Compiles `sources` once, and links each harness with them. @raise WorkError with the message of the compiler."""
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
        raise WorkError(f"'{argv[0]}' is not installed; ./mamori fuzz installs it") from error
    if done.returncode != 0:
        raise WorkError(f"'{' '.join(argv)}' ended with status {done.returncode}:\n{done.stderr.strip()}")


def run_harness(harness: Harness, seconds: int, say: Callable[[str], None]) -> Run:
    """Fuzzes for `seconds`, or until the first finding. New inputs and findings stay in the build folder."""
    shutil.rmtree(harness.new_inputs, ignore_errors=True)
    harness.new_inputs.mkdir(parents=True)
    harness.findings.mkdir(exist_ok=True)
    before = set(harness.findings.iterdir())
    unpack_corpus(harness)
    folders = [harness.new_inputs, harness.inputs]
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
    """@return exit status of the program; its output goes to its log."""
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


def read_corpus(file: Path) -> dict[str, bytes]:
    """Inputs by name; empty without the file. @raise InputError with file and line of an invalid row."""
    rows = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    inputs: dict[str, bytes] = {}
    for number, row in enumerate(rows, 1):
        name, _, data = row.partition(" ")
        try:
            inputs[_check_name(name)] = base64.b64decode(data, validate=True)
        except (ValueError, binascii.Error) as error:
            raise InputError(f"is not an input ({error}); write a name, a blank and the bytes in base64", file, number) from error
        if len(inputs) != number:
            raise InputError(f"input {name} is there twice; remove one of them", file, number)
    return inputs


def _check_name(name: str) -> str:
    if not re.fullmatch(r"\w+", name, re.ASCII):
        raise ValueError(f"'{name}' is no name")
    return name


def unpack_corpus(harness: Harness) -> None:
    """Writes each input of the corpus to its own file. @raise InputError like read_corpus()."""
    shutil.rmtree(harness.inputs, ignore_errors=True)
    harness.inputs.mkdir(parents=True)
    for name, data in read_corpus(harness.corpus).items():
        (harness.inputs / name).write_bytes(data)


def keep_inputs(harness: Harness) -> int:
    """Adds to the stored corpus those new inputs that reach additional code. @return their number. @raise WorkError."""
    before = len(list(harness.inputs.iterdir()))
    _compile((str(harness.program), "-merge=1", str(harness.inputs), str(harness.new_inputs)))
    files = sorted(harness.inputs.iterdir())
    harness.corpus.parent.mkdir(parents=True, exist_ok=True)
    write_text(harness.corpus, "".join(f"{file.name} {base64.b64encode(file.read_bytes()).decode('ascii')}\n" for file in files))
    return len(files) - before
