# SPDX-License-Identifier: Apache-2.0
"""Whitespace tables and invalid files. Method: small generated files with one error each."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.motion import ArmLimits, load_limits, read_motion
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import MAX_BYTES, read_text

ANGLES = Path(__file__).resolve().parents[3] / "../shared/data/motion/pa10/angle.dat"

GOOD = """\
# time and joints
0.001\t0 0 0 0 0 0 0

0.002   0.0001 0 0 0 0 0 -0.0001  # a remark
0.003 0.0002 0 0 0 0 0 -2e-4
"""


def write(folder: Path, data: str | bytes, name: str = "motion.dat") -> Path:
    path = folder / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


@pytest.mark.verifies("SWR-MOT-002")
def test_time_and_joints_are_read_and_time_starts_at_zero(tmp_path: Path, limits: ArmLimits) -> None:
    motion = read_motion(write(tmp_path, GOOD), limits)

    assert motion.time_s.tolist() == [0.0, 0.001, 0.002]
    assert motion.position_rad[2].tolist() == [0.0002, 0, 0, 0, 0, 0, -0.0002]
    assert motion.notes == ()


@pytest.mark.verifies("SWR-MOT-002")
def test_columns_that_the_model_ignores_are_dropped_with_a_note(tmp_path: Path, limits: ArmLimits) -> None:
    motion = read_motion(write(tmp_path, "0 0 0 0 0 0 0 0 9 9\n0.1 0 0 0 0 0 0 0.1 9 9\n"), limits)

    assert motion.position_rad.shape == (2, 7)
    assert motion.position_rad[1, 6] == 0.1
    assert motion.notes == ("columns 9 to 10 are no arm joints and were dropped",)


@pytest.mark.parametrize("text", ["\ufeff" + GOOD, GOOD.replace("\n", "\r\n")])
@pytest.mark.verifies("SWR-MOT-002", technique="equivalence_classes")
def test_texts_of_other_systems_are_read(tmp_path: Path, limits: ArmLimits, text: str) -> None:
    assert read_motion(write(tmp_path, text), limits).duration_s == 0.002


@pytest.mark.verifies("SWR-MOT-002", technique="error_guessing")
def test_a_missing_last_line_end_is_noted(tmp_path: Path, limits: ArmLimits) -> None:
    assert "line end" in read_motion(write(tmp_path, GOOD.rstrip("\n")), limits).notes[0]


def needs(path: Path) -> pytest.MarkDecorator:
    """A file outside the project is not evidence, so these tests have no tag. They are skipped if the file is missing."""
    return pytest.mark.skipif(not path.exists(), reason=f"{path} is absent")


@needs(ANGLES)
def test_the_public_pick_up_motion_is_read(model: Path) -> None:
    motion = read_motion(ANGLES, load_limits(model))

    assert motion.position_rad.shape == (9812, 7)
    assert motion.duration_s == 9.811
    assert motion.position_rad[-1].tolist() == [
        0.000542015, 0.586349, -0.00090867, 1.09678, 0.000784518, 0.716872, 1.56959]  # fmt: skip


FAULTS = [
    ("0.0001 0 0 0 0 0 -0.0001", "0.0001 0 0 0 0 0", 4, "7 numbers, 8 in the lines before"),
    ("0.0001 0 0 0 0 0 -0.0001", "0.0001 0 0 0 0 0 0 0 0", 4, "10 numbers, 8 in the lines before"),
    ("0.001\t0 0 0 0 0 0 0", "0.001 0 0 0 0 0 0", 2, "6 joint columns, the arm has 7"),
    ("0.001\t0 0 0 0 0 0 0", "0.001 0 0 0 0 0 0 0 0", 2, "8 joint columns, the arm has 7"),
    ("0.001\t0 0 0 0 0 0 0", "time q1 q2 q3 q4 q5 q6 q7", 2, "time is 'time', no number"),
    ("0.003 0.0002", "0.003 nan", 5, "joint column 1 is nan, not finite"),
    ("0.003 0.0002", "0.003 -inf", 5, "not finite"),
    ("0.003 0.0002", "nan 0.0002", 5, "time is nan, not finite"),
    ("0.003 0.0002", "0.003 0,0002", 5, "'0,0002', no number"),
    ("0.003 0.0002", "0.003 " + "x" * 500, 5, "no number"),
    ("0.003 0.0002", "0.003 \u0663", 5, "no number"),
    ("0.003 0.0002", "0.002 0.0002", 5, "is repeated"),
    ("0.003 0.0002", "0.0015 0.0002", 5, "comes after 0.001 s"),
]


@pytest.mark.parametrize(("old", "new", "line", "words"), FAULTS)
@pytest.mark.verifies("SWR-MOT-003", technique="equivalence_classes", polarity="violation")
def test_a_broken_table_is_refused_with_its_line(tmp_path: Path, limits: ArmLimits, old: str, new: str, line: int,
                                                 words: str) -> None:
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new, 1))

    with pytest.raises(InputError) as caught:
        read_motion(path, limits)
    assert str(caught.value).startswith(f"{path}:{line}: ")
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(("data", "line", "words"), [
    (b"", "", "is empty"),
    (b" \n\n", "", "only white space"),
    (b"# only a remark\n", "1", "0 sample(s)"),
    (b"0 0 0 0 0 0 0 0\n", "1", "1 sample(s)"),
    (b"0 0 0\n\0\0", "2", "binary"),
    (b"0 0 0\n# caf\xe9\n", "2", "0xe9 is not UTF-8"),
    ("0 0 0\n".encode("utf-16"), "1", "binary"),
])
@pytest.mark.verifies("SWR-MOT-003", technique="equivalence_classes", polarity="violation")
def test_what_is_no_motion_is_refused(tmp_path: Path, limits: ArmLimits, data: bytes, line: str, words: str) -> None:
    path = write(tmp_path, data)

    with pytest.raises(InputError) as caught:
        read_motion(path, limits)
    assert str(caught.value).startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert words in str(caught.value)


@pytest.mark.verifies("SWR-MOT-003", technique="equivalence_classes", polarity="violation")
def test_a_missing_file_and_a_directory_are_refused(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError, match="not found"):
        read_motion(tmp_path / "nowhere.dat", limits)
    with pytest.raises(InputError, match="is a directory"):
        read_motion(tmp_path, limits)


@pytest.mark.verifies("SWR-MOT-003", technique="boundary_values", polarity="violation")
def test_a_file_over_the_size_limit_is_refused_before_it_is_read(tmp_path: Path, limits: ArmLimits) -> None:
    path = tmp_path / "huge.dat"
    with path.open("wb") as file:
        file.truncate(MAX_BYTES + 1)

    with pytest.raises(InputError, match="at most 200000000 are read"):
        read_motion(path, limits)


@pytest.mark.verifies("SWR-MOT-003", technique="boundary_values")
def test_a_file_of_just_the_size_limit_is_read(tmp_path: Path) -> None:
    assert read_text(write(tmp_path, "12345"), "file", max_bytes=5).text == "12345"
    with pytest.raises(InputError):
        read_text(write(tmp_path, "123456"), "file", max_bytes=5)
