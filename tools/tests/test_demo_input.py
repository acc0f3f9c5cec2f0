# SPDX-License-Identifier: Apache-2.0
# Goal: an invalid motion and an unknown scenario end the demo before it changes earlier evidence.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.command import demo
from mamori_tools.command.main import main

for part in ("mamori_tools.motion", "mamori_tools.campaign"):
    pytest.importorskip(part)


@pytest.fixture(autouse=True)
def begun(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Runs only the first actions of the demo."""
    calls: list[object] = []

    def begin(*arguments: object) -> None:
        calls.append(arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr(demo, "begin", begin)
    monkeypatch.setattr("mamori_tools.command.main.end_children", lambda: None)
    monkeypatch.setattr("mamori_tools.command.main.raise_on_signals", lambda: None)
    return calls


@pytest.mark.parametrize("text", ["", "0.0 1 2\n", "0.0 nan nan nan nan nan nan nan\n"], ids=["empty", "joints", "nan"])
@pytest.mark.verifies("SWR-CLI-005", technique="equivalence_classes", polarity="violation")
def test_broken_motion_is_refused_with_its_file(
    text: str, tmp_path: Path, begun: list[object], capsys: pytest.CaptureFixture[str]
) -> None:
    motion = tmp_path / "motion.dat"
    motion.write_text(text, encoding="utf-8")

    assert main(["demo", "--motion", str(motion)]) == 2

    said = capsys.readouterr().err
    assert f"{motion}" in said
    assert said.count("\n") == 1
    assert begun == []


@pytest.mark.verifies("SWR-CLI-005", technique="error_guessing", polarity="violation")
def test_unknown_scenario_is_answered_with_the_nearest(begun: list[object], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo", "--scenario", "encoder_freze"]) == 2

    said = capsys.readouterr().err
    assert "encoder_freeze" in said
    assert said.count("\n") == 1
    assert begun == []


@pytest.mark.verifies("SWR-CLI-005")
def test_right_input_lets_the_demo_begin(begun: list[object]) -> None:
    assert main(["demo", "--scenario", "encoder_freeze", "--instants", "1"]) == 130
    assert len(begun) == 1
