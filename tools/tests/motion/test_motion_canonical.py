# SPDX-License-Identifier: Apache-2.0
"""The canonical table, the command and the shipped motion."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mamori_tools.motion import ArmLimits, canonical_text, load_limits, read_motion, write_canonical
from mamori_tools.motion.__main__ import main
from mamori_trace.base.errors import InputError

ROOT = Path(__file__).resolve().parents[3]
SHIPPED = ROOT / "examples/safe_arm/motions/pick_and_place.yaml"
MAKER = SHIPPED.with_name("make_pick_and_place.py")
ARM_MODEL = ROOT / "simbody_sim/models/pa10_like.yaml"


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "source.dat"
    path.write_text("5.1 0.1 0 0 0 0 0 0\n5.103 0.10000000000000002 0 0 0 0 0 1e-17\n5.2 0.1 0 0 0 0 0 0\n")
    return path


@pytest.mark.verifies("SWR-MOT-007")
def test_the_table_has_every_sample_with_all_digits(source: Path, limits: ArmLimits) -> None:
    assert canonical_text(read_motion(source, limits)) == (
        "# source source.dat\n"
        f"# sha256 {hashlib.sha256(source.read_bytes()).hexdigest()}\n"
        "# time[s] q1[rad] q2[rad] q3[rad] q4[rad] q5[rad] q6[rad] q7[rad]\n"
        "0.0 0.1 0.0 0.0 0.0 0.0 0.0 0.0\n"
        "0.003 0.10000000000000002 0.0 0.0 0.0 0.0 0.0 1e-17\n"
        "0.1 0.1 0.0 0.0 0.0 0.0 0.0 0.0\n")


@pytest.mark.verifies("SWR-MOT-007", technique="back_to_back")
def test_the_table_reads_back_to_the_same_motion_and_the_same_samples(source: Path, limits: ArmLimits) -> None:
    first = read_motion(source, limits)
    copy = source.with_name("copy.dat")
    write_canonical(first, copy)
    second = read_motion(copy, limits)

    assert np.array_equal(first.time_s, second.time_s)
    assert np.array_equal(first.position_rad, second.position_rad)
    assert canonical_text(first).splitlines()[3:] == canonical_text(second).splitlines()[3:]


@pytest.mark.verifies("SWR-MOT-007")
def test_the_bytes_do_not_depend_on_the_folder(source: Path, limits: ArmLimits, tmp_path: Path) -> None:
    other = tmp_path / "elsewhere" / source.name
    other.parent.mkdir()
    other.write_bytes(source.read_bytes())

    assert canonical_text(read_motion(source, limits)) == canonical_text(read_motion(other, limits))


@pytest.mark.verifies("SWR-MOT-007", technique="error_guessing")
def test_a_line_end_in_the_name_cannot_write_samples(source: Path, limits: ArmLimits) -> None:
    odd = source.rename(source.with_name("a\n9 9"))

    assert canonical_text(read_motion(odd, limits)).startswith("# source a\\n9 9\n")


@pytest.mark.verifies("SWR-MOT-007", technique="fault_injection", polarity="violation")
def test_nothing_half_written_is_left(source: Path, limits: ArmLimits, monkeypatch: pytest.MonkeyPatch) -> None:
    target = source.with_name("out.txt")
    target.write_text("before")

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(InputError, match="No space left"):
        write_canonical(read_motion(source, limits), target)
    assert target.read_text() == "before"
    assert not list(source.parent.glob(".*.part"))


@pytest.mark.verifies("SWR-MOT-007", polarity="violation")
def test_a_missing_output_folder_is_refused(source: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        write_canonical(read_motion(source, limits), source.parent / "none" / "out.txt")


@pytest.mark.verifies("SWR-MOT-007", technique="interface")
def test_the_command_shows_the_motion_and_writes_the_table(source: Path, model: Path,
                                                           capsys: pytest.CaptureFixture[str]) -> None:
    target = source.with_name("out.txt")

    assert main([str(source), "--model", str(model), "-o", str(target)]) == 0
    shown = capsys.readouterr().out
    assert "source.dat: 0.1 s, 3 samples, 7 joints" in shown
    assert len([line for line in shown.splitlines() if line.startswith("J")]) == 7
    assert target.read_text().startswith("# source source.dat\n")


@pytest.mark.verifies("SWR-MOT-003", technique="interface", polarity="violation")
def test_the_command_ends_with_status_2_and_one_line(source: Path, model: Path,
                                                     capsys: pytest.CaptureFixture[str]) -> None:
    source.write_text("0 0 0 0 0 0 0 0\n0.1 0 0 0 0 0 0 inf\n")
    target = source.with_name("out.txt")

    assert main([str(source), "--model", str(model), "-o", str(target)]) == 2
    captured = capsys.readouterr()
    assert captured.err == f"{source}:2: joint column 7 is inf, not finite; write a finite number\n"
    assert captured.out == ""
    assert not target.exists()


@pytest.mark.verifies("SWR-MOT-008", technique="back_to_back")
def test_the_shipped_motion_is_what_its_maker_makes() -> None:
    made = subprocess.run([sys.executable, str(MAKER)], check=True, capture_output=True, text=True).stdout

    assert SHIPPED.read_text(encoding="utf-8") == made
    assert SHIPPED.stat().st_size < 300_000


@pytest.mark.verifies("SWR-MOT-008")
def test_every_joint_of_the_shipped_motion_moves_and_stays_calm(limits: ArmLimits) -> None:
    motion = read_motion(SHIPPED, limits)
    travel = motion.position_rad.max(axis=0) - motion.position_rad.min(axis=0)

    assert travel.min() >= 0.3
    assert np.abs(motion.position_rad).max() <= 1.2
    assert 6.0 <= motion.duration_s <= 8.0
    # Rest at both ends and no speed jump: the maximum change of speed between steps corresponds to 3 rad/s2.
    velocity = np.diff(motion.position_rad, axis=0) / np.diff(motion.time_s)[:, np.newaxis]
    assert np.all(velocity[0] == 0.0) and np.all(velocity[-1] == 0.0)
    assert np.abs(np.diff(velocity, axis=0)).max() / 0.005 < 3.0


@pytest.mark.verifies("SWR-MOT-008", technique="boundary_values")
def test_the_shipped_motion_uses_at_most_six_tenths_of_the_arms_speed() -> None:
    if not ARM_MODEL.exists():
        pytest.skip(f"{ARM_MODEL} is absent")
    limits = load_limits(ARM_MODEL)
    motion = read_motion(SHIPPED, limits)
    mechanical = np.array([joint.motion_speed_rad_s for joint in limits.joints]) / 0.8

    assert np.all(motion.get_speeds().max(axis=0) <= 0.6 * mechanical)


@pytest.mark.verifies("SWR-MOT-008")
def test_the_polynomial_between_poses_begins_and_ends_at_rest() -> None:
    spec = importlib.util.spec_from_file_location("make_pick_and_place", MAKER)
    assert spec is not None and spec.loader is not None
    maker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(maker)
    step = 1e-4
    rate = [(maker.calc_blend(x + step) - maker.calc_blend(x)) / step for x in (0.0, 0.5 - step / 2, 1.0 - step)]

    assert (maker.calc_blend(0.0), maker.calc_blend(0.5), maker.calc_blend(1.0)) == (0.0, 0.5, 1.0)
    assert rate == pytest.approx([0.0, 15.0 / 8.0, 0.0], abs=1e-6)
