# SPDX-License-Identifier: Apache-2.0
# Goal: a maximum count that grew is named, and a baseline of another system is rejected. Method: a written baseline with changes.
from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import pytest
from cost_run import BUILD, COUNTS, load_table, make_class, make_run
from timing_run import make_table

from mamori_tools.cost.analysis import StepRow, find_pace, list_ratios, list_steps
from mamori_tools.cost.baseline import Baseline, check_origin, judge_growth, load_baseline, write_baseline
from mamori_tools.table.document import Table
from mamori_trace.base.errors import InputError

ONE = make_class(arguments=("--motion", 'a "b"'))


def list_rows(table: Table, drive: Sequence[int] = COUNTS[3]) -> list[StepRow]:
    runs = [make_run(table, ONE, {**COUNTS, 3: drive})]
    return list_steps(runs, find_pace(list_ratios(runs), runs))


@pytest.fixture
def table(tmp_path: Path) -> Table:
    return load_table(tmp_path)


@pytest.fixture
def path(tmp_path: Path, table: Table) -> Path:
    """A baseline of the system "arm"."""
    path = tmp_path / "cost_baseline.toml"
    write_baseline(path, "arm", table, [ONE], BUILD, list_rows(table))
    return path


def load(path: Path) -> Baseline:
    return load_baseline(path, "arm", [ONE])


@pytest.mark.verifies("SWR-TIM-037")
def test_what_was_written_is_read_and_has_no_findings(path: Path, table: Table) -> None:
    baseline = load(path)

    check_origin(baseline, table, BUILD)
    assert baseline.maxima["still", "controller", "execute"] == 12_000
    assert judge_growth(baseline, list_rows(table), 0.0) == []


@pytest.mark.verifies("SWR-TIM-037", technique="boundary_values", polarity="violation")
def test_count_that_grew_by_more_than_is_allowed_is_named_with_its_cycle(path: Path, table: Table) -> None:
    baseline = load(path)

    assert judge_growth(baseline, list_rows(table, (100, 100, 102, 100)), 2.0) == []
    (finding,) = judge_growth(baseline, list_rows(table, (100, 100, 103, 100)), 2.0)
    assert finding.startswith("component 'drive', execute, class 'still': 103 instructions in cycle 12, 3 more than the baseline's 100, 2 % are")


@pytest.mark.verifies("SWR-TIM-037", polarity="violation")
def test_steps_that_are_new_or_gone_are_named(path: Path, table: Table) -> None:
    baseline, rows = load(path), list_rows(table)

    assert "component 'drive', execute, class 'still': is in the baseline and did not run" in judge_growth(baseline, rows[:-1], 2.0)[0]
    (finding,) = judge_growth(baseline, [*rows, dataclasses.replace(rows[0], pass_name="mode step")], 2.0)
    assert finding.startswith("component 'reader', mode step, class 'still': is not in the baseline")


@pytest.mark.parametrize("what", ["compiler", "flags", "c_library"])
@pytest.mark.verifies("SWR-TIM-038", polarity="violation")
def test_baseline_of_another_build_is_refused(path: Path, table: Table, what: str) -> None:
    with pytest.raises(InputError, match=f"was made with the {what.replace('c_l', 'C l')} '.*', this program with 'other'"):
        check_origin(load(path), table, dataclasses.replace(BUILD, **{what: "other"}))


@pytest.mark.verifies("SWR-TIM-038", polarity="violation")
def test_baseline_of_another_table_is_refused(tmp_path: Path, path: Path) -> None:
    baseline = load(path)
    with pytest.raises(InputError, match="was made of another table of 'arm'"):
        check_origin(baseline, load_table(tmp_path, make_table(connections=())), BUILD)


@pytest.mark.verifies("SWR-TIM-038", polarity="violation")
def test_baseline_of_another_system_is_refused(path: Path) -> None:
    with pytest.raises(InputError, match="is the baseline of 'arm', not of 'leg'"):
        load_baseline(path, "leg", [ONE])


@pytest.mark.parametrize("changed", [{"name": "other"}, {"cycles": 15}, {"first": 11}, {"every": 2}, {"arguments": ()}])
@pytest.mark.verifies("SWR-TIM-038", technique="equivalence_classes", polarity="violation")
def test_baseline_of_other_classes_of_inputs_is_refused(path: Path, changed: dict[str, object]) -> None:
    with pytest.raises(InputError, match="was made with other classes of inputs"):
        load_baseline(path, "arm", [dataclasses.replace(ONE, **changed)])  # type: ignore[arg-type]


@pytest.mark.verifies("SWR-TIM-038")
def test_place_of_the_project_is_no_part_of_a_class(path: Path) -> None:
    assert load_baseline(path, "arm", [dataclasses.replace(ONE, words=("elsewhere",))]) == load(path)


@pytest.mark.parametrize(("old", "new", "complaint"), [
    ("cost_baseline/1", "cost_baseline/2", "has the schema 'mamori.cost_baseline/2'"), ('system = "arm"', "system = 3", "'system' is no text"),
    ('system = "arm"\n', "", "key 'system' is missing"), ("max = 100\n", "max = -1\n", "max of 'drive' is no count"),
    ("max = 100\n", "max = 1.5\n", "is no count"), ("max = 100\n", "max = true\n", "is no count"), ("max = 100\n", "", "key 'max' is missing"),
    ("flags", "flagz", "it has an unknown key 'flagz'"), ("schema =", "schema", "is no TOML"), ("[[step]]", "[step]", "is no TOML"),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-038", technique="equivalence_classes", polarity="violation")
def test_broken_baseline_is_refused_with_one_line(path: Path, old: str, new: str, complaint: str) -> None:
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load(path)

    assert complaint in str(caught.value)
    assert "\n" not in str(caught.value) and "--accept" in str(caught.value)


@pytest.mark.verifies("SWR-TIM-038")
def test_committed_baseline_of_the_example_belongs_to_its_classes() -> None:
    from mamori_tools.cost.classes import read_plan
    from mamori_tools.host.project import ROOT, Project
    from mamori_tools.timing.system import find_system

    system = find_system("examples/safe_arm", Project(ROOT), "cost")
    plan = read_plan(system, Project(ROOT))
    baseline = load_baseline(ROOT / "examples/safe_arm/cost_baseline.toml", "safe_arm", plan.classes)

    assert {name for name, _, _ in baseline.maxima} == {one.name for one in plan.classes}
