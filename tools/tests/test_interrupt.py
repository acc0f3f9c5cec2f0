# SPDX-License-Identifier: Apache-2.0
# Goal: Ctrl-C at any step gives status 130 and one line, ends the children, leaves no half-written file, and the next run works.
# Method: a plan of real steps is stopped in each of them, and each light command at a counted file operation. The signal goes to the
# complete process group, as from a terminal, or only to the command.
from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import psutil
import pytest

from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.project_lock import LOCK

PLAN = """
import sys
from pathlib import Path
from mamori_trace.base.text_file import write_text
from mamori_trace.base.project_lock import hold_lock
from mamori_tools.command import main as command
from mamori_tools.host.process import end_children
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context, Step, all_passed, run_steps

folder, stopped_in = Path(sys.argv[1]), sys.argv[2]
project = Project(folder)
project.junit.mkdir(parents=True, exist_ok=True)
waiting = f"echo $$ >{folder}/pid; sleep 60 & wait"
half = '<testsuite><testcase name="a">'

def shell(name, text):
    return ("sh", "-c", f"{waiting}" if name == stopped_in else text)

def write(context, tick, log):
    if stopped_in == "function":
        with open(folder / "pid", "w") as file:
            print("0", file=file)
        while True:
            write_text(project.evidence / "figures.json", "x" * 5_000_000)
    write_text(project.evidence / "figures.json", "{}")

def results(name):
    text = f"printf '%s' '{half}' >{{result}}; " + (waiting if name == stopped_in else "printf '%s' '</testcase></testsuite>' >>{result}")
    return Step(name, (("sh", "-c", text),), result=f"{name}.xml")

STEPS = [Step("build", (shell("build", "true"),)), results("tests"), Step("two", (shell("two", "true"), shell("second", "true"))),
         Step("function", function=write), results("last")]

def run(argv):
    with hold_lock(folder, "plan"):
        try:
            return 0 if all_passed(run_steps(STEPS, Context(project, 1))) else 1
        except KeyboardInterrupt:
            end_children()
            raise

command.run = run
sys.exit(command.main([]))
"""
TIMEOUT_S = 20.0
LIGHT = [
    "e2e --profile 4 --length 4096 --rate 100 --pe 0.01",
    "trace check --no-cache --root {folder}",
    "trace report --allow-missing --root {folder}",
    "trace export csv --root {folder} --out {folder}/items.csv",
    "trace review --all --by me --root {folder}",
    "mutate --list",
    "new {folder}/robot",
]
# Runs a command, prints its number of file operations, and is stopped before the operation with a given number. The work is then not
# finished, for any load of the host.
COUNTED = """
import os, signal, sys

place, done = int(sys.argv.pop(1)), 0

def count(event, arguments):
    global done
    if event in ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.chmod", "os.scandir", "os.listdir"):
        done += 1
        if done == place:
            signal.raise_signal(signal.SIGINT)

sys.addaudithook(count)
from mamori_tools.command.main import main
status = main()
if not place:
    print(done, file=sys.stderr)
sys.exit(status)
"""
PARTS = (0.1, 0.6, 0.9, 0.99)


def list_session(leader: int) -> list[psutil.Process]:
    """Running processes of a session."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.NoSuchProcess, ProcessLookupError):
            if process.status() != psutil.STATUS_ZOMBIE and os.getsid(process.pid) == leader:
                found.append(process)
    return found


def start(*words: str) -> subprocess.Popen[str]:
    """Starts Python like the launcher: a signal stays pending until the command accepts it."""
    return subprocess.Popen(["env", "--block-signal=INT,TERM", sys.executable, "-P", *words], stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True, start_new_session=True, cwd=ROOT)  # fmt: skip


def stop(process: subprocess.Popen[str], is_group: bool) -> tuple[int, str]:
    """@return exit status and standard error; checks that none of its processes is running."""
    (os.killpg if is_group else os.kill)(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=TIMEOUT_S)
    deadline = time.monotonic() + TIMEOUT_S  # a part of the launcher without remaining work ends by itself
    while list_session(process.pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert list_session(process.pid) == []
    return process.returncode, said


def list_unfinished(folder: Path) -> list[Path]:
    return [*folder.rglob("*.part"), *folder.rglob(LOCK.name)]


@pytest.mark.parametrize("is_group", [False, True], ids=["alone", "group"])
@pytest.mark.parametrize("step", ["build", "tests", "two", "second", "function", "last"])
@pytest.mark.verifies("SWR-CLI-045", technique="fault_injection")
def test_a_plan_that_is_stopped_in_any_step_leaves_nothing_half_written_and_runs_again(step: str, is_group: bool, tmp_path: Path) -> None:
    runner = start("-c", PLAN, str(tmp_path), step)
    deadline = time.monotonic() + TIMEOUT_S
    while not ((tmp_path / "pid").exists() and (tmp_path / "pid").read_text().strip()):
        assert time.monotonic() < deadline, "the step did not start"
        time.sleep(0.02)
    time.sleep(0.1)

    status, said = stop(runner, is_group)

    assert (status, said.strip()) == (130, "mamori: stopped; no report was written")
    assert list_unfinished(tmp_path) == []
    for path in Project(tmp_path).junit.iterdir():
        ElementTree.parse(path)
    figures = Project(tmp_path).evidence / "figures.json"
    assert not figures.exists() or figures.stat().st_size in (2, 5_000_000)

    again = start("-c", PLAN, str(tmp_path), "")

    assert again.communicate(timeout=TIMEOUT_S)[1] == ""
    assert again.returncode == 0
    assert sorted(path.name for path in Project(tmp_path).junit.iterdir()) == ["last.xml", "tests.xml"]


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sample")
    done = start("-m", "mamori_tools.command", "trace", "init", "--root", str(folder))
    assert done.communicate(timeout=TIMEOUT_S)[1] == ""
    evidence = folder / "build" / "host-release" / "evidence" / "junit"
    evidence.mkdir(parents=True)
    (evidence / "a.xml").write_text('<testsuite><testcase name="a"/></testsuite>', encoding="utf-8")
    return folder


def run_counted(words: str, place: int, folder: Path) -> tuple[int, str]:
    """@param place number of the operation that is interrupted; 0: none. @return status and standard error."""
    process = start("-c", COUNTED, str(place), *words.format(folder=folder).split())
    _, said = process.communicate(timeout=TIMEOUT_S)
    assert list_session(process.pid) == []
    return process.returncode, said


@pytest.mark.parametrize("words", LIGHT, ids=lambda words: " ".join(words.split()[:2]))
@pytest.mark.verifies("SWR-CLI-045", technique="fault_injection")
def test_a_light_command_that_is_stopped_at_any_operation_leaves_nothing_half_written(words: str, sample: Path, tmp_path: Path) -> None:
    _, said = run_counted(words, 0, shutil.copytree(sample, tmp_path / "whole"))
    total = int(said.splitlines()[-1])
    for part in PARTS:
        folder = shutil.copytree(sample, tmp_path / f"part-{part}")
        before = set(folder.rglob("*"))

        status, said = run_counted(words, int(total * part), folder)

        assert (status, said.strip().splitlines()[-1:]) == (130, ["mamori: stopped; no report was written"]), (part, said)
        assert "Traceback" not in said
        assert list_unfinished(folder) == []
        assert [path for path in set(folder.rglob("*")) - before if path.name.startswith(".")] == []


@pytest.mark.parametrize("is_group", [False, True], ids=["alone", "group"])
@pytest.mark.parametrize("first_s", [0.01, 0.03, 0.05])
@pytest.mark.verifies("SWR-CLI-045", technique="fault_injection")
def test_a_signal_to_the_launcher_or_to_python_as_it_starts_gives_no_traceback(first_s: float, is_group: bool) -> None:
    """Status 1 is that of the command if the signal came after its work. Bash 5.2 treats one of some hundred signals as a syntax error of
    the trap (status 2). One such status in this row is an error of bash; more are errors of the script."""
    ends = []
    for number in range(8):
        process = subprocess.Popen([str(ROOT / "mamori"), *"e2e --profile 4 --length 4096 --rate 100 --pe 0.01".split()],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)  # fmt: skip
        time.sleep(first_s + number * 0.0025)

        status, said = stop(process, is_group)

        assert "Traceback" not in said
        ends.append(2 if status == 2 and "interrupt trap" in said else 130 if status in (130, 1, -signal.SIGINT) else status)

    assert set(ends) <= {2, 130} and ends.count(2) <= 1, ends


@pytest.mark.verifies("SWR-CLI-045", technique="boundary_values")
def test_a_signal_that_came_before_python_could_listen_is_not_lost() -> None:
    code = """
import os, signal, sys
from mamori_tools.command.main import main
signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
os.kill(os.getpid(), signal.SIGINT)
sys.exit(main(["mutate", "--list"]))
"""
    process = start("-c", code)

    said = process.communicate(timeout=TIMEOUT_S)[1]

    assert (process.returncode, said.strip()) == (130, "mamori: stopped; no report was written")


@pytest.mark.verifies("SWR-CLI-045", technique="fault_injection")
def test_a_signal_that_comes_in_a_destructor_is_not_lost() -> None:
    code = """
import os, signal, sys, time
from mamori_tools.command import main as command

class Closed:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.01)

def run(argv):
    Closed()
    time.sleep(10)
    return 0

command.run = run
sys.exit(command.main([]))
"""
    process = start("-c", code)

    said = process.communicate(timeout=TIMEOUT_S)[1]

    assert (process.returncode, said.strip()) == (130, "mamori: stopped; no report was written")
