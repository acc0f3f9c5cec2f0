# SPDX-License-Identifier: Apache-2.0
# Goal: the launcher script installs what is missing, says in one line why it cannot, and answers wrong words without installing.
# Method: a copy of the script in an empty folder; package manager, sudo and python3 are scripts first in PATH that write down
# how they were called. What is installed is the content of a file.
from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from mamori.verification.command.main import make_parser
from mamori.verification.command.project import ROOT

PACKAGES_OF_DEMO = ("python3 python3-venv g++ cmake ninja-build libsimbody-dev liborocos-kdl-dev libeigen3-dev "
                    "libyaml-cpp-dev libgtest-dev relacy-dev libcli11-dev nlohmann-json3-dev ").split()  # fmt: skip

TOOLS = {
    "id": 'echo "${FAKE_UID:-0}"',
    "dpkg": "exit 0",
    "dpkg-query": 'for p in "$@"; do grep -qxF -e "$p" "$BOX/installed" && echo "installed $p"; done; exit 0',
    "apt-get": 'echo "apt-get $*" >>"$BOX/calls"\n'
    'if [ "$2" = "${FAKE_APT_FAILS:-}" ]; then echo "E: the mirror is down"; exit 100; fi\n'
    'if [ -n "${FAKE_APT_HANGS:-}" ]; then echo $$ >"$BOX/apt.pid"; exec sleep 60; fi\n'
    'for p in "$@"; do echo "$p" >>"$BOX/installed"; done',
    "sudo": 'echo "sudo $*" >>"$BOX/calls"; [ -n "${FAKE_SUDO:-}" ] || exit 1; shift; exec "$@"',
    "python3": '[ "$1" = --version ] && { echo Python 3.11.2; exit 0; }\n'
    'mkdir -p "$3/bin"; cp "$BOX/bin/venv-python" "$3/bin/python"; echo venv >>"$BOX/calls"',
    "venv-python": 'echo "python $*" >>"$BOX/calls"\n'
    'case "$*" in *pip*) exit "${FAKE_PIP:-0}";; *) echo "packages: $MAMORI_PACKAGES" >>"$BOX/calls";; esac',
}


@dataclass
class Box:
    """A machine in a folder."""

    folder: Path

    def __post_init__(self) -> None:
        (self.folder / "bin").mkdir()
        for name, text in TOOLS.items():
            tool = self.folder / "bin" / name
            tool.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
            tool.chmod(0o755)
        for name in ("mamori", "requirements.lock", "pyproject.toml"):
            shutil.copy(ROOT / name, self.folder)
        self.install()

    def install(self, *packages: str) -> None:
        (self.folder / "installed").write_text("".join(f"{name}\n" for name in packages), encoding="utf-8")

    def environment(self, **settings: str) -> dict[str, str]:
        return {**os.environ, "BOX": str(self.folder), "PATH": f"{self.folder}/bin:{os.environ['PATH']}", **settings}

    def run(self, *words: str, **settings: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([str(self.folder / "mamori"), *words], env=self.environment(**settings), text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, check=False, timeout=60)  # fmt: skip

    def take_calls(self) -> list[str]:
        path = self.folder / "calls"
        calls = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        path.unlink(missing_ok=True)
        return calls


@pytest.fixture
def box(tmp_path: Path) -> Box:
    return Box(tmp_path)


@pytest.mark.verifies("SWR-CLI-001")
def test_only_what_is_missing_is_installed_before_the_command_runs(box: Box) -> None:
    box.install("python3", "cmake", "g++")

    done = box.run("demo", "--jobs", "3")

    missing = " ".join(name for name in PACKAGES_OF_DEMO if name not in ("python3", "cmake", "g++"))
    calls = box.take_calls()
    assert done.returncode == 0, done.stderr
    assert f"apt-get -q -y --no-install-recommends install {missing}" in calls
    assert calls[-2:] == ["python -P -m mamori.verification.command demo --jobs 3",
                          f"packages: {' '.join(PACKAGES_OF_DEMO)}"]  # fmt: skip


@pytest.mark.verifies("SWR-CLI-001")
def test_second_run_installs_nothing(box: Box) -> None:
    assert box.run("test").returncode == 0
    box.take_calls()

    done = box.run("test")

    assert done.returncode == 0
    assert [call.split()[0] for call in box.take_calls()] == ["python", "packages:"]
    assert done.stdout == ""


@pytest.mark.verifies("SWR-CLI-001", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("words", "wanted", "unwanted"),
    [(("trace", "check"), "python3-venv", "cmake"), (("log", "run.rec"), "python3-venv", "cmake"), (("e2e",), "python3-venv", "cmake"), (("build",), "cmake", "cppcheck"), (("test",), "cppcheck", "strace"),
     (("build", "--preset", "host-coverage"), "clang-19", "git"), (("bench",), "valgrind", "cppcheck"),
     (("mutate",), "clang-19", "git"), (("fuzz",), "libclang-rt-19-dev", "git"),
     (("prove", "safe-state"), "spin", "cppcheck"), (("test",), "z3", "strace"), (("demo",), "cmake", "spin"),
     (("demo",), "libsimbody-dev", "graphviz"), (("verify",), "graphviz", "cppcheck"),
     (("timing", "x", "--load"), "stress-ng", "valgrind"), (("timing", "x"), "cmake", "stress-ng"),
     (("timing", "x", "--", "--load"), "cmake", "stress-ng"),
     (("cost", "x"), "valgrind", "stress-ng"), (("bench", "--list"), "python3-venv", "valgrind"), (("test",), "valgrind", "libboost-dev"),
     (("table", "t.json", "--text"), "python3-venv", "graphviz"), (("table", "t.json", "--out", "d"), "graphviz", "cmake"),
     (("trace", "check"), "python3-venv", "git"), (("trace", "impact", "HEAD"), "git", "cmake"),
     (("trace", "verify", "b.tar"), "openssh-client", "cmake"), (("test",), "openssh-client", "strace")],
)  # fmt: skip
def test_each_command_needs_its_groups_only(box: Box, words: tuple[str, ...], wanted: str, unwanted: str) -> None:
    box.run(*words)

    installed = next(call for call in box.take_calls() if " install " in call).split()
    assert wanted in installed
    assert unwanted not in installed


@pytest.mark.verifies("SWR-CLI-002")
def test_sudo_without_password_is_used(box: Box) -> None:
    assert box.run("trace", "check", FAKE_UID="1000", FAKE_SUDO="yes").returncode == 0

    assert "apt-get -q -y --no-install-recommends install python3 python3-venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-002", technique="fault_injection", polarity="violation")
def test_without_the_right_to_install_one_line_names_the_packages(box: Box) -> None:
    box.install("python3", "g++")

    done = box.run("demo", FAKE_UID="1000")

    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    for name in set(PACKAGES_OF_DEMO) - {"python3", "g++"}:
        assert f" {name}" in done.stderr
    assert not any(call.startswith(("apt-get", "python")) for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-002", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("step", "settings"), [("update", {"FAKE_APT_FAILS": "update"}), ("install", {"FAKE_APT_FAILS": "-y"})])
def test_failing_package_manager_is_named_with_its_log(box: Box, step: str, settings: dict[str, str]) -> None:
    done = box.run("demo", **settings)

    log = box.folder / "build" / "log" / "packages.log"
    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert str(log) in done.stderr
    assert "E: the mirror is down" in log.read_text(encoding="utf-8")
    assert not any(call.startswith("python") for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-002", technique="equivalence_classes", polarity="violation")
def test_machine_without_apt_is_told_what_it_needs(box: Box) -> None:
    for name in ("apt-get", "dpkg-query", "sudo"):
        (box.folder / "bin" / name).unlink()
    for name in ("bash", "dirname", "cat", "grep", "tr", "sort"):
        (box.folder / "bin" / name).symlink_to(shutil.which(name) or name)

    done = box.run("demo", PATH=f"{box.folder}/bin")

    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert "libsimbody-dev" in done.stderr


@pytest.mark.verifies("SWR-BEN-002", technique="fault_injection", polarity="violation")
def test_peers_that_cannot_be_installed_do_not_stop_the_benchmarks(box: Box) -> None:
    box.install(*PACKAGES_OF_DEMO, "valgrind", "liblcm-dev")

    done = box.run("bench", "--quick", FAKE_APT_FAILS="-y")

    assert done.returncode == 0, done.stderr
    assert "could not install libboost-dev cyclonedds-dev cyclonedds-tools rt-tests" in done.stderr
    assert "going on without them" in done.stdout
    assert "python -P -m mamori.verification.command bench --quick" in box.take_calls()


@pytest.mark.verifies("SWR-BEN-002")
def test_peers_are_installed_with_the_benchmarks_only(box: Box) -> None:
    box.install(*PACKAGES_OF_DEMO, "valgrind")

    box.run("bench", "--list")
    assert not any(call.startswith("apt-get") for call in box.take_calls())

    box.run("bench")
    assert any("install libboost-dev liblcm-dev" in call for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-003")
def test_environment_is_made_from_the_lock_with_hashes(box: Box) -> None:
    box.run("trace", "check")

    installs = [call for call in box.take_calls() if "pip" in call]
    assert f"--require-hashes --only-binary :all: -r {box.folder}/requirements.lock" in installs[0]
    assert "--no-index --no-deps --no-build-isolation" in installs[1]
    assert len(installs) == 2


@pytest.mark.verifies("SWR-CLI-003")
def test_each_line_of_the_lock_is_pinned_and_has_a_hash() -> None:
    lines = [line for line in (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines() if line[:1] not in ("#", "")]
    names = [line for line in lines if not line.startswith("    --hash=sha256:")]

    assert len(names) > 5
    assert all("==" in line and line.endswith(" \\") for line in names)


@pytest.mark.verifies("SWR-CLI-003", technique="state_transition")
def test_changed_lock_makes_a_new_environment(box: Box) -> None:
    box.run("trace", "check")
    box.take_calls()
    with (box.folder / "requirements.lock").open("a", encoding="utf-8") as lock:
        print("# changed", file=lock)

    box.run("trace", "check")

    assert "venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-003", technique="fault_injection", polarity="violation")
def test_environment_that_could_not_be_filled_is_not_used(box: Box) -> None:
    failed = box.run("trace", "check", FAKE_PIP="1")
    assert failed.returncode == 3
    assert failed.stderr.count("\n") == 1
    assert "build/log/python.log" in failed.stderr
    assert not any("mamori.verification" in call for call in box.take_calls())

    assert box.run("trace", "check").returncode == 0
    assert "venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-004")
@pytest.mark.parametrize("command", ["", "demo", "run", "test", "build", "verify", "trace", "log", "bench", "timing", "cost", "e2e", "table", "prove"])
def test_help_needs_nothing_but_bash(box: Box, command: str) -> None:
    bare = box.folder / "bare"
    bare.mkdir()
    for name in ("bash", "cat", "dirname", "grep", "tr", "sort"):
        (bare / name).symlink_to(shutil.which(name) or name)

    done = box.run(*command.split(), "--help", PATH=str(bare))

    assert done.returncode == 0
    assert done.stdout.startswith(f"usage: ./mamori {command}" if command else "Mamori")
    assert done.stderr == ""


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
@pytest.mark.parametrize("command", ["demo", "run", "test", "build", "verify", "log", "bench", "timing", "cost", "e2e", "table", "prove"])
def test_help_names_each_option_that_the_command_takes_and_no_other(box: Box, command: str) -> None:
    subparsers = next(action for action in make_parser()._actions if action.dest == "command")
    taken = {text for action in subparsers.choices[command]._actions for text in action.option_strings}

    # What follows a bare -- is another program's.
    shown = {word.strip("[],") for word in box.run(command, "--help").stdout.split() if word.strip("[").startswith("--")}

    assert shown - {"--help", "--"} == taken - {"--help", "-h"}


@pytest.mark.verifies("SWR-CLI-005", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("tset",), "there is no command 'tset'; nearest: test or "),
        (("demo", "--montion", "x"), "demo has no option '--montion'; nearest: --motion or "),
        (("test", "--quik"), "test has no option '--quik'; nearest: --quick or "),
        (("timing", "x", "--lod"), "timing has no option '--lod'; nearest: --load or "),
        (("timing", "x", "--cycles", "-5"), "timing: argument --cycles: '-5' is no whole number from 1 on"),
        (("cost", "x", "--clas", "a"), "cost has no option '--clas'; nearest: --class or "),
        (("e2e", "--lenght", "8"), "e2e has no option '--lenght'; nearest: --length or "),
        (("e2e", "--length", "-8"), "e2e: argument --length: '-8' is no whole number from 1 on"),
        (("mutate", "--jobs", "-1"), "mutate: argument --jobs: '-1' is no whole number from 1 on"),
        (("demo", "--motion", "gone.yaml"), "motion file 'gone.yaml' cannot be read"),
        (("demo", "--motion=gone.yaml"), "motion file 'gone.yaml' cannot be read"),
    ],
)
def test_wrong_word_is_answered_with_the_nearest_before_anything_is_installed(
    box: Box, words: tuple[str, ...], sentence: str
) -> None:
    done = box.run(*words)

    assert done.returncode == 2
    assert sentence in done.stderr
    assert done.stderr.count("\n") == 1
    assert box.take_calls() == []


@pytest.mark.verifies("SWR-CLI-005", technique="boundary_values", polarity="violation")
def test_no_command_shows_the_help_and_fails(box: Box) -> None:
    done = box.run()

    assert done.returncode == 2
    assert "usage: ./mamori COMMAND" in done.stderr


@pytest.mark.verifies("SWR-CLI-005")
def test_right_words_reach_the_command_unchanged(box: Box, tmp_path: Path) -> None:
    motion = tmp_path / "my motion.yaml"
    motion.write_text("x", encoding="utf-8")

    box.run("demo", "--motion", str(motion), "--scenario", "a b", "c", "--instants=2")

    assert f"python -P -m mamori.verification.command demo --motion {motion} --scenario a b c --instants=2" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-005", technique="equivalence_classes")
def test_words_for_another_program_are_not_judged(box: Box) -> None:
    done = box.run("timing", "x", "--", "--strange", "-5", "--help")

    assert done.returncode == 0, done.stderr
    assert "python -P -m mamori.verification.command timing x -- --strange -5 --help" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-005", technique="boundary_values")
def test_seed_below_zero_reaches_the_command(box: Box) -> None:
    box.run("mutate", "--seed", "-1")

    assert "python -P -m mamori.verification.command mutate --seed -1" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-008", technique="fault_injection", polarity="violation")
def test_ctrl_c_during_the_installation_ends_the_package_manager(box: Box) -> None:
    launcher = subprocess.Popen([str(box.folder / "mamori"), "demo"], env=box.environment(FAKE_APT_HANGS="yes"),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # fmt: skip
    deadline = time.monotonic() + 20.0
    pid_file = box.folder / "apt.pid"
    while not (pid_file.exists() and pid_file.read_text()) and time.monotonic() < deadline:
        time.sleep(0.05)
    child = int(pid_file.read_text())

    launcher.send_signal(signal.SIGINT)
    _, said = launcher.communicate(timeout=20)

    assert launcher.returncode == 130
    assert "stopped" in said
    with pytest.raises(ProcessLookupError):
        os.kill(child, 0)
