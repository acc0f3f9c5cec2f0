# SPDX-License-Identifier: Apache-2.0
# Goal: pictures are readable for any measurement, their curves are exact, and they contain marks and limits.
# Method: rows of every kind are drawn, and the texts of the SVG are checked.
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from timing_run import COMPONENTS, make_rows, make_run, make_table, write_run

from mamori_tools.timing.environment import collect_setting, collect_state
from mamori_tools.timing.picture import POINTS_MAX, ROWS_MAX, Limit, Row, calc_tail, draw_report, make_figure
from mamori_tools.timing.reader import read_measurement
from mamori_tools.timing.report import Report, make_report
from mamori_tools.timing.text import format_us, make_printable, make_text, shorten


@pytest.fixture
def report(tmp_path: Path) -> Report:
    table = make_table()
    openings, steps = make_rows(table, [row[3] for row in COMPONENTS], 50)
    run = read_measurement(write_run(tmp_path / "run", table, openings, steps, make_run(table, 80, 50, ("priority",))))
    return make_report("arm", run, {"setting": collect_setting(), "before": collect_state(), "after": collect_state()}, True, True, ["it broke"])


def count_rows(rows: list[Row]) -> tuple[int, list[str]]:
    """@return axes of the figure, and its texts outside them."""
    figure = make_figure("title", rows, "subtitle", ["MARK"])
    return len(figure.axes), [text.get_text() for text in figure.texts]


@pytest.mark.verifies("SWR-TIM-027")
def test_each_picture_is_written_twice_with_marks_limits_and_units(report: Report, tmp_path: Path) -> None:
    names = [path.name for path in draw_report(report, tmp_path)]

    assert names == [f"{name}{suffix}" for name in ("release_lateness", "execution_time", "chain_latency", "over_time") for suffix in (".svg", ".png")]
    svg = (tmp_path / "execution_time.svg").read_text(encoding="utf-8")
    texts = re.findall(r"<!-- (.*?) -->", svg)
    for wanted in ("PARTIAL: stopped after 50 of 80 cycles", "WITHOUT REAL-TIME PRIVILEGES: denied: priority (Operation not permitted)",
                   "declared worst case 40 µs", "budget of its window 250 µs", "µs"):  # fmt: skip
        assert wanted in texts
    assert not list(tmp_path.glob(".*part*"))


@pytest.mark.verifies("SWR-TIM-027", technique="boundary_values")
@pytest.mark.parametrize("values", [[0], [1], [5_000], [0, 0, 0], [1, 10**12], [7] * 1000 + [8]])
def test_any_values_can_be_drawn(values: list[int], tmp_path: Path) -> None:
    figure = make_figure("title", [Row("row", np.array(values), (Limit("limit", 3_000),))], "subtitle", [])

    figure.savefig(tmp_path / "out.png")
    assert (tmp_path / "out.png").stat().st_size > 0


@pytest.mark.verifies("SWR-TIM-027", technique="error_guessing")
def test_names_with_markup_and_control_letters_are_shown_as_they_are(tmp_path: Path) -> None:
    figure = make_figure("title", [Row("a$x^{_}$ \x1b[31m", np.array([5_000]))], "$\\bad{$", [])

    figure.savefig(tmp_path / "out.svg")
    assert "a$x^{_}$ \N{REPLACEMENT CHARACTER}[31m   (n = 1)" in figure.axes[0].get_title(loc="left")
    assert make_printable("a\x1b\nb") == "a\N{REPLACEMENT CHARACTER}\nb"


@pytest.mark.verifies("SWR-TIM-027", technique="boundary_values")
@pytest.mark.parametrize(("count", "is_cut"), [(ROWS_MAX, False), (ROWS_MAX + 1, True)])
def test_the_worst_rows_are_drawn_when_there_are_many(count: int, is_cut: bool) -> None:
    axes, texts = count_rows([Row(f"row {index}", np.array([1000 + index])) for index in range(count)])

    assert axes == 2 * ROWS_MAX
    assert any(text.startswith(f"the {ROWS_MAX} of {count}") for text in texts) == is_cut


@pytest.mark.verifies("SWR-TIM-027", technique="boundary_values")
def test_tail_is_the_exact_share_above_each_value() -> None:
    times, share = calc_tail(np.array([40, 10, 20, 20]))

    assert times.tolist() == [10, 20, 40]
    assert share.tolist() == [0.75, 0.25, 0.25]  # no value is above 40: it has its own share


@pytest.mark.verifies("SWR-TIM-027", technique="boundary_values")
def test_tail_of_many_values_keeps_all_of_its_end_and_stays_small() -> None:
    values = np.random.default_rng(3).permutation(np.arange(1, 100_001))
    times, share = calc_tail(values)

    assert len(times) <= POINTS_MAX
    assert times[-1000:].tolist() == list(range(99_001, 100_001))
    assert np.allclose(share[:-1], (100_000 - times[:-1]) / 100_000)
    assert times[0] == 1


@pytest.mark.verifies("SWR-TIM-026")
def test_screen_and_file_tell_marks_findings_and_figures(report: Report) -> None:
    for is_whole in (False, True):
        said = make_text(report, is_whole)
        assert said.startswith("*** PARTIAL: stopped after 50 of 80 cycles ***\n*** WITHOUT REAL-TIME PRIVILEGES")
        assert "with stress-ng" in said and "privileges: priority denied, processor granted" in said
        assert "reader > monitor > controller > drive" in said
        assert said.endswith("finding: it broke\nfindings: 1\n")
    assert len(make_text(report, is_whole=False).splitlines()) <= 40
    assert "budget may grow" in make_text(report, is_whole=True)


@pytest.mark.verifies("SWR-TIM-026", technique="boundary_values")
@pytest.mark.parametrize(("ns", "text"), [(None, "-"), (0, "0"), (1234, "1.23"), (12_345, "12.3"), (250_000, "250"), (1_234_567, "1235"), (-1500, "-1.50")])
def test_times_have_the_digits_that_count(ns: int | None, text: str) -> None:
    assert format_us(ns) == text


@pytest.mark.verifies("SWR-TIM-026", technique="boundary_values")
def test_long_name_keeps_both_ends() -> None:
    assert shorten("a" * 90) == "a" * 90
    assert shorten("begin" + "x" * 90 + "end").startswith("begin") and shorten("begin" + "x" * 90 + "end").endswith("end")
    assert len(shorten("x" * 100)) == 90


@pytest.mark.verifies("SWR-TIM-026", technique="boundary_values")
def test_each_member_of_a_long_chain_keeps_its_beginning() -> None:
    one, other = "arm_reader > joint_monitor > motion_controller > gate", "arm_reader > path_planner > motion_controller > gate"
    assert shorten(one, 54) == one
    assert shorten(one, 52) == "arm_reader > joint_monitor > motion_control.. > gate"
    assert shorten(one, 40) == "arm_rea.. > joint_m.. > motion_.. > gate"
    assert shorten(one, 40) != shorten(other, 40)
    assert len(shorten(" > ".join(["member"] * 20), 40)) == 40, "more members than fit: both ends"
