# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori lcm replay` compares two replays, reports damage, and rejects anything else in one line. Method: the command in this process;
# programs are shell scripts. A C++ program is replayed in verification/integration/tests/lcm_replay_test.cpp.
from __future__ import annotations

from pathlib import Path

import pytest
from lcm_logs import make_event

from mamori_tools.command.main import main

RESULT = "events 2, frames 3\ncore 0: trace hash 1a\n"


@pytest.fixture
def log(tmp_path: Path) -> Path:
    path = tmp_path / "run.lcmlog"
    path.write_bytes(make_event(0, 0, "STATE", b"12345678"))
    return path


def write_program(folder: Path, script: str) -> Path:
    program = folder / "program"
    program.write_text(f"#!/bin/sh\ncat <<END\n{RESULT}END\n{script}\n", encoding="utf-8")
    program.chmod(0o755)
    return program


def replay(log: Path, program: Path, *words: str) -> int:
    return main(["lcm", "replay", str(log), str(program), *words])


@pytest.mark.verifies("SWR-LCM-016")
def test_equal_replays_are_printed_once(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = write_program(tmp_path, f"echo \"$@\" >> '{tmp_path}/calls'")

    assert replay(log, program, "--", "--model", "a b") == 0

    said = capsys.readouterr()
    assert (said.out, said.err) == (RESULT, "mamori: both replays have this output\n")
    assert (tmp_path / "calls").read_text(encoding="utf-8") == f"--model a b --replay {log}\n" * 2


@pytest.mark.verifies("SWR-LCM-016", technique="fault_injection", polarity="violation")
def test_different_replays_are_a_finding(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = write_program(tmp_path, f"echo x >> '{tmp_path}/calls'; echo call $(wc -l < '{tmp_path}/calls')")

    assert replay(log, program) == 1

    assert "two replays differ: 'call 1' and 'call 2'; the program depends on more than the log" in capsys.readouterr().err


@pytest.mark.verifies("SWR-LCM-016", technique="fault_injection", polarity="violation")
def test_second_replay_that_fails_is_a_finding(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = write_program(tmp_path, f"[ -e '{tmp_path}/called' ] && exit 1; touch '{tmp_path}/called'")

    assert replay(log, program) == 1

    assert "two replays ended with status 0 and 1" in capsys.readouterr().err


@pytest.mark.verifies("SWR-LCM-016", technique="fault_injection", polarity="violation")
def test_damaged_log_ends_with_the_message_of_the_program(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = write_program(tmp_path, "echo 'damaged at offset 7' >&2; exit 1")

    assert replay(log, program) == 1

    said = capsys.readouterr()
    assert said.out == RESULT
    lines = said.err.splitlines()
    assert lines[0] == "damaged at offset 7" and f"./mamori log {log} lists all damaged parts" in lines[1]


@pytest.mark.verifies("SWR-LCM-016", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("script", "said"), [
    ("echo 'usage: x' >&2; exit 2", "rejects the replay: usage: x"), ("exit 2", "rejects the replay: no reason"),
    ("kill -SEGV $$", "ended by signal 11"), ("true", "prints no trace hash"),
])  # fmt: skip
def test_program_without_replay_mode_is_rejected(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str], script: str, said: str) -> None:
    program = tmp_path / "program"
    program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    program.chmod(0o755)

    assert replay(log, program) == 2

    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1 and said in errors[0]


@pytest.mark.verifies("SWR-LCM-016", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("words", "said"), [
    (["replay", "LOG", "absent"], "absent: not a program"), (["replay", "absent", "PROGRAM"], "absent: not a log of lcm-logger"),
    (["replay", "text", "PROGRAM"], "text: not a log of lcm-logger"), (["replay", ".", "PROGRAM"], "not a log of lcm-logger"),
    (["replay", "LOG", "text"], "cannot be started"), (["replay", "LOG"], "1 paths instead of 2"), (["replay", "LOG", "a", "b"], "3 paths instead of 2"),
    (["replay", "LOG", "PROGRAM", "--out", "x"], "--out is for types"), (["types", "PROGRAM"], "needs --out DIR"),
    (["types", "a", "b", "--out", "x"], "2 paths"),
    (["types", "PROGRAM", "--out", "x", "--", "y"], "no arguments after the program"), (["record", "LOG"], "there is no 'record'"),
])  # fmt: skip
def test_wrong_arguments_are_rejected_in_one_line(tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
                                                  words: list[str], said: str) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    (tmp_path / "text").write_text("no log", encoding="utf-8")
    places = {"LOG": str(log), "PROGRAM": str(write_program(tmp_path, "true"))}

    assert main(["lcm", *(places.get(word, word) for word in words)]) == 2

    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1 and said in errors[0]
