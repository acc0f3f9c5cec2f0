# SPDX-License-Identifier: Apache-2.0
"""Counts instructions with callgrind: one operation of the program `mamori_exact`, repeated many times.

@satisfies SWR-BEN-006, SWR-BEN-007, SWR-TIM-032      Design: docs/design/bench.md#exact-counts
"""

from __future__ import annotations

import json
import re
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError

REPETITIONS = 1000
OPTIONS = ("--tool=callgrind", "--collect-atstart=no", "--toggle-collect=measured_*", "--zero-before=begin_counting")

# In callgrind notation, without arguments and version.
HEAP = re.compile(r"^(malloc|calloc|realloc|free|cfree|memalign|aligned_alloc|posix_memalign|pvalloc|valloc|reallocarray"
                  r"|operator (new|delete)(\[\])?|_Zn[wa].*|_Zd[la].*|sbrk|brk|mmap|mmap64)$")  # fmt: skip

_NAME = re.compile(r"^c?fn=\((\d+)\)(?: (.*))?$")
_COST = re.compile(r"^[+\-*\d]\S* (\d+)$")


@dataclass(frozen=True)
class Profile:
    """callgrind's record of the repetitions: instructions, and the names of the executed functions."""

    instructions: int
    functions: frozenset[str]

    def calc_count(self, repetitions: int) -> int:
        """Instructions of one operation. @raise WorkError if the repetitions differ."""
        count, rest = divmod(self.instructions, repetitions)
        if rest:
            raise WorkError(f"{self.instructions} instructions are not {repetitions} times the same number; the operation "
                            "does not do the same work each time, so it has no exact count")  # fmt: skip
        return count

    @property
    def heap_functions(self) -> list[str]:
        """Heap functions among the executed functions, sorted."""
        return sorted(name for name in self.functions if HEAP.match(_strip(name)))


def _strip(name: str) -> str:
    """Removes the text after the name, as in `operator new(unsigned long)` and `malloc@@GLIBC_2.2`, and the mark of the part file."""
    return re.sub(r"('\d+)?$", "", name.partition("(")[0].partition("@")[0])


def parse_profile(text: str) -> Profile:
    """@param text a callgrind.out file. @raise WorkError if it is not one."""
    names: dict[str, str] = {}
    ran: set[str] = set()
    total = current = None
    is_call = False
    for line in text.splitlines():
        if found := _NAME.match(line):
            number, name = found.groups()
            if name:
                names[number] = name
            if line.startswith("fn="):
                current = number
        elif line.startswith("calls="):
            is_call = True  # the next line contains the cost of the callee
        elif line.startswith("summary:"):
            total = int(line.split()[1])
        elif cost := _COST.match(line):
            if not is_call and current is not None and int(cost.group(1)) > 0:
                ran.add(current)
            is_call = False
    if total is None:
        raise WorkError("callgrind wrote no summary; is this its output?")
    return Profile(total, frozenset(names.get(number, f"({number})") for number in ran))


def make_step_options(function: str, out: Path) -> list[str]:
    """Options with which valgrind counts each single call of `function` and nothing else; list_totals() then reads `out`."""
    return ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--toggle-collect={function}", f"--dump-after={function}",
            "--combine-dumps=yes", "--dump-line=no", f"--callgrind-out-file={out}"]  # fmt: skip


def list_totals(path: Path) -> list[int]:
    """Instructions of each call, in order, from a file for make_step_options(). A dump follows each call, and an empty dump ends the file.
    @raise WorkError if the file is truncated or has other content."""
    totals, is_trigger = [], []
    try:
        with path.open(encoding="utf-8", errors="replace") as lines:
            for line in lines:
                if line.startswith("totals: "):
                    totals.append(int(line.split()[1]))
                elif line.startswith("desc: Trigger: "):
                    is_trigger.append("--dump-after=" in line)
    except (OSError, ValueError, IndexError) as error:
        raise WorkError(f"the output of callgrind cannot be read: {error}") from error
    if not totals or len(totals) != len(is_trigger) or is_trigger[-1] or not all(is_trigger[:-1]) or totals[-1] != 0:
        raise WorkError(f"the output of callgrind is not one dump for each call and an empty one at the end ({len(totals)} dumps)")
    return totals[:-1]


def run_callgrind(program: Path, operation: str, repetitions: int = REPETITIONS) -> Profile:
    """@raise WorkError if valgrind is missing or the program fails."""
    with tempfile.TemporaryDirectory(prefix="mamori-bench-") as folder:
        out = Path(folder) / "callgrind.out"
        argv = ["valgrind", *OPTIONS, f"--callgrind-out-file={out}", str(program), operation, str(repetitions)]
        try:
            done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        except OSError as error:
            raise WorkError(f"valgrind cannot be run ({error.strerror}); install valgrind") from error
        if done.returncode != 0 or not out.exists():
            tail = " ".join(done.stderr.split()[-30:])
            raise WorkError(f"callgrind could not run {operation}: {tail}")
        return parse_profile(out.read_text(encoding="utf-8", errors="replace"))


def run_profiles(program: Path, operations: Iterable[str], tell: Callable[[str], None]) -> dict[str, Profile]:
    """One profile for each of `operations`."""
    profiles = {}
    for operation in operations:
        tell(f"counting {operation}")
        profiles[operation] = run_callgrind(program, operation)
    return profiles


def makes_system_calls(program: Path, operation: str, repetitions: int = REPETITIONS) -> bool:
    """Runs the operation in a process that the operating system kills at its first system call.

    @return whether it was killed. @raise WorkError if it failed for another reason.
    """
    done = subprocess.run([str(program), operation, str(repetitions), "--sealed"], capture_output=True, text=True,
                          check=False, stdin=subprocess.DEVNULL)  # fmt: skip
    if done.returncode == -signal.SIGSYS:
        return True
    if done.returncode != 0:
        raise WorkError(f"{operation}, sealed, ended with status {done.returncode}: {done.stderr.strip()}")
    return False


def ask_about(program: Path) -> dict[str, object]:
    """Operations, compiler and C library of the program."""
    done = subprocess.run([str(program), "--about"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)
