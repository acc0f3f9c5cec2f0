# SPDX-License-Identifier: Apache-2.0
"""Compiles mutants in a private copy of a layer and runs its tests on them, in bounded time and memory.

Each test file is a separate program. The test that most likely finds the fault is compiled and run first; if it fails, the other tests are
not built.

@satisfies SWR-VER-005, SWR-VER-008      Design: docs/design/test_strength.md#counted-mutants
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mamori_trace.base.errors import WorkError
from verification.mutation.campaign import Campaign
from verification.mutation.operators import Mutant
from verification.mutation.sources import COMPILER, PLAN, PROGRAM, PROGRAM_UNIT, Sources, Unit

COMPILE_TIMEOUT_S = 120.0
TEST_TIMEOUT_S = 10.0  # added to the time limit of a test
TEST_PATIENCE = 5.0  # multiplies the duration of the test on the unchanged layer
SLOWEST_TEST_S = 240.0  # time limit on the unchanged layer, on a busy host
MEMORY_KIB = 4 * 1024 * 1024
FILE_BLOCKS = 512 * 1024  # number of blocks of 512 bytes that a compiler or test may write
LIBRARIES = ("-lgtest_main", "-lgtest", "-lpthread")
# Process ids of their own: a mutant of a port may send a signal to any process that it can name. They all end with the first one.
# A shell starts jobs in the background with SIGINT ignored, and ports handle this signal.
ENCLOSED = ("env", "--default-signal=INT,QUIT", "unshare", "--pid", "--fork", "--kill-child", "--mount-proc", "--", "/bin/sh", "-c", '"$@"; exit $?', "sh")
TEST_FLAGS = ("-O0", "-w", "-UNDEBUG", "-ffp-contract=off")
COMPARED_FLAGS = ("-O2", "-g0", "-w", "-fno-ident", "-UNDEBUG", "-ffp-contract=off")


class Baseline:
    """The unchanged layer: its objects, the includes of each unit, the objects and duration of each test, and the order
    of the tests. Shared by all benches."""

    def __init__(self, sources: Sources, folder: Path, jobs: int, test_timeout_s: float = TEST_TIMEOUT_S) -> None:
        """Compiles every unit and runs every test. @param folder empty or new. @raise WorkError if a test fails on the unchanged layer."""
        self.sources = sources
        self.folder = folder
        self.test_timeout_s = test_timeout_s
        self.includes: dict[str, frozenset[str]] = {}
        self.links: dict[str, frozenset[str]] = {}
        self.archive = folder / "liblayer.a"
        self.is_stopped = False  # benches start no further work: the evaluation of many mutants takes minutes
        self.archives = [self.archive]  # in the order in which the linker needs them
        self._took_s: dict[str, float] = {}
        self._kills: Counter[tuple[str, str]] = Counter()  # by mutated file and path of the test
        self._assembler: dict[str, str] = {}
        self._texts = {test.path: (sources.folder / test.path).read_text(encoding="utf-8") for test in self.tests}
        self.campaign = Campaign(sources.folder / PLAN, folder / "inputs") if sources.has_campaign else None
        (folder / "objects").mkdir(parents=True)
        self.prefix = self._make_prefix("prefix", (*TEST_FLAGS, "-fpch-instantiate-templates"))
        self.compared_prefix = self._make_prefix("compared", COMPARED_FLAGS)
        bench = Bench(self, "original")
        with ThreadPoolExecutor(jobs) as pool:
            problems = [words for words in pool.map(lambda unit: self._compile(unit, bench), sources.units) if words]
            problems += [words for words in pool.map(self._compile_below, sources.below) if words]
            if not problems:
                self._make_archives()
                if self.campaign is not None:
                    problems += bench.check_program()
                problems += [words for stage in self.stages for words in pool.map(lambda test: self._measure(test, bench), stage) if words]
        if problems:
            raise WorkError(f"{sources.layer} must pass its tests before it is mutated:\n" + "\n".join(problems))
        self._bench = bench

    @property
    def tests(self) -> list[Unit]:
        return [unit for unit in self.sources.units if unit.is_test]

    @property
    def stages(self) -> tuple[list[Unit], ...]:
        """Tests that try a mutant one stage after the other: the campaign of an example comes first, because its share counts."""
        if self.campaign is None:
            return (self.tests,)
        return [Unit(f"campaign/{name}", ()) for name in self.campaign.names], self.tests

    def get_folder(self, mutant: Mutant) -> Path:
        """Keeps the objects of a mutant between its trials."""
        change = f"{mutant.start} {mutant.end} {mutant.replacement}".encode()
        return self.folder / "alone" / hashlib.sha256(mutant.file.encode() + change).hexdigest()[:16]

    def get_object(self, unit: Unit) -> Path:
        return self.folder / "objects" / (unit.path.replace("/", "_") + ".o")

    def order_tests(self, files: Collection[str], stage: int = -1) -> list[Unit]:
        """Tests of a stage sorted by their likelihood to find a fault in one of `files`: most faults found so far; then name equal to the
        file name, name beginning with it, direct include, same first word, indirect include (of a campaign: the first case of each scenario);
        then most faults found in other files. Among equal tests, the fastest comes first."""

        def rank(test: Unit) -> tuple[int, int, int, int, str]:
            kills = sum(self._kills[file, test.path] for file in files)
            place = int(test.case.rpartition("-")[2]) if test.case else min(self._rank_name(test, Path(file).stem) for file in files)
            all_kills = sum(count for (_, path), count in self._kills.items() if path == test.path)
            return -kills, place, -all_kills, int(self._took_s.get(test.path, 0.0)), test.path

        return sorted(self.stages[stage], key=rank)

    def _rank_name(self, test: Unit, stem: str) -> int:
        header = f"/{stem}.hpp"
        marks = (
            test.stem == f"{stem}_test",
            test.stem.startswith(stem),
            re.search(rf'#include "[^"]*{re.escape(header)}"', self._texts[test.path]) is not None,
            test.stem.partition("_")[0] == stem.partition("_")[0],
            any(name.endswith(header) for name in self.includes[test.path]),
        )
        return next((place for place, mark in enumerate(marks) if mark), len(marks))

    def note_kill(self, file: str, test: Unit) -> None:
        """Records that `test` killed a mutant. This affects only the order of the tests, not the verdicts."""
        self._kills[file, test.path] += 1

    def find_units(self, files: Collection[str]) -> list[Unit]:
        """Units that are or include one of `files`."""
        names = {Path(file).relative_to(self.sources.layer).as_posix() for file in files}
        return [unit for unit in self.sources.units if unit.path in names or not names.isdisjoint(self.includes[unit.path])]

    def calc_timeout(self, test: Unit) -> float:
        """Time limit of a test of a mutant [s]."""
        return self.test_timeout_s + TEST_PATIENCE * self._took_s[test.path]

    def find_bound(self) -> list[Unit]:
        """Units whose definitions contain the folder of the layer: tests that call the compiler themselves."""
        place = str(self.sources.folder)
        return [unit for unit in self.sources.units if any(flag.startswith("-D") and place in flag for flag in unit.flags)]

    def get_assembler(self, unit: Unit) -> str:
        """Fingerprint of the optimised code of the original. Two benches may compute it at the same time, with the same result."""
        if unit.path not in self._assembler:
            self._assembler[unit.path] = self._bench.hash_assembler(unit)
        return self._assembler[unit.path]

    def _make_prefix(self, name: str, flags: Iterable[str]) -> Path:
        """The headers that every test includes first, compiled once."""
        header = self.folder / f"{name}.hpp"
        header.write_text("".join(f"#include {name}\n" for name in self.sources.prefix_headers), encoding="utf-8")
        prefix = header.with_suffix(".pch")
        folders = dict.fromkeys(flag for unit in (self.tests[0], *self.sources.units) for flag in unit.flags if not flag.startswith("-D"))
        argv = (COMPILER, *folders, *flags, "-x", "c++-header", str(header), "-o", str(prefix))
        _, words = _run(argv, COMPILE_TIMEOUT_S)
        if not prefix.exists():
            raise WorkError(f"{', '.join(self.sources.prefix_headers)}: no precompiled header:\n{words}")
        return prefix

    def _compile(self, unit: Unit, bench: Bench) -> str:
        depends = self.get_object(unit).with_suffix(".d")
        status, words = bench.compile(unit, self.get_object(unit), "-MD", "-MF", str(depends))
        if status != 0:
            return f"{unit.path}: {words}"
        self.includes[unit.path] = bench.read_includes(depends)
        return ""

    def _compile_below(self, unit: Unit) -> str:
        """Compiles lower layers in their original folder, because they never change. A campaign spends most of its time there."""
        speed = ("-O2",) if self.sources.has_campaign else ()
        status, words = _run((COMPILER, *unit.flags, *TEST_FLAGS, *speed, "-c", str(self.sources.root / unit.path),
                              "-o", str(self._get_object_below(unit))), COMPILE_TIMEOUT_S)  # fmt: skip
        return "" if status == 0 else f"{unit.path}: {words}"

    def _get_object_below(self, unit: Unit) -> Path:
        return self.folder / "objects" / ("below_" + unit.path.replace("/", "_") + ".o")

    def _make_archives(self) -> None:
        """All sources in libraries, from which the linker takes the objects that a test needs."""
        self._make_archive(self.archive, [self.get_object(unit) for unit in self.sources.units if not unit.is_test and unit.path != PROGRAM_UNIT])
        if self.sources.below:
            self.archives.append(self.folder / "libbelow.a")
            self._make_archive(self.archives[-1], [self._get_object_below(unit) for unit in self.sources.below])

    def _make_archive(self, archive: Path, objects: Sequence[Path]) -> None:
        status, words = _run(("ar", "rcs", str(archive), *map(str, objects)), COMPILE_TIMEOUT_S)
        if status != 0:
            raise WorkError(f"the objects of {self.sources.layer} do not go into {archive.name}:\n{words}")

    def _measure(self, test: Unit, bench: Bench) -> str:
        """Records the objects and the duration of a test. @return the failure, or an empty string."""
        taken = bench.trace_link(test)
        parts = {unit.path for unit in self.sources.units if self.get_object(unit).name in taken}
        if test.runs_program:
            parts.update(unit.path for unit in self.sources.units if not unit.is_test)
        self.links[test.path] = frozenset(parts)
        began = time.monotonic()
        problem = bench.check_original(test)
        self._took_s[test.path] = time.monotonic() - began
        return problem


class Bench:
    """A private copy of the layer in which mutants are tried."""

    def __init__(self, baseline: Baseline, name: str) -> None:
        self.baseline = baseline
        self._sources = baseline.sources
        self.folder = baseline.folder / name
        self._layer = self.folder / self._sources.layer
        self._originals: dict[str, bytes] = {}
        self._changed: set[str] = set()
        self._linked: dict[str, tuple[Path, int]] | None = None  # objects in the program of the campaign
        shutil.copytree(self._sources.folder, self._layer)

    def put(self, texts: Mapping[str, bytes]) -> None:
        """Makes the copy equal to the original except for `texts`, by path relative to the root."""
        for file in self._changed - texts.keys():
            (self.folder / file).write_bytes(self._originals[file])
        for file, text in texts.items():
            self._originals.setdefault(file, (self.folder / file).read_bytes())
            (self.folder / file).write_bytes(text)
        self._changed = set(texts)

    def compile(self, unit: Unit, output: Path, *options: str) -> tuple[int, str]:
        """@return status and message of the compiler."""
        prefix = self._include(unit, self.baseline.prefix)
        return self._run((COMPILER, *self._map(unit), *TEST_FLAGS, *prefix, *options, "-c", str(self._layer / unit.path),
                     "-o", str(output)), COMPILE_TIMEOUT_S)  # fmt: skip

    def check_original(self, test: Unit) -> str:
        """@return the failure of the test on the unchanged layer, or an empty string."""
        status, words = self.run_test(test, {}, SLOWEST_TEST_S)
        return "" if status == 0 else f"{test.path}: {words.strip()[-500:] or f'status {status}'}"

    def hash_assembler(self, unit: Unit) -> str:
        """Fingerprint of the optimised code of a unit; empty if it does not compile."""
        output = self.folder / "compared.s"
        output.unlink(missing_ok=True)
        prefix = self._include(unit, self.baseline.compared_prefix)
        self._run((COMPILER, *self._map(unit), *COMPARED_FLAGS, *prefix, "-S", str(self._layer / unit.path), "-o", str(output)),
             COMPILE_TIMEOUT_S)  # fmt: skip
        if not output.exists():
            return ""
        lines = output.read_bytes().split(b"\n")
        return hashlib.sha256(b"\n".join(line for line in lines if not line.lstrip().startswith(b".file"))).hexdigest()

    def _include(self, unit: Unit, prefix: Path) -> tuple[str, ...]:
        return ("-include-pch", str(prefix)) if unit.is_test or self._sources.has_campaign else ()

    def read_includes(self, depends: Path) -> frozenset[str]:
        """Files of the layer that a unit includes, relative to the layer."""
        words = depends.read_text(encoding="utf-8").replace("\\\n", " ").split()[1:]
        paths = [Path(word) for word in words]
        return frozenset(path.relative_to(self._layer).as_posix() for path in paths if path.is_relative_to(self._layer))

    def _map(self, unit: Unit) -> Iterable[str]:
        """Flags with paths into this copy. File names in checks must not differ between copies."""
        original = str(self._sources.folder)
        return (*(flag.replace(original, str(self._layer)) for flag in unit.flags), f"-ffile-prefix-map={self.folder}/=")

    def trace_link(self, test: Unit) -> set[str]:
        """@return names of the objects that the test links from the library of the unchanged layer."""
        if test.case:
            return set()
        _, words = self._link(test, {}, "-Wl,-t,-t")
        return set(re.findall(rf"^\({re.escape(str(self.baseline.archive))}\)(\S+)$", words, re.MULTILINE))

    def run_test(self, test: Unit, changed: Mapping[str, Path], timeout_s: float, *options: str) -> tuple[int, str]:
        """Links and runs one test. @param changed objects that replace the original objects. @param options for the test. @return status,
        and the reason if the status is not 0."""
        status, words = self._link_program(changed) if test.runs_program else (0, "")
        if status == 0 and test.case:
            return self._run_case(test.case, timeout_s)
        if status == 0:
            status, words = self._link(test, changed)
        if status != 0:
            return status, words
        enclosed = ENCLOSED if self._sources.is_enclosed else ()
        return self._run((*enclosed, str(self._program(test)), "--gtest_brief=1", *options), timeout_s, cwd=self.folder)

    def check_program(self) -> list[str]:
        """Links the program of the campaign of the unchanged layer. @return the failure, if any."""
        status, words = self._link_program({})
        return [] if status == 0 else [words]

    def _run_case(self, case: str, timeout_s: float) -> tuple[int, str]:
        assert self.baseline.campaign is not None
        return self.baseline.campaign.run(case, self.folder / PROGRAM, self.folder / "runs" / case,
                                          lambda argv: self._run(argv, timeout_s, self.folder))  # fmt: skip

    def _link_program(self, changed: Mapping[str, Path]) -> tuple[int, str]:
        """The program of the campaign, unless it was linked from the same objects before."""
        parts = {name: (path, path.stat().st_mtime_ns) for name, path in changed.items() if not name.startswith("tests/")}
        if parts == self._linked:
            return 0, ""
        self._linked = None
        status, words = self._link(Unit(PROGRAM_UNIT, ()), changed, output=self.folder / PROGRAM)
        if status == 0:
            self._linked = parts
        return status, words

    def _link(self, test: Unit, changed: Mapping[str, Path], *options: str, output: Path | None = None) -> tuple[int, str]:
        own = changed.get(test.path, self.baseline.get_object(test))
        others = [str(path) for name, path in changed.items() if not name.startswith("tests/") and name != PROGRAM_UNIT]
        libraries = LIBRARIES if test.is_test else ()
        return self._run((COMPILER, str(own), *others, *map(str, self.baseline.archives), *libraries, *self._sources.libraries, *options,
                     "-o", str(output or self._program(test))), COMPILE_TIMEOUT_S)  # fmt: skip

    def _program(self, test: Unit) -> Path:
        """One program file per test, because tests of the unchanged layer run in parallel."""
        return self.folder / (test.path.replace("/", "_") + ".program")

    def _run(self, argv: Iterable[str], timeout_s: float, cwd: Path | None = None) -> tuple[int, str]:
        if self.baseline.is_stopped:
            raise WorkError("stopped")
        return _run(argv, timeout_s, cwd)


TIMED_OUT = "timed out"


def _run(argv: Iterable[str], timeout_s: float, cwd: Path | None = None) -> tuple[int, str]:
    """Runs a program with bounded memory and file size in a separate session, which ends with the program.

    @return status and output; status 124 and TIMED_OUT if the program exceeded its time limit."""
    limited = ("/bin/sh", "-c", f'ulimit -v {MEMORY_KIB}; ulimit -c 0; ulimit -f {FILE_BLOCKS}; exec "$@"', "sh", *argv)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GTEST_")}
    if cwd is not None:
        environment["TEST_TMPDIR"] = str(cwd)  # enclosed tests of all benches have the same process id, so their files have the same names
    with subprocess.Popen(limited, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=cwd,
                          start_new_session=True, env=environment) as child:  # fmt: skip
        try:
            output, _ = child.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            _end_session(child)
            return 124, TIMED_OUT
        except BaseException:
            _end_session(child)
            raise
    return child.returncode, output.decode("utf-8", errors="replace")


def _end_session(child: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.communicate()
