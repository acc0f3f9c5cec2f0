# SPDX-License-Identifier: Apache-2.0
# Goal: the launcher script installs missing packages only with permission, otherwise states the reason in one line; it rejects wrong
# arguments before installing. Method: a copy of the script on a simulated host (support/launcher_box.py).
from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import time
import tomllib
from pathlib import Path

import pytest
from launcher_box import APT_INSTALL, PACKAGES_OF_BUILD, Box, list_errors, listen_to_ctrl_c

from mamori_tools.command.help_texts import FOLDER, OVERVIEW, make_texts
from mamori_tools.command.main import make_parser
from mamori_tools.host.project import ROOT

TEXTS = make_texts()


@pytest.fixture
def box(tmp_path: Path) -> Box:
    return Box(tmp_path)


@pytest.mark.verifies("SWR-CLI-001")
def test_only_what_is_missing_is_installed_before_the_command_runs(box: Box) -> None:
    box.install("python3", "cmake", "g++")

    done = box.run("demo", "--jobs", "3", "--install")

    missing = " ".join(name for name in PACKAGES_OF_BUILD if name not in ("python3", "cmake", "g++"))
    calls = box.take_calls()
    assert done.returncode == 0, done.stderr
    assert f"{APT_INSTALL} {missing}" in calls
    assert calls[-2:] == ["python -P -m mamori_tools.command demo --jobs 3",
                          f"packages: {' '.join(PACKAGES_OF_BUILD)}"]  # fmt: skip


@pytest.mark.verifies("SWR-CLI-001")
def test_second_run_installs_nothing(box: Box) -> None:
    assert box.run("test", "--install").returncode == 0
    box.take_calls()

    done = box.run("test")

    assert done.returncode == 0
    assert [call.split()[0] for call in box.take_calls()] == ["python", "packages:"]
    assert done.stdout == ""


@pytest.mark.verifies("SWR-CLI-001", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("words", "wanted", "unwanted"),
    [(("trace", "check"), "python3-venv", "cmake"), (("log", "run.rec"), "python3-venv", "cmake"), (("e2e",), "python3-venv", "cmake"),
     (("constraint", "x<1"), "python3-venv", "cmake"), (("profile", "check", "x"), "python3-venv", "cmake"),
     (("lcm", "types", "x"), "python3-venv", "cmake"),
     (("build",), "cmake", "cppcheck"), (("test",), "cppcheck", "strace"),
     (("build", "--preset", "host-asan"), "clang-19", "git"), (("bench",), "valgrind", "cppcheck"),
     (("mutate",), "clang-19", "git"), (("fuzz",), "libclang-rt-19-dev", "git"),
     (("prove", "safe-state"), "spin", "cppcheck"), (("test",), "z3", "strace"), (("demo",), "cmake", "spin"),
     (("demo",), "cmake", "graphviz"), (("verify",), "graphviz", "cppcheck"), (("verify", "x"), "cmake", "graphviz"),
     (("new", "x"), "python3-venv", "cmake"), (("campaign", "p.yaml"), "python3-venv", "cmake"),
     (("timing", "x", "--load"), "stress-ng", "valgrind"), (("timing", "x"), "cmake", "stress-ng"),
     (("timing", "x", "--", "--load"), "cmake", "stress-ng"),
     (("cost", "x"), "valgrind", "stress-ng"), (("bench", "--list"), "python3-venv", "valgrind"), (("test",), "valgrind", "libboost-dev"),
     (("table", "t.json", "--text"), "python3-venv", "graphviz"), (("table", "t.json", "--out", "d"), "graphviz", "cmake"),
     (("trace", "check"), "python3-venv", "git"), (("trace", "impact", "HEAD"), "git", "cmake"),
     (("trace", "verify", "b.tar"), "openssh-client", "cmake"), (("test",), "openssh-client", "strace"),
     (("test",), "liblcm-bin", "libboost-dev"), (("verify",), "liblcm-dev", "cppcheck"), (("build",), "cmake", "liblcm-dev"),
     (("hil",), "iproute2", "cmake"), (("test",), "liblcm-dev", "iproute2")],
)  # fmt: skip
def test_each_command_needs_its_groups_only(box: Box, words: tuple[str, ...], wanted: str, unwanted: str) -> None:
    box.run("--install", *words)

    installed = next(call for call in box.take_calls() if " install " in call).split()
    assert wanted in installed
    assert unwanted not in installed


@pytest.mark.verifies("SWR-CLI-001", technique="equivalence_classes")
@pytest.mark.parametrize("words", [("demo",), ("test",), ("bench",), ("build",)])
def test_machine_without_debian_tools_works_where_the_tools_are_there(box: Box, words: tuple[str, ...]) -> None:
    box.install(*(path.name for path in (box.folder / "store").iterdir()))
    box.remove_tools("apt-get", "dpkg", "dpkg-query", "sudo")

    done = box.run(*words)

    assert done.returncode == 0, done.stderr
    assert f"python -P -m mamori_tools.command {words[0]}" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-001", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("package", PACKAGES_OF_BUILD)
def test_each_missing_package_is_noticed_by_what_it_brings(box: Box, package: str) -> None:
    box.install(*(name for name in PACKAGES_OF_BUILD if name != package))

    done = box.run("build")

    assert done.returncode == 3
    assert f"--no-install-recommends {package}" in done.stderr


@pytest.mark.verifies("SWR-CLI-001", technique="error_guessing")
def test_headers_in_a_folder_of_the_user_count(box: Box) -> None:
    box.install(*(name for name in PACKAGES_OF_BUILD if name != "libsimbody-dev"))
    prefix = box.folder / "own prefix is elsewhere".replace(" ", "_")
    shutil.copytree(box.folder / "store" / "libsimbody-dev", prefix)

    assert box.run("build").returncode == 3
    assert box.run("build", CMAKE_PREFIX_PATH=f"/nowhere;{prefix}").returncode == 0


@pytest.mark.verifies("SWR-CLI-001", technique="boundary_values")
def test_complete_environment_needs_nothing_to_make_it(box: Box) -> None:
    assert box.run("trace", "check", "--install").returncode == 0
    (box.folder / "share" / "python3-venv").unlink()

    assert box.run("trace", "check").returncode == 0


@pytest.mark.verifies("SWR-CLI-002", technique="boundary_values", polarity="violation")
def test_python_that_is_too_old_is_missing(box: Box) -> None:
    box.install("python3", "python3-venv")

    done = box.run("trace", "check", "--install", FAKE_OLD_PYTHON="1")

    assert done.returncode == 3
    assert "not found: python3" in done.stderr


@pytest.mark.verifies("SWR-CLI-002", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize("name", ["build", "build/log/python.log", ".venv"])
def test_checkout_that_cannot_be_written_is_named_in_one_line(box: Box, name: str) -> None:
    box.install("python3", "python3-venv")
    if name == ".venv":
        (box.folder / name).symlink_to("/proc/1/fdinfo")
        (box.folder / "bin" / "rm").unlink()
        (box.folder / "bin" / "rm").symlink_to(shutil.which("false") or "")
    elif name == "build":
        (box.folder / name).write_text("", encoding="utf-8")
    else:
        (box.folder / name).mkdir(parents=True)

    done = box.run("trace", "check")

    assert (done.returncode, done.stdout) == (3, "")
    assert "cannot be written" in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.verifies("SWR-CLI-023", technique="interface")
def test_first_call_writes_nothing_but_the_requested_output(box: Box) -> None:
    done = box.run("e2e", "--json", "--install", FAKE_OUTPUT='{"profile": 1}')

    assert done.returncode == 0
    assert json.loads(done.stdout) == {"profile": 1}
    assert "making the Python environment" in done.stderr


@pytest.mark.verifies("SWR-CLI-023", technique="interface")
def test_link_to_the_launcher_finds_its_checkout(box: Box, tmp_path_factory: pytest.TempPathFactory) -> None:
    box.install("python3", "python3-venv")
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "first").symlink_to(box.folder / "mamori")
    (elsewhere / "m").symlink_to("first")

    done = subprocess.run([str(elsewhere / "m"), "trace", "check"], env=box.environment(), capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stderr
    assert (box.folder / ".venv" / "mamori.stamp").exists()
    assert sorted(path.name for path in elsewhere.iterdir()) == ["first", "m"]


@pytest.mark.verifies("SWR-CLI-002")
def test_sudo_without_password_is_used(box: Box) -> None:
    assert box.run("trace", "check", "--install", FAKE_UID="1000", FAKE_SUDO="yes").returncode == 0

    assert f"{APT_INSTALL} python3 python3-venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-002", technique="fault_injection", polarity="violation")
def test_without_the_right_to_install_one_line_names_the_packages(box: Box) -> None:
    box.install("python3", "g++")

    done = box.run("demo", "--install", FAKE_UID="1000")

    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    for name in set(PACKAGES_OF_BUILD) - {"python3", "g++"}:
        assert f" {name}" in done.stderr
    assert not any(call.startswith(("apt-get", "python")) for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-002", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("step", "settings"), [("update", {"FAKE_APT_FAILS": "update"}), ("install", {"FAKE_APT_FAILS": "-y"})])
def test_failing_package_manager_is_named_with_its_log(box: Box, step: str, settings: dict[str, str]) -> None:
    done = box.run("demo", "--install", **settings)

    log = box.folder / "build" / "log" / "packages.log"
    assert done.returncode == 3
    assert len(list_errors(done)) == 1
    assert str(log) in done.stderr
    assert "E: the mirror is down" in log.read_text(encoding="utf-8")
    assert not any(call.startswith("python") for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-002", technique="equivalence_classes", polarity="violation")
def test_machine_without_apt_is_told_what_it_needs(box: Box) -> None:
    box.remove_tools("apt-get", "dpkg", "dpkg-query", "sudo")

    for words in (("demo",), ("demo", "--install")):
        done = box.run(*words)

        assert done.returncode == 3
        assert done.stderr.count("\n") == 1
        assert "libsimbody-dev" in done.stderr


@pytest.mark.verifies("SWR-BEN-002", technique="fault_injection", polarity="violation")
def test_peers_that_cannot_be_installed_do_not_stop_the_benchmarks(box: Box) -> None:
    box.install(*PACKAGES_OF_BUILD, "valgrind", "liblcm-dev")

    done = box.run("bench", "--quick", "--install", FAKE_APT_FAILS="-y")

    assert done.returncode == 0, done.stderr
    assert "could not install libboost-dev cyclonedds-dev cyclonedds-tools rt-tests" in done.stderr
    assert "continuing without them" in done.stderr
    assert "python -P -m mamori_tools.command bench --quick" in box.take_calls()


@pytest.mark.verifies("SWR-BEN-002")
def test_peers_are_installed_with_the_benchmarks_only(box: Box) -> None:
    box.install(*PACKAGES_OF_BUILD, "valgrind")

    box.run("bench", "--list")
    assert not any(call.startswith("apt-get") for call in box.take_calls())

    box.run("bench", "--install")
    assert any("install libboost-dev liblcm-dev" in call for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-003")
def test_environment_is_made_from_the_lock_with_hashes(box: Box) -> None:
    box.install("python3", "python3-venv")
    box.run("trace", "check")

    installs = [call for call in box.take_calls() if " pip " in call]
    assert f"--require-hashes --only-binary :all: -r {box.folder}/requirements.lock" in installs[0]
    assert "--no-index --no-deps --no-build-isolation" in installs[1]
    assert len(installs) == 2


@pytest.mark.verifies("SWR-CLI-003")
def test_each_line_of_the_locks_is_pinned_and_has_a_hash_and_the_locks_share_no_package() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    locked: dict[str, set[str]] = {}
    for lock in ("requirements.lock", "requirements-test.lock"):
        lines = [line for line in (ROOT / lock).read_text(encoding="utf-8").splitlines() if line[:1] not in ("#", "")]
        names = [line for line in lines if not line.startswith("    --hash=sha256:")]
        assert len(names) > 5
        assert all("==" in line and line.endswith(" \\") for line in names)
        locked[lock] = {line.partition("==")[0] for line in names}

    base, test = locked["requirements.lock"], locked["requirements-test.lock"]
    assert base & test == set()
    assert {name.lower() for name in project["dependencies"]} <= base
    assert {name.lower() for name in project["optional-dependencies"]["test"]} <= test


@pytest.mark.verifies("SWR-CLI-003", technique="state_transition")
def test_packages_that_only_tests_load_are_installed_by_the_command_that_runs_them(box: Box) -> None:
    box.install(*PACKAGES_OF_BUILD)
    test_lock = f"--require-hashes --only-binary :all: -r {box.folder}/requirements-test.lock"

    for words in (("demo",), ("trace", "check"), ("build",)):
        assert box.run(*words).returncode == 0
        assert not any(test_lock in call for call in box.take_calls())

    assert box.run("test", "--install").returncode == 0
    installs = [call for call in box.take_calls() if " pip " in call]
    assert len(installs) == 1 and test_lock in installs[0]
    assert box.run("demo").returncode == box.run("test").returncode == 0
    assert not any(" pip " in call for call in box.take_calls())


@pytest.mark.verifies("SWR-CLI-003", technique="state_transition")
def test_changed_lock_makes_a_new_environment(box: Box) -> None:
    box.install("python3", "python3-venv")
    box.run("trace", "check")
    box.take_calls()
    with (box.folder / "requirements.lock").open("a", encoding="utf-8") as lock:
        print("# changed", file=lock)

    box.run("trace", "check")

    assert "venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-003", technique="fault_injection", polarity="violation")
def test_environment_that_could_not_be_filled_is_not_used(box: Box) -> None:
    box.install("python3", "python3-venv")
    failed = box.run("trace", "check", FAKE_PIP="1")
    assert failed.returncode == 3
    assert len(list_errors(failed)) == 1
    assert "build/log/python.log" in failed.stderr
    assert not any("verification" in call for call in box.take_calls())

    assert box.run("trace", "check").returncode == 0
    assert "venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
@pytest.mark.parametrize("words", [("help",), ("-h",), ("--help",), *((name, "--help") for name in TEXTS if name != OVERVIEW), ("trace", "-h")])
def test_help_needs_nothing_but_bash(box: Box, words: tuple[str, ...]) -> None:
    bare = box.folder / "bare"
    bare.mkdir()
    for name in ("bash", "cat", "dirname", "grep", "tr", "sort"):
        (bare / name).symlink_to(shutil.which(name) or name)

    done = box.run(*words, PATH=str(bare))

    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == TEXTS[words[0] if len(words) == 2 else OVERVIEW]


@pytest.mark.verifies("SWR-CLI-004", technique="fault_injection")
@pytest.mark.parametrize(("name", "words"), [(OVERVIEW, ("--help",)), (OVERVIEW, ("demo",)), ("demo", ("demo", "--help")), ("demo", ("demo", "--jobs", "1"))])
def test_a_missing_help_text_is_named_in_one_line(box: Box, name: str, words: tuple[str, ...]) -> None:
    file = box.folder / FOLDER.relative_to(ROOT) / f"{name}.txt"
    file.unlink()

    done = box.run(*words)

    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == f"mamori: {file} cannot be read; use a complete copy of Mamori\n"
    assert box.take_calls() == []


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
@pytest.mark.parametrize("command", sorted(set(TEXTS) - {OVERVIEW, "trace"}))
def test_help_names_each_option_that_the_command_takes_and_no_other(command: str) -> None:
    [subparsers] = [action for action in make_parser()._actions if isinstance(action, argparse._SubParsersAction)]
    taken = {text for action in subparsers.choices[command]._actions for text in action.option_strings}

    # The arguments after a bare -- belong to another program.
    shown = {word.strip("[],;:`") for word in TEXTS[command].split() if word.strip("[").startswith("--")}

    assert shown - {"--help", "--", "--install"} == taken - {"--help", "-h"}


@pytest.mark.verifies("SWR-CLI-005", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("tset",), "there is no command 'tset'; nearest: test or "),
        (("demo", "--montion", "x"), "demo has no option '--montion'; nearest: --motion or "),
        (("test", "--quik"), "test has no option '--quik'; nearest: --quick or "),
        (("timing", "x", "--lod"), "timing has no option '--lod'; nearest: --load or "),
        (("timing", "x", "--cycles", "-5"), "timing: argument --cycles: '-5' is not an integer of at least 1"),
        (("cost", "x", "--clas", "a"), "cost has no option '--clas'; nearest: --class or "),
        (("e2e", "--lenght", "8"), "e2e has no option '--lenght'; nearest: --length or "),
        (("e2e", "--length", "-8"), "e2e: argument --length: '-8' is not an integer of at least 1"),
        (("mutate", "--jobs", "-1"), "mutate: argument --jobs: '-1' is not an integer of at least 1"),
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

    box.install(*PACKAGES_OF_BUILD)
    box.run("demo", "--motion", str(motion), "--scenario", "a b", "c", "--instants=2")

    assert f"python -P -m mamori_tools.command demo --motion {motion} --scenario a b c --instants=2" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-005", technique="equivalence_classes")
def test_words_for_another_program_are_not_judged(box: Box) -> None:
    box.install(*PACKAGES_OF_BUILD)
    done = box.run("timing", "x", "--", "--strange", "-5", "--help")

    assert done.returncode == 0, done.stderr
    assert "python -P -m mamori_tools.command timing x -- --strange -5 --help" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-005", technique="boundary_values")
def test_seed_below_zero_reaches_the_command(box: Box) -> None:
    box.run("mutate", "--seed", "-1", "--install")

    assert "python -P -m mamori_tools.command mutate --seed -1" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-008", technique="fault_injection", polarity="violation")
def test_ctrl_c_during_the_installation_ends_the_package_manager(box: Box) -> None:
    launcher = subprocess.Popen([str(box.folder / "mamori"), "demo", "--install"], env=box.environment(FAKE_APT_HANGS="yes"),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=listen_to_ctrl_c)  # fmt: skip
    deadline = time.monotonic() + 20.0
    pid_file = box.folder / "apt.pid"
    while not (pid_file.exists() and pid_file.read_text()) and time.monotonic() < deadline:
        time.sleep(0.05)
    child = int(pid_file.read_text())

    while launcher.poll() is None and time.monotonic() < deadline + 20.0:  # bash 5.2 can lose one signal
        launcher.send_signal(signal.SIGINT)
        time.sleep(0.5)
    _, said = launcher.communicate(timeout=20)

    assert launcher.returncode == 130
    assert "stopped" in said
    with pytest.raises(ProcessLookupError):
        os.kill(child, 0)
