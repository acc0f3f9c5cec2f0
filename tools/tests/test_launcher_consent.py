# SPDX-License-Identifier: Apache-2.0
# Goal: the launcher script installs packages only with permission. Method: a copy of the script on a simulated host
# (support/launcher_box.py), with and without a terminal.
from __future__ import annotations

import os
import pty
import select
import time
from pathlib import Path

import pytest
from launcher_box import APT_INSTALL, PACKAGES_OF_BUILD, Box, listen_to_ctrl_c


@pytest.fixture
def box(tmp_path: Path) -> Box:
    return Box(tmp_path)


@pytest.mark.verifies("SWR-CLI-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("settings", [{}, {"CI": "1"}, {"CI": "false"}])
def test_nothing_is_installed_without_permission_and_one_line_names_all_packages(box: Box, settings: dict[str, str]) -> None:
    box.install("python3", "g++", "libyaml-cpp-dev")

    done = box.run("demo", **settings)

    missing = " ".join(name for name in PACKAGES_OF_BUILD if name not in ("python3", "g++", "libyaml-cpp-dev"))
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.count("\n") == 1
    assert done.stderr.endswith(f"apt-get install --no-install-recommends {missing}\n")
    assert box.take_calls() == []


@pytest.mark.verifies("SWR-CLI-022", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("words", "settings"),
    [(("demo", "--install", "--jobs", "2"), {}), (("demo", "--jobs", "2", "--install"), {}), (("--install", "demo", "--jobs", "2"), {}),
     (("demo", "--jobs", "2"), {"CI": "true"})],
)  # fmt: skip
def test_permission_may_stand_anywhere_or_come_from_ci(box: Box, words: tuple[str, ...], settings: dict[str, str]) -> None:
    assert box.run(*words, **settings).returncode == 0

    calls = box.take_calls()
    assert f"{APT_INSTALL} {' '.join(PACKAGES_OF_BUILD)}" in calls
    assert "python -P -m mamori_tools.command demo --jobs 2" in calls


@pytest.mark.verifies("SWR-CLI-022", technique="boundary_values", polarity="violation")
def test_permission_among_the_words_for_another_program_is_none(box: Box) -> None:
    assert box.run("timing", "x", "--", "--install").returncode == 3

    assert box.take_calls() == []


def run_on_terminal(box: Box, answer: bytes, *words: str) -> tuple[int, str]:
    """The launcher on a terminal, where the user answers the question with `answer`. @return exit status and screen."""
    child, terminal = pty.fork()
    if child == 0:
        listen_to_ctrl_c()
        os.execve(box.folder / "mamori", ["mamori", *words], box.environment())
    screen, typed, deadline = b"", False, time.monotonic() + 30.0
    while time.monotonic() < deadline:
        if not select.select([terminal], [], [], 0.2)[0]:
            continue
        try:
            piece = os.read(terminal, 4096)
        except OSError:  # the other end is closed
            break
        screen += piece
        if b"[y/N]" in screen and not typed:
            os.write(terminal, answer)
            typed = True
    os.close(terminal)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), screen.decode()


@pytest.mark.verifies("SWR-CLI-022", technique="equivalence_classes")
@pytest.mark.parametrize("answer", [b"y\n", b"Yes\n"])
def test_consent_on_a_terminal_installs(box: Box, answer: bytes) -> None:
    status, screen = run_on_terminal(box, answer, "trace", "check")

    assert status == 0, screen
    assert f"{APT_INSTALL} python3 python3-venv" in box.take_calls()


@pytest.mark.verifies("SWR-CLI-022", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("answer", [b"\n", b"n\n", b"yellow\n", b"\x04"])
def test_any_other_answer_installs_nothing(box: Box, answer: bytes) -> None:
    status, screen = run_on_terminal(box, answer, "trace", "check")

    assert status == 3, screen
    assert "apt-get install --no-install-recommends python3 python3-venv" in screen
    assert box.take_calls() == []


@pytest.mark.verifies("SWR-CLI-022", technique="error_guessing", polarity="violation")
def test_ctrl_c_at_the_question_ends_with_130(box: Box) -> None:
    status, screen = run_on_terminal(box, b"\x03", "trace", "check")

    assert status == 130, screen
    assert box.take_calls() == []


@pytest.mark.verifies("SWR-CLI-022", technique="error_guessing", polarity="violation")
def test_the_package_system_is_neither_queried_nor_repaired(box: Box) -> None:
    assert box.run("demo", "--install").returncode == 0

    assert not any(call.startswith("dpkg") for call in box.take_calls())
