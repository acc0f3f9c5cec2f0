# SPDX-License-Identifier: Apache-2.0
"""BodyMotion files. Method: small generated files with one error each; public files of another arm if available."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.motion import ArmLimits, JointLimits, load_limits, read_motion
from mamori_trace.base.errors import InputError

PROJECT = Path(__file__).resolve().parents[3]
SHARED = PROJECT / "../shared/data/motion/sr1"
PREDECESSORS = PROJECT / "../shared/data/motion/seed_pa10/pa10_example.yaml"
ARM = PROJECT / "simbody_sim/models/pa10_like.yaml"
FINGERS = Path(__file__).parent / "data" / "arm_with_fingers.yaml"

GOOD = """\
type: BodyMotion
components:
  -
    type: "MultiValueSeq"
    content: "JointPosition"
    frameRate: 100
    numFrames: 3
    numParts: 7
    frames:
      - [ 0, 0, 0, 0, 0, 0, 0 ]
      - [ 0.001, 0, 0, 0, 0, 0, 1e-3 ]
      - [ 0.002, 0, 0, 0, 0, 0, 0.0025 ]
  -
    type: Vector3Seq
    content: ZMP
    frames:
      - [ 0, 0, .nan ]
"""


def write(folder: Path, text: str, name: str = "motion.yaml") -> Path:
    path = folder / name
    path.write_text(text)
    return path


@pytest.mark.verifies("SWR-MOT-001")
def test_joint_positions_are_read_with_times_from_the_frame_rate(tmp_path: Path, limits: ArmLimits) -> None:
    motion = read_motion(write(tmp_path, GOOD), limits)

    assert motion.time_s.tolist() == [0.0, 0.01, 0.02]
    assert motion.position_rad[2].tolist() == [0.002, 0, 0, 0, 0, 0, 0.0025]
    assert motion.joint_names == ("J1", "J2", "J3", "J4", "J5", "J6", "J7")


@pytest.mark.verifies("SWR-MOT-001")
def test_other_components_are_left_out_with_a_note(tmp_path: Path, limits: ArmLimits) -> None:
    assert read_motion(write(tmp_path, GOOD), limits).notes == ("components not used: ZMP",)


@pytest.mark.verifies("SWR-MOT-009")
def test_parts_after_the_joints_and_a_link_position_are_named_in_one_note() -> None:
    motion = read_motion(FINGERS, load_limits(ARM))

    assert motion.position_rad.shape == (6, 7)
    assert motion.position_rad[-1].tolist() == [0.0005, 0.8005, -0.0005, 0.7995, 0.0005, 0.7995, 1.5695]
    assert motion.notes == ("not used: parts 8 to 9 (no arm joints); components not used: LinkPosition",)


@pytest.mark.parametrize(("parts", "fits"), [(6, False), (7, True), (8, False), (9, True), (10, False)])
@pytest.mark.parametrize("declared", [True, False])
@pytest.mark.verifies("SWR-MOT-009", technique="boundary_values", polarity="violation")
def test_only_the_joints_or_all_parts_of_the_model_fit(tmp_path: Path, limits: ArmLimits, parts: int, fits: bool,
                                                       declared: bool) -> None:
    frames = "".join(f"      - [ {', '.join(['0'] * parts)} ]\n" for _ in range(3))
    start, end = GOOD.index("      - [ 0, 0"), GOOD.index("  -\n    type: Vector3Seq")
    text = (GOOD[:start] + frames + GOOD[end:]).replace("    numParts: 7\n", f"    numParts: {parts}\n" if declared else "")

    if fits:
        assert read_motion(write(tmp_path, text), limits).position_rad.shape == (3, 7)
    else:
        with pytest.raises(InputError, match="the arm has 7 joints"):
            read_motion(write(tmp_path, text), limits)


@pytest.mark.verifies("SWR-MOT-009", technique="error_guessing", polarity="violation")
def test_a_part_that_is_not_used_is_read_as_a_number_too(tmp_path: Path, limits: ArmLimits) -> None:
    text = FINGERS.read_text().replace("-0.02, 0.02 ]", "-0.02, .nan ]", 1)

    with pytest.raises(InputError, match=r"frame 1, joint 9 is .nan"):
        read_motion(write(tmp_path, text), limits)


@pytest.mark.verifies("SWR-MOT-001")
def test_frame_rate_and_count_of_the_parent_hold_for_its_component(tmp_path: Path, limits: ArmLimits) -> None:
    text = GOOD.replace("    frameRate: 100\n    numFrames: 3\n", "") + "frameRate: 50\nnumFrames: 3\n"

    assert read_motion(write(tmp_path, text), limits).duration_s == 0.04


@pytest.mark.verifies("SWR-MOT-001")
def test_a_value_of_the_component_goes_before_that_of_the_parent(tmp_path: Path, limits: ArmLimits) -> None:
    text = "frameRate: 50\nnumFrames: 99\n" + GOOD

    assert read_motion(write(tmp_path, text), limits).duration_s == 0.02


@pytest.mark.verifies("SWR-MOT-001")
def test_the_second_format_is_read(tmp_path: Path, limits: ArmLimits) -> None:
    text = GOOD.replace("type: BodyMotion", "type: CompositeSeq\ncontent: BodyMotion\nformatVersion: 2", 1)
    text = text.replace("JointPosition", "JointDisplacement")

    assert read_motion(write(tmp_path, text), limits).duration_s == 0.02


FAULTS = [
    # replaced text, replacement, line of the message, words in it
    ("type: BodyMotion", "type: Robot", 1, "type is 'Robot'"),
    ("type: BodyMotion", "formatVersion: 3\ntype: BodyMotion", 1, "formatVersion 3"),
    ("JointPosition", "JointTorque", 2, "no component with content JointPosition"),
    ("ZMP", "JointPosition", 14, "a second component"),
    ("MultiValueSeq", "MultiSE3Seq", 4, "no MultiValueSeq"),
    ("    frameRate: 100\n", "", 4, "frameRate is missing"),
    ("frameRate: 100", "frameRate: 0", 6, "frameRate 0"),
    ("frameRate: 100", "frameRate: -100", 6, "frameRate -100"),
    ("frameRate: 100", "frameRate: .nan", 6, "not finite"),
    ("frameRate: 100", "frameRate: fast", 6, "no number"),
    ("numFrames: 3", "numFrames: 4", 7, "numFrames 4, but 3 frames"),
    ("numFrames: 3", "numFrames: 2", 7, "numFrames 2, but 3 frames"),
    ("numParts: 7", "numParts: 6", 8, "the arm has 7 joints"),
    ("    numParts: 7\n    frames:\n      - [ 0,", "    frames:\n      - [ 0, 0,", 9, "8 joints per frame"),
    ("[ 0.002, 0,", "[ 0.002,", 12, "frame 3 has 6 values"),
    ("[ 0.002, 0,", "[ 0.002, 0, 0,", 12, "frame 3 has 8 values"),
    ("[ 0.002,", "[ .nan,", 12, "frame 3, joint 1 is .nan"),
    ("[ 0.002,", "[ -.inf,", 12, "not finite"),
    ("[ 0.002,", "[ 1e999,", 12, "not finite"),
    ("[ 0.002,", "[ abc,", 12, "'abc', no number"),
    ("[ 0.002,", "[ 1_0,", 12, "no number"),
    ("[ 0.002,", "[ [0.002],", 12, "frame 3 holds a list"),
    ("[ 0.002, 0, 0, 0, 0, 0, 0.0025 ]", "5", 12, "frame 3 is no list"),
    ("[ 0.002, 0, 0, 0, 0, 0, 0.0025 ]", "[ 0.002, 0, 0,", 13, "no YAML"),
    ("    numFrames: 3\n", "    frameRate: 100\n", 7, "stands twice"),
    ("[ 0.002,", "[ *q,", 12, "alias *q"),
    ("type: BodyMotion\n", "type: BodyMotion\n---\n", 2, "a second document"),
]


@pytest.mark.parametrize(("old", "new", "line", "words"), FAULTS)
@pytest.mark.verifies("SWR-MOT-003", technique="equivalence_classes", polarity="violation")
def test_a_broken_body_motion_is_refused_with_its_line(tmp_path: Path, limits: ArmLimits, old: str, new: str,
                                                       line: int, words: str) -> None:
    assert old in GOOD
    path = write(tmp_path, GOOD.replace(old, new, 1))

    with pytest.raises(InputError) as caught:
        read_motion(path, limits)
    assert str(caught.value).startswith(f"{path}:{line}: ")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.verifies("SWR-MOT-003", technique="error_guessing", polarity="violation")
def test_a_body_motion_cut_anywhere_is_refused(tmp_path: Path, limits: ArmLimits) -> None:
    whole = GOOD[:GOOD.index("  -\n    type: Vector3Seq")]
    assert read_motion(write(tmp_path, whole), limits).duration_s == 0.02

    for length in range(1, len(whole) - len(" ]\n") + 1):
        path = write(tmp_path, whole[:length])
        with pytest.raises(InputError, match=r"^[^\n]*motion\.yaml(:\d+)?: [^\n]+$"):
            read_motion(path, limits)


@pytest.mark.verifies("SWR-MOT-003", technique="error_guessing", polarity="violation")
def test_a_bomb_of_aliases_is_refused_at_once(tmp_path: Path, limits: ArmLimits) -> None:
    bomb = "a: &a [x, x]\n" + "".join(f"{b}: &{b} [*{a}, *{a}, *{a}, *{a}]\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True))

    with pytest.raises(InputError, match=":2: alias"):
        read_motion(write(tmp_path, bomb), limits)


@pytest.mark.verifies("SWR-MOT-003", technique="error_guessing", polarity="violation")
def test_deep_nesting_is_refused(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError):
        read_motion(write(tmp_path, "type: BodyMotion\nx: " + "[" * 50_000), limits)


@pytest.mark.verifies("SWR-MOT-003", technique="error_guessing", polarity="violation")
def test_no_tag_constructs_an_object(tmp_path: Path, limits: ArmLimits) -> None:
    marker = tmp_path / "touched"
    text = GOOD.replace("frameRate: 100", f"frameRate: !!python/object/apply:os.system ['touch {marker}']")

    with pytest.raises(InputError, match="frameRate is missing"):
        read_motion(write(tmp_path, text), limits)
    assert not marker.exists()


def needs(path: Path) -> pytest.MarkDecorator:
    """A file outside the project is not evidence, so these tests have no tag. They are skipped if the file is missing."""
    return pytest.mark.skipif(not path.exists(), reason=f"{path} is absent")


def make_wide_limits(tmp_path: Path, joints: int) -> ArmLimits:
    return ArmLimits(tmp_path, tuple(JointLimits(f"J{joint}", -10.0, 10.0, 100.0) for joint in range(joints)), 0)


@pytest.mark.parametrize(("name", "frames", "notes"), [
    ("SR1WalkPattern2_v1.yaml", 7146, ("components not used: LinkPosition, ZMP",)),
    ("SR1WalkPattern1.seq", 6701, ()),
])
@needs(SHARED)
def test_public_walks_are_read(tmp_path: Path, name: str, frames: int, notes: tuple[str, ...]) -> None:
    motion = read_motion(SHARED / name, make_wide_limits(tmp_path, 29))

    assert motion.position_rad.shape == (frames, 29)
    assert motion.duration_s == pytest.approx((frames - 1) / 500.0)
    assert motion.notes == notes


@pytest.mark.parametrize("name", ["SR1WalkPattern2_v1.yaml", "SR1WalkPattern1.seq"])
@needs(SHARED)
def test_public_walks_do_not_fit_the_arm(model: Path, name: str) -> None:
    with pytest.raises(InputError, match="numParts 29, the arm has 7 joints"):
        read_motion(SHARED / name, load_limits(model))


@needs(PREDECESSORS)
def test_the_example_of_the_predecessors_is_read_to_its_last_posture() -> None:
    motion = read_motion(PREDECESSORS, load_limits(ARM))

    assert motion.position_rad.shape == (11, 7)
    assert motion.position_rad[-1].tolist() == [
        -9.23578975e-09, 0.800324833, -4.8402442e-08, 0.799990442, 2.71328608e-07, 0.799794315, 1.56999985]  # fmt: skip
    assert motion.notes == ("not used: parts 8 to 9 (no arm joints); components not used: LinkPosition",)
