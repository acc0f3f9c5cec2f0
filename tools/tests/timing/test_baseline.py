# SPDX-License-Identifier: Apache-2.0
# Goal: ratios are stored, compared at their limit, and never compared with those of another system, table or format.
# Method: baselines that the tool writes and the test edits.
from __future__ import annotations

from pathlib import Path

import pytest
from timing_run import make_rows, make_run, make_table, write_run

from mamori_tools.table.document import Table, read_table
from mamori_tools.timing.baseline import check_ratios, check_table, load_baseline, make_fingerprint, write_baseline
from mamori_trace.base.errors import InputError

RATIOS = [("reader", 10.0), ('say "hi"\\\n', 2.0)]


def load_table(folder: Path, frame_us: int = 1000) -> Table:
    table = make_table(frame_us=frame_us)
    return read_table(write_run(folder, table, *make_rows(table, [1.0] * 4, 2), make_run(table, 2, 2)) / "table.json")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "baseline.toml"
    write_baseline(path, "arm", load_table(tmp_path / "run"), RATIOS)
    return path


@pytest.mark.verifies("SWR-TIM-020")
def test_what_was_accepted_is_what_is_checked(file: Path) -> None:
    found = load_baseline(file, "arm")

    assert (found.system, found.limit_factor, list(found.ratios)) == ("arm", 1.5, RATIOS)
    check_table(found, load_table(file.parent / "again"))
    assert check_ratios(found, RATIOS) == []


@pytest.mark.verifies("SWR-TIM-020", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("ratio", "count"), [(15.0, 0), (15.01, 1)])
def test_component_over_its_limit_is_named(file: Path, ratio: float, count: int) -> None:
    found = check_ratios(load_baseline(file, "arm"), [("reader", ratio), RATIOS[1]])

    assert len(found) == count
    assert not count or found == ["component 'reader': ratio 15 to the reference, baseline 10, limit 15"]


@pytest.mark.verifies("SWR-TIM-020", technique="error_guessing", polarity="violation")
def test_component_that_only_one_side_has_is_a_finding(file: Path) -> None:
    baseline = load_baseline(file, "arm")

    assert check_ratios(baseline, [RATIOS[1]]) == ["baseline: 'reader' was not measured"]
    assert check_ratios(baseline, [*RATIOS, ("new", 1.0)]) == ["baseline: 'new' is missing in the file"]


@pytest.mark.verifies("SWR-TIM-021", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [("mamori.timing_baseline/1", "mamori.timing_baseline/2", "expected 'mamori.timing_baseline/1'"),
     ('system = "arm"', 'system = "leg"', "is the baseline of 'leg', not of 'arm'"), ("system =", "sytem =", "unknown key 'sytem'"),
     ("limit_factor = 1.5", "limit_factor = 0.5", "must be at least 1"), ("limit_factor = 1.5", "limit_factor = true", "not a number in range"),
     ("ratio = 10.0", "ratio = nan", "ratio of 'reader' is not a number in range"), ("ratio = 10.0", "ratio = -1", "not a number in range"),
     ("[[component]]", "[component]", "invalid TOML"), ("limit_factor = 1.5", "", "key 'limit_factor' is missing"), ("schema", "= schema", "invalid TOML")],
)  # fmt: skip
def test_baseline_of_another_form_is_refused_in_one_line(file: Path, old: str, new: str, said: str) -> None:
    file.write_text(file.read_text().replace(old, new))

    with pytest.raises(InputError) as caught:
        load_baseline(file, "arm")

    assert said in str(caught.value) and str(file) in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.verifies("SWR-TIM-021", polarity="violation")
def test_baseline_of_another_table_is_refused(file: Path) -> None:
    with pytest.raises(InputError, match="belongs to another table of 'arm'; write a new one"):
        check_table(load_baseline(file, "arm"), load_table(file.parent / "other", frame_us=2000))


@pytest.mark.verifies("SWR-TIM-021", technique="boundary_values")
def test_fingerprint_changes_with_any_time_of_the_table(tmp_path: Path) -> None:
    assert make_fingerprint(load_table(tmp_path / "a")) == make_fingerprint(load_table(tmp_path / "b"))
    assert make_fingerprint(load_table(tmp_path / "a")) != make_fingerprint(load_table(tmp_path / "c", frame_us=2000))


@pytest.mark.verifies("SWR-TIM-021", technique="fault_injection", polarity="violation")
def test_missing_baseline_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="baseline not found"):
        load_baseline(tmp_path / "none.toml", "arm")
