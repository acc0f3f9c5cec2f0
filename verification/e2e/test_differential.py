# SPDX-License-Identifier: Apache-2.0
# Goal: messages and verdicts equal those of an independent implementation; differences are reported, wrong arguments rejected.
# Method: the built program and the package on random messages of random channels; a program with wrong replies.
from __future__ import annotations

import sys
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from verification.e2e import differential

FRAMES = 20_000


@pytest.fixture(scope="module")
def program() -> Path:
    path = Project(ROOT).build / "verification" / "e2e" / "mamori_e2e_pipe"
    assert path.exists(), f"{path} is missing; run ./mamori build"
    return path


@pytest.mark.verifies("SWR-E2E-003")
def test_frames_and_verdicts_are_those_of_the_package(program: Path) -> None:
    counts, differences = differential.run(program, FRAMES, seed=1)

    assert differences == []
    assert sorted(counts) == [1, 2, 4, 5, 6, 7, 11]
    assert counts.total() == FRAMES


@pytest.mark.verifies("SWR-E2E-003")
def test_difference_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], program: Path) -> None:
    liar = tmp_path / "liar"
    liar.write_text(f"#!{sys.executable}\nimport subprocess, sys\n"
                    f"out = bytearray(subprocess.run(['{program}'], input=sys.stdin.buffer.read(), capture_output=True).stdout)\n"
                    "out[5] ^= 1\nsys.stdout.buffer.write(out)\n", encoding="utf-8")  # fmt: skip
    liar.chmod(0o755)

    assert differential.main([str(liar), "--frames", "10"]) == 1
    assert "the package says" in capsys.readouterr().err


@pytest.mark.verifies("SWR-E2E-003")
def test_missing_program_and_no_frames_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as missing:
        differential.main([str(tmp_path / "none")])
    with pytest.raises(SystemExit) as none:
        differential.main([sys.executable, "--frames", "0"])

    assert (missing.value.code, none.value.code) == (2, 2)
    assert "build the target mamori_e2e_pipe" in capsys.readouterr().err
