# SPDX-License-Identifier: Apache-2.0
# Goal: a run starts its processes in order, ends in bounded time, names the process that failed, and leaves no process behind.
# Method: small Python programs in place of the processes; each has a UDP socket on the port of LCM and sends nothing.
from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.hil import network, processes
from mamori_tools.hil.processes import Programs, Run
from mamori_tools.hil.scenario import HilCase, list_cases
from mamori_tools.host.project import ROOT, Project
from mamori_tools.motion import load_limits, read_motion
from mamori_trace.base.errors import WorkError

PROJECT = Project(ROOT)
JOIN = ("from socket import *; s = socket(AF_INET, SOCK_DGRAM); s.setsockopt(SOL_SOCKET, SO_REUSEPORT, 1); "
        "s.bind(('127.0.0.1', 7667))")  # fmt: skip
STAY = f"{JOIN}; import time; time.sleep(60)"
END = f"{JOIN}; import time; time.sleep(1.5)"


@pytest.fixture
def case() -> HilCase:
    motion = read_motion(PROJECT.motion.with_name("reach.txt"), load_limits(PROJECT.model))
    first = list_cases(PROJECT.campaign_plan, motion)[0]
    return replace(first, arm=replace(first.arm, frames=100))


@pytest.fixture
def start(tmp_path: Path, case: HilCase, monkeypatch: pytest.MonkeyPatch):  # type: ignore[no-untyped-def]
    """Makes a run of programs with these texts; default: all join, kernel and plant end in time."""
    monkeypatch.setattr(processes, "JOIN_S", 30.0)
    monkeypatch.setattr(processes, "SPARE_S", 20.0)

    def make(texts: Mapping[str, str], changed: HilCase | None = None) -> Run:
        own = {}
        for name, text in {"plant": END, "controller": STAY, "kernel": END, "logger": STAY, **texts}.items():
            program = tmp_path / ("lcm-logger" if name == "logger" else f"my_{name}")
            program.write_text(f"#!{sys.executable}\n{textwrap.dedent(text)}\n", encoding="utf-8")
            program.chmod(0o755)
            own[name] = str(program)
        monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
        (tmp_path / "out").mkdir()
        del own["logger"]
        return Run(Programs(tmp_path, PROJECT.model, tmp_path / "motion.txt", own), changed or case, tmp_path / "out")

    return make


def list_left(folder: Path) -> list[str]:
    """Processes that run a program in `folder`."""
    left = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = path.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if str(folder) in line and int(path.parent.name) != os.getpid():
            left.append(line)
    return left


@pytest.mark.verifies("SWR-HIL-009", technique="requirements_based")
def test_a_complete_run_has_no_problem_and_leaves_no_process(start, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    facts = start({}).run()

    assert facts.problem == ""
    assert facts.wall_s >= 1.5
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-010", technique="requirements_based")
def test_a_program_of_the_user_gets_network_folder_and_motion(start, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    names = ("LCM_DEFAULT_URL", "MAMORI_HIL_OUT", "MAMORI_HIL_FRAMES", "MAMORI_HIL_MOTION")
    start({"kernel": f"import os; print(*(os.environ[name] for name in {names}))\n{END}"}).run()

    written = (tmp_path / "out" / "kernel.txt").read_text(encoding="utf-8").split()
    assert written == [network.URL, str(tmp_path / "out"), "100", str(tmp_path / "motion.txt")]


@pytest.mark.verifies("SWR-HIL-009", technique="fault_injection", polarity="violation")
def test_a_process_that_ends_before_the_run_is_named_with_its_last_line(start, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(WorkError, match="the plant ended with status 3 before the run: no route"):
        start({"plant": "import sys; print('hello'); print('no route'); sys.exit(3)"}).run()
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-009", technique="fault_injection", polarity="violation")
def test_a_process_that_does_not_join_the_network_is_named(start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    run = start({"controller": "import time; time.sleep(60)"})
    monkeypatch.setattr(processes, "JOIN_S", 0.5)
    with pytest.raises(WorkError, match=r"the controller did not join udpm.*LCM_DEFAULT_URL"):
        run.run()
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-009", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("name", "text", "problem"), [
    ("kernel", "import sys; sys.exit(1)", "the kernel ended with status 1"),
    ("plant", f"{END}; import sys; sys.exit('diverged')", "the plant ended with status 1: diverged"),
    ("controller", END, "the controller ended early with status 0"),
])  # fmt: skip
def test_a_process_that_fails_during_the_run_is_named(name: str, text: str, problem: str, start, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    texts = {"kernel": f"{JOIN}; import time; time.sleep(8)", "plant": f"{JOIN}; import time; time.sleep(8)", name: text}

    assert start(texts).run().problem == problem
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-009", technique="fault_injection", polarity="violation")
def test_a_run_that_does_not_end_is_stopped(start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    stubborn = f"import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); {STAY}"
    run = start({"kernel": stubborn, "plant": END})
    monkeypatch.setattr(processes, "SPARE_S", 0.5)
    monkeypatch.setattr(processes, "STOP_S", 0.3)

    assert "kernel" in (problem := run.run().problem)
    assert problem.endswith("did not end in time")
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-009", technique="fault_injection", polarity="violation")
def test_an_interrupted_run_leaves_no_process(start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    def interrupt(self: Run) -> str:
        assert [child.poll() for child in self._children.values()] == [None] * 4
        raise KeyboardInterrupt

    monkeypatch.setattr(Run, "_wait", interrupt)
    with pytest.raises(KeyboardInterrupt):
        start({"plant": STAY, "kernel": STAY}).run()
    assert list_left(tmp_path) == []


@pytest.mark.verifies("SWR-HIL-009", technique="requirements_based")
def test_only_the_planned_process_is_killed_at_its_instant(start, case: HilCase, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    killed = replace(case, kill="controller", kill_at_s=0.1)
    facts = start({"plant": f"{END}; time.sleep(0.5)"}, killed).run()

    assert facts.problem == ""
    assert facts.wall_s >= 0.5


@pytest.mark.skipif(os.geteuid() != 0, reason="a network namespace needs root")
@pytest.mark.verifies("SWR-HIL-007", technique="requirements_based")
def test_the_network_has_only_a_loopback_device_with_a_multicast_route() -> None:
    text = "from mamori_tools.hil import network; network.enter_own_network(); print(*(open(f'/proc/net/{name}').read() for name in ('dev', 'route')))"
    done = subprocess.run([sys.executable, "-P", "-c", text], capture_output=True, text=True, check=False)
    if "Operation not permitted" in done.stderr:
        pytest.skip("this host denies a network namespace")

    assert done.returncode == 0, done.stderr
    devices = [line.split(":")[0].strip() for line in done.stdout.splitlines() if ":" in line]
    routes = [line.split()[:2] for line in done.stdout.splitlines() if line.split() and line.split()[0] == "lo"]
    assert devices == ["lo"]
    assert ["lo", "000000E0"] in routes


@pytest.mark.verifies("SWR-HIL-007", technique="fault_injection", polarity="violation")
def test_a_namespace_that_the_system_refuses_ends_with_status_3() -> None:
    text = """
from mamori_tools.hil import network
network.CLONE_NEWNET |= 1  # a flag that unshare() does not have
try:
    network.enter_own_network()
except Exception as error:
    print(type(error).__name__, error)
"""
    done = subprocess.run([sys.executable, "-P", "-c", text], capture_output=True, text=True, check=False)

    assert done.stdout.startswith("MissingError hil: a network namespace cannot be made (")
