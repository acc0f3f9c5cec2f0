# SPDX-License-Identifier: Apache-2.0
"""Starts, supervises and stops plant, controller, kernel and logger of one run. Only own children are ended, by their process id.

@satisfies SWR-HIL-009, SWR-HIL-010      Design: docs/design/safe_arm.md#hardware-in-the-loop
"""

from __future__ import annotations

import contextlib
import os
import shlex
import shutil
import subprocess
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO

from mamori_tools.campaign.arm.judge import describe_faults
from mamori_tools.hil.network import URL, has_joined, wait_until
from mamori_tools.hil.scenario import HilCase
from mamori_trace.base.errors import InputError, WorkError

LINK_PRIORITY = 60
"""SCHED_FIFO priority of processes of the user; that of the shipped programs is the same (hil_program.cpp)."""
JOIN_S = 20.0
"""Time for a process to join the LCM network [s]."""
SPARE_S = 20.0
"""Wall time of a run beyond its major frames [s]; afterwards it is stopped."""
STOP_S = 2.0
LOG = "lcm.log"
TAIL_CHARACTERS = 200


@dataclass(frozen=True)
class Programs:
    """`folder` has the shipped programs; `own` replaces processes by commands of the user."""

    folder: Path
    model: Path
    motion: Path
    own: Mapping[str, str] = field(default_factory=dict)

    def check(self) -> None:
        """@raise InputError if a program is missing."""
        for name in ("plant", "controller", "kernel", "virtual"):
            path = self.get_shipped(name)
            if name not in self.own and not os.access(path, os.X_OK):
                raise InputError("no program that can be run; build it first (./mamori build)", path)
        for name, command in self.own.items():
            try:
                words = shlex.split(command)
            except ValueError as error:
                raise InputError(f"hil: --{name}: {error}; write a command as in a shell") from error
            if not words or shutil.which(words[0]) is None:
                raise InputError(f"hil: --{name}: '{words[0] if words else command}' is not a program that can be run; specify its path")

    def get_shipped(self, name: str) -> Path:
        return self.folder / f"hil_{name}"

    def make_command(self, name: str, case: HilCase, out: Path) -> list[str]:
        if name in self.own:
            return shlex.split(self.own[name])
        command = [str(self.get_shipped(name)), "--model", str(self.model), "--motion", str(self.motion), "--out", str(out),
                   "--frames", str(case.frames), "--seed", str(case.arm.seed)]  # fmt: skip
        if case.arm.fault is not None or case.arm.latent:
            command += ["--fault", describe_faults(case.arm)]
        if case.error:
            command += ["--link", case.link, "--error", case.error]
        return command


@dataclass(frozen=True)
class RunFacts:
    """What the supervision saw. `problem`: why the run is not complete; empty if it is. `steal_s`: processor time that the hypervisor took."""

    problem: str
    wall_s: float
    steal_s: float


class Run:
    """One run. As a context manager, it leaves no process behind."""

    def __init__(self, programs: Programs, case: HilCase, out: Path) -> None:
        self._programs = programs
        self._case = case
        self._out = out
        self._children: dict[str, subprocess.Popen[bytes]] = {}
        self._logs: list[BinaryIO] = []

    def run(self) -> RunFacts:
        """Runs the case to its end. @raise WorkError if a process cannot be started or does not join the network."""
        steal = read_steal_s()
        start = time.monotonic()
        with self._stop_at_end():
            self._start("logger", ["lcm-logger", "--quiet", str(self._out / LOG)])
            for name in ("plant", "controller"):
                self._start(name, self._programs.make_command(name, self._case, self._out))
            for name in ("logger", "plant", "controller"):
                self._wait_until_joined(name)
            time.sleep(0.05)  # from the socket to the subscription
            for name in self._programs.own:
                if name in self._children:
                    raise_priority(self._children[name].pid)
            self._start("kernel", self._programs.make_command("kernel", self._case, self._out))
            problem = self._wait()
        return RunFacts(problem, time.monotonic() - start, read_steal_s() - steal)

    def _start(self, name: str, command: list[str]) -> None:
        log = (self._out / f"{name}.txt").open("wb")
        self._logs.append(log)
        variables = {**os.environ, "LCM_DEFAULT_URL": URL, "MAMORI_HIL_OUT": str(self._out), "MAMORI_HIL_FRAMES": str(self._case.frames),
                     "MAMORI_HIL_MOTION": str(self._programs.motion)}  # fmt: skip
        try:
            child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, env=variables)
        except OSError as error:
            raise WorkError(f"the {name} cannot be started: {command[0]}: {error.strerror}") from error
        self._children[name] = child

    def _wait_until_joined(self, name: str) -> None:
        child = self._children[name]
        wait_until(lambda: child.poll() is not None or has_joined(child.pid), JOIN_S)
        if child.poll() is not None:
            raise WorkError(f"the {name} ended with status {child.returncode} before the run{self._read_tail(name)}")
        if not has_joined(child.pid):
            raise WorkError(f"the {name} did not join {URL} within {JOIN_S:g} s; it must open the URL of the variable LCM_DEFAULT_URL")

    def _wait(self) -> str:
        """Waits for kernel and plant; kills the process of the case at its instant. @return the problem."""
        started = time.monotonic()
        end = started + self._case.frames / 1000.0 + SPARE_S
        victim = self._case.kill
        is_killed = not victim
        awaited = {"kernel", "plant"} - {victim}
        while time.monotonic() < end:
            if not is_killed and time.monotonic() - started >= self._case.kill_at_s:
                self._children[victim].kill()
                is_killed = True
            for name in [name for name in awaited if self._children[name].poll() is not None]:
                awaited.discard(name)
                if self._children[name].returncode != 0:
                    return f"the {name} ended with status {self._children[name].returncode}{self._read_tail(name)}"
            if victim != "controller" and self._children["controller"].poll() is not None:
                return f"the controller ended early with status {self._children['controller'].returncode}{self._read_tail('controller')}"
            if not awaited:
                return ""
            time.sleep(0.005)
        return f"the {' and the '.join(sorted(awaited))} did not end in time"

    def _read_tail(self, name: str) -> str:
        text = (self._out / f"{name}.txt").read_text(encoding="utf-8", errors="replace").strip()
        return f": {text.splitlines()[-1][:TAIL_CHARACTERS]}" if text else ""

    @contextlib.contextmanager
    def _stop_at_end(self) -> Iterator[None]:
        try:
            yield
        finally:
            for child in self._children.values():
                if child.poll() is None:
                    child.terminate()
            end = time.monotonic() + STOP_S
            for child in self._children.values():
                with contextlib.suppress(subprocess.TimeoutExpired):
                    child.wait(max(0.0, end - time.monotonic()))
                if child.poll() is None:
                    child.kill()
                    child.wait()
            for log in self._logs:
                log.close()


def raise_priority(pid: int) -> None:
    """Gives all threads of a process of the user the priority of the shipped programs. A refusal has no effect."""
    with contextlib.suppress(OSError):
        for thread in Path(f"/proc/{pid}/task").iterdir():
            os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(LINK_PRIORITY))


def read_steal_s() -> float:
    """Processor time that the hypervisor took from this host since it started [s]."""
    ticks = int(Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[8])
    return ticks / os.sysconf("SC_CLK_TCK")
