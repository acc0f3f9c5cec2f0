# SPDX-License-Identifier: Apache-2.0
# Goal: a stopped command ends its children, including grandchildren and children that ignore signals, and reports that in one line.
# Method: a real process that runs a step. A signal stops it as soon as the child of the step runs.
from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

RUNNER = """
import sys
from pathlib import Path
from mamori_tools.command import main as command
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context, Step, run_steps

folder, text = Path(sys.argv[1]), sys.argv[2]
command.run = lambda argv: run_steps([Step("work", (("sh", "-c", text),))], Context(Project(folder), 1)) and 0
sys.exit(command.main([]))
"""
TIMEOUT_S = 20.0


def is_running(pid: int) -> bool:
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def stop_while_running(folder: Path, text: str, number: signal.Signals) -> tuple[int, str, int]:
    """@return exit status, text on standard error, process id of the grandchild."""
    runner = subprocess.Popen([sys.executable, "-P", "-c", RUNNER, str(folder), text], stderr=subprocess.PIPE,
                              stdout=subprocess.DEVNULL, text=True)  # fmt: skip
    pid_file = folder / "pid"
    deadline = time.monotonic() + TIMEOUT_S
    while not (pid_file.exists() and pid_file.read_text().strip()):
        assert time.monotonic() < deadline, "the step did not start"
        time.sleep(0.02)
    runner.send_signal(number)
    _, said = runner.communicate(timeout=TIMEOUT_S)
    return runner.returncode, said, int(pid_file.read_text())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.verifies("SWR-CLI-008")
def test_signal_ends_the_children_and_gives_130(tmp_path: Path, number: signal.Signals) -> None:
    status, said, child = stop_while_running(tmp_path, f"sleep 60 & echo $! >{tmp_path}/pid; wait", number)

    assert status == 130
    assert said.strip() == "mamori: stopped; no report was written"
    assert not is_running(child)


@pytest.mark.verifies("SWR-CLI-008", technique="fault_injection", polarity="violation")
def test_child_that_ignores_the_request_is_killed(tmp_path: Path) -> None:
    text = f"trap '' TERM INT; echo $$ >{tmp_path}/pid; while :; do sleep 0.1; done"

    status, _, child = stop_while_running(tmp_path, text, signal.SIGINT)

    assert status == 130
    assert not is_running(child)


@pytest.mark.verifies("SWR-CLI-008", technique="error_guessing")
def test_signal_is_heard_where_the_parent_shell_ignores_it(tmp_path: Path) -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        status, _, _ = stop_while_running(tmp_path, f"echo $$ >{tmp_path}/pid; exec sleep 60", signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)

    assert status == 130
