# SPDX-License-Identifier: Apache-2.0
"""Checks against the arm. Method: both sides of each limit, with the arm of conftest.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.motion import ArmLimits, Motion, body_motion, load_limits, read_motion, table
from mamori_trace.base.errors import InputError


def read(folder: Path, limits: ArmLimits, *samples: tuple[float, float]) -> Motion:
    """Reads a motion in which only joint 2 (limit 1.6 rad/s) moves, given as (time, position)."""
    path = folder / "motion.dat"
    path.write_text("".join(f"{time!r} 0 {position!r} 0 0 0 0 0\n" for time, position in samples))
    return read_motion(path, limits)


@pytest.mark.verifies("SWR-MOT-005", technique="boundary_values")
def test_the_highest_allowed_speed_is_accepted(tmp_path: Path, limits: ArmLimits) -> None:
    assert read(tmp_path, limits, (0.0, 0.1), (0.01, 0.116)).get_speeds().max() == pytest.approx(1.6)


@pytest.mark.verifies("SWR-MOT-005", technique="boundary_values", polarity="violation")
def test_a_step_over_the_speed_limit_names_joint_step_speed_and_limit(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, limits, (0.0, 0.1), (0.01, 0.116), (0.02, 0.132001))
    message = str(caught.value)
    assert "motion.dat:3: joint 2 (J2) steps 0.016001 rad in 0.01 s = 1.6001 rad/s, limit 1.6 rad/s" in message


@pytest.mark.verifies("SWR-MOT-005", technique="boundary_values", polarity="violation")
def test_a_step_back_over_the_speed_limit_is_refused_too(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError, match="joint 2"):
        read(tmp_path, limits, (0.0, 0.1), (0.01, 0.0839))


@pytest.mark.verifies("SWR-MOT-005", technique="boundary_values")
def test_the_ends_of_the_position_range_are_accepted(tmp_path: Path, limits: ArmLimits) -> None:
    read(tmp_path, limits, (0.0, 1.9), (10.0, -1.9))


@pytest.mark.parametrize("position", [1.9000001, -1.9000001])
@pytest.mark.verifies("SWR-MOT-005", technique="boundary_values", polarity="violation")
def test_a_position_outside_the_range_is_refused(tmp_path: Path, limits: ArmLimits, position: float) -> None:
    with pytest.raises(InputError, match=r"motion.dat:2: joint 2 \(J2\) at -?1.9 rad, range -1.9 to 1.9 rad"):
        read(tmp_path, limits, (0.0, 0.0), (10.0, position))


@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values")
def test_two_samples_and_ten_minutes_are_accepted(tmp_path: Path, limits: ArmLimits) -> None:
    assert read(tmp_path, limits, (1.0, 0.0), (601.0, 0.0)).duration_s == 600.0


@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values", polarity="violation")
def test_more_than_ten_minutes_are_refused(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError, match=r"motion.dat:3: .*600.001 s, limit 600 s"):
        read(tmp_path, limits, (0.0, 0.0), (600.0, 0.0), (600.001, 0.0))


@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values", polarity="violation")
def test_a_body_motion_of_more_than_ten_minutes_is_refused(tmp_path: Path, limits: ArmLimits) -> None:
    path = tmp_path / "slow.yaml"
    frames = "    - [0, 0, 0, 0, 0, 0, 0]\n"
    head = "type: BodyMotion\nframeRate: {rate}\ncomponents:\n- type: MultiValueSeq\n  content: JointPosition\n  frames:\n"
    path.write_text(head.format(rate=0.005) + 4 * frames)
    assert read_motion(path, limits).duration_s == 600.0

    path.write_text(head.format(rate=0.0049) + 4 * frames)
    with pytest.raises(InputError, match="limit 600 s"):
        read_motion(path, limits)


@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values", polarity="violation")
def test_one_sample_is_refused(tmp_path: Path, limits: ArmLimits) -> None:
    with pytest.raises(InputError, match="at least 2"):
        read(tmp_path, limits, (0.0, 0.0))


@pytest.mark.parametrize("second", [0.5, 0.4])
@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values", polarity="violation")
def test_times_that_do_not_rise_are_refused(tmp_path: Path, limits: ArmLimits, second: float) -> None:
    with pytest.raises(InputError, match=r"motion.dat:2: time"):
        read(tmp_path, limits, (0.5, 0.0), (second, 0.0))


@pytest.mark.parametrize(("kind", "name"), [(table, "motion.dat"), (body_motion, "motion.yaml")])
@pytest.mark.verifies("SWR-MOT-004", technique="boundary_values", polarity="violation")
def test_reading_stops_at_the_largest_number_of_samples(tmp_path: Path, limits: ArmLimits, kind: object, name: str,
                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {"motion.dat": "".join(f"{time} 0 0 0 0 0 0 0\n" for time in range(3)),
             "motion.yaml": "type: BodyMotion\ncomponents:\n- type: MultiValueSeq\n  content: JointPosition\n"
                            "  frameRate: 1\n  frames:\n" + 3 * "  - [0, 0, 0, 0, 0, 0, 0]\n"}
    path = tmp_path / name
    path.write_text(texts[name])
    monkeypatch.setattr(kind, "MAX_SAMPLES", 3)
    assert len(read_motion(path, limits).time_s) == 3

    monkeypatch.setattr(kind, "MAX_SAMPLES", 2)
    with pytest.raises(InputError, match="more than 2"):
        read_motion(path, limits)


@pytest.mark.verifies("SWR-MOT-006")
def test_limits_come_from_the_model(limits: ArmLimits) -> None:
    assert [joint.name for joint in limits.joints] == [f"J{joint}" for joint in range(1, 8)]
    assert limits.joints[2].motion_speed_rad_s == pytest.approx(0.8 * 3.0)
    assert (limits.joints[2].position_min_rad, limits.joints[2].position_max_rad) == (-1.9, 1.9)
    assert limits.ignored_columns == 2


@pytest.mark.verifies("SWR-MOT-006")
def test_a_motion_limit_of_the_model_goes_before_the_usual_fraction(model: Path) -> None:
    model.write_text(model.read_text().replace("{name: J3,", "{name: J3, motion_speed_limit_rad_s: 0.7,"))

    assert load_limits(model).joints[2].motion_speed_rad_s == 0.7


@pytest.mark.verifies("SWR-MOT-006", technique="interface")
def test_a_source_may_be_written_once_and_named_again(model: Path) -> None:
    text = model.read_text().replace("value: 1, assumption: test", "value: &one 1, assumption: test", 1)
    model.write_text(text.replace("value: 2, assumption: test", "value: *one, assumption: test"))

    assert load_limits(model).joints[1].motion_speed_rad_s == 0.8


MODEL_FAULTS = [
    ("joints:", "links:", None, "'joints' is missing"),
    ("name: J2, ", "", 4, "'name' is missing"),
    ("value: 2, assumption", "value: 0, assumption", 4, "joint J2 has 0"),
    ("value: 2, assumption", "value: -2, assumption", 4, "joint J2 has -2"),
    ("value: 2, assumption", "value: .inf, assumption", 4, "not a number"),
    ("value: 2, assumption", "value: fast, assumption", 4, "not a number"),
    ("[-2.0, 2.0]", "[2.0, 2.0]", 3, "joint J1 needs two numbers"),
    ("[-2.0, 2.0]", "[2.0]", 3, "joint J1 needs two numbers"),
    ("[-2.0, 2.0]", "2.0", 3, "write a list"),
    ("value: 2, source: fingers", "value: -1, source: fingers", 1, "-1 columns"),
    ("[-2.0, 2.0]", "*range", 3, "*range stands for no single value"),
]


@pytest.mark.parametrize(("old", "new", "line", "words"), MODEL_FAULTS)
@pytest.mark.verifies("SWR-MOT-006", technique="equivalence_classes", polarity="violation")
def test_a_model_without_usable_limits_is_refused_with_its_line(model: Path, old: str, new: str, line: int | None,
                                                                words: str) -> None:
    assert old in model.read_text()
    model.write_text(model.read_text().replace(old, new, 1))

    with pytest.raises(InputError) as caught:
        load_limits(model)
    assert words in str(caught.value)
    assert line is None or caught.value.line == line
