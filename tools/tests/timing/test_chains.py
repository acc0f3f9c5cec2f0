# SPDX-License-Identifier: Apache-2.0
# Goal: event chains follow the values, their virtual times are exact, and measurements are compared with them.
# Method: small tables with manually calculated results; measured runs with one fault.
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from timing_run import COMPONENTS, CONNECTIONS, WINDOWS, make_rows, make_run, make_table, write_run

from mamori_tools.table.document import Table, read_table
from mamori_tools.timing.chain_times import list_chains, list_violations
from mamori_tools.timing.chains import calc_core_gap, calc_response, find_chains
from mamori_tools.timing.reader import OVERRUN, read_measurement

US = 1000
TIMES_US = [row[3] for row in COMPONENTS]


def load(folder: Path, windows: Sequence[tuple[Any, ...]] = WINDOWS, components: Sequence[tuple[Any, ...]] = COMPONENTS,
         connections: Sequence[tuple[int, int, str]] = CONNECTIONS, frame_us: int = 1000, **more: Any) -> Table:  # fmt: skip
    table = {**make_table(windows, components, connections, frame_us), **more}
    openings, steps = make_rows(table, [1.0] * len(components), 3)
    return read_table(write_run(folder, table, openings, steps, make_run(table, 3, 3)) / "table.json")


def name_chains(table: Table) -> list[str]:
    return [chain.name(table) for chain in find_chains(table).chains]


@pytest.mark.verifies("SWR-TIM-015")
def test_chain_leads_from_what_nothing_feeds_to_what_feeds_nothing(tmp_path: Path) -> None:
    table = load(tmp_path)

    assert name_chains(table) == ["reader > monitor > controller > drive"]
    assert find_chains(table).note == "feedback is not followed: drive > monitor"


@pytest.mark.verifies("SWR-TIM-015", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("connections", "names"),
    [((), []),
     (((3, 0, "next_frame"),), ["drive > reader"]),  # to an earlier component, but not feedback
     (((0, 2, "later_window"), (1, 2, "later_window"), (2, 3, "queue")), ["reader > controller > drive", "monitor > controller > drive"]),
     (((0, 1, "same_window"), (0, 3, "crossing"), (1, 3, "later_window")), ["reader > monitor > drive", "reader > drive"]),
     (((0, 0, "next_frame"), (0, 3, "later_window")), ["reader > drive"]),
     (((0, 2, "crossing"), (2, 0, "crossing")), ["reader > controller"])],
)  # fmt: skip
def test_ways_through_the_table(tmp_path: Path, connections: Sequence[tuple[int, int, str]], names: list[str]) -> None:
    assert name_chains(load(tmp_path, connections=connections)) == names


@pytest.mark.verifies("SWR-TIM-015", technique="equivalence_classes")
def test_connection_that_works_in_no_mode_is_no_way(tmp_path: Path) -> None:
    mode = {"name": "on", "safe": True, "initial": True, "components": [0, 1, 2, 3], "set": None}
    assert name_chains(load(tmp_path, modes=[mode])) == []


@pytest.mark.verifies("SWR-TIM-015", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("limit", "is_cut"), [(64, False), (63, True)])
def test_number_of_chains_is_bounded_and_a_cut_is_told(tmp_path: Path, limit: int, is_cut: bool) -> None:
    layers = [(f"l{layer}_{place}", 0, None, 1) for layer in range(6) for place in range(2)]  # 2^6 paths
    wires = [(2 * layer + a, 2 * layer + 2 + b, "same_window") for layer in range(5) for a in range(2) for b in range(2)]
    found = find_chains(load(tmp_path, components=layers, connections=wires), limit)

    assert len(found.chains) == min(64, limit)
    assert ("only the first 63 chains are shown" in found.note) == is_cut


@pytest.mark.verifies("SWR-TIM-016")
def test_response_is_from_the_opening_that_samples_to_the_planned_close_that_acts(tmp_path: Path) -> None:
    table = load(tmp_path)
    found = calc_response(table, find_chains(table).chains[0])

    assert (found.min_ns, found.max_ns, found.reaction_max_ns, found.worst_phase_ns) == (900 * US, 900 * US, 1900 * US, 0)


# A slow sampler feeds a fast actor: major frame 2000; sampler every 1000 at 0 (length 300); actor every 400 at 100 (length 50), core 1.
# Sample 0 is published at 300 and read at 500: 550 in total. Sample 1000 is published at 1300 and read at exactly 1300: 350.
RATES = (("slow", 0, 0, 300, 1000, 300), ("fast", 1, 100, 50, 400, 50))


@pytest.mark.verifies("SWR-TIM-016", technique="boundary_values")
def test_response_over_two_rates_is_that_of_each_sample(tmp_path: Path) -> None:
    table = load(tmp_path, RATES, (("a", 0, None, 1), ("b", 1, None, 1)), ((0, 1, "crossing"),), 2000)
    found = calc_response(table, find_chains(table).chains[0])

    assert (found.min_ns, found.max_ns) == (350 * US, 550 * US)
    # An event directly after 1000 waits for the sample at 2000, which takes 550.
    assert (found.reaction_max_ns, found.worst_phase_ns) == (1550 * US, 1000 * US)
    sampler, actor = found.sensitivity
    assert (sampler.reader_gap_ns, sampler.budget_growth_ns, sampler.response_per_length) == (0, 0, 0)
    assert (actor.reader_gap_ns, actor.response_per_length) == (None, 1)


@pytest.mark.verifies("SWR-TIM-016", technique="boundary_values")
def test_connection_against_the_order_of_its_window_arrives_one_opening_later(tmp_path: Path) -> None:
    table = load(tmp_path, connections=((1, 0, "next_frame"),))
    found = calc_response(table, find_chains(table).chains[0])

    assert found.max_ns == 1300 * US


@pytest.mark.verifies("SWR-TIM-016")
def test_sensitivity_shows_how_far_each_budget_may_grow(tmp_path: Path) -> None:
    table = load(tmp_path)
    rows = calc_response(table, find_chains(table).chains[0]).sensitivity

    assert [(row.window, row.budget_growth_ns // US, row.core_gap_ns // US, row.reader_gap_ns) for row in rows] == [
        ("sense", 50, 0, 0), ("control", 50, 100, 100 * US), ("act", 20, 100, None)]  # fmt: skip


@pytest.mark.verifies("SWR-TIM-016", technique="boundary_values")
def test_gap_to_the_next_window_holds_over_different_rates(tmp_path: Path) -> None:
    windows = (("a", 0, 0, 100, 500, 100), ("b", 0, 150, 50, 1000, 50), ("c", 1, 100, 900, 1000, 900))
    table = load(tmp_path, windows, (("x", 0, None, 1), ("y", 1, None, 1), ("z", 2, None, 1)), ())

    assert [calc_core_gap(table, index) // US for index in range(3)] == [50, 300, 100]


def measure(folder: Path, change: Any = None) -> Any:
    table = make_table()
    openings, steps = make_rows(table, TIMES_US, 20)
    if change is not None:
        change(openings, steps)
    return list_chains(read_measurement(write_run(folder, table, openings, steps, make_run(table, 20, 20))))[0][0]


@pytest.mark.verifies("SWR-TIM-017")
def test_latency_is_from_the_first_start_to_the_last_end(tmp_path: Path) -> None:
    table = make_table()
    _, steps = make_rows(table, TIMES_US, 20)
    first, last = (steps[steps["component"] == component] for component in (0, 3))
    row = measure(tmp_path)

    assert sorted(row.times.values.tolist()) == sorted((last["end_ns"] - first["start_ns"]).tolist())
    assert (row.measured.count, row.broken, row.violations) == (20, 0, ())


@pytest.mark.verifies("SWR-TIM-017", technique="error_guessing", polarity="violation")
def test_value_whose_window_overran_is_broken_and_not_measured(tmp_path: Path) -> None:
    def overrun(openings: Any, steps: Any) -> None:
        openings["outcome"][np.flatnonzero(openings["window"] == 1)[4]] = OVERRUN

    row = measure(tmp_path, overrun)

    assert (row.measured.count, row.broken) == (19, 1)


@pytest.mark.verifies("SWR-TIM-017", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("late_ns", "count"), [(0, 0), (1, 1)])
def test_value_that_takes_longer_than_virtual_time_is_a_finding_with_its_cycle(tmp_path: Path, late_ns: int, count: int) -> None:
    def delay(openings: Any, steps: Any) -> None:
        frame = 7_000_000
        steps["start_ns"][(steps["component"] == 0) & (steps["release_ns"] == frame)] = frame
        steps["end_ns"][(steps["component"] == 3) & (steps["release_ns"] == frame + 800_000)] = frame + 900_000 + late_ns

    row = measure(tmp_path, delay)

    assert len(row.violations) == count
    assert not count or (row.violations[0].cycle, row.violations[0].measured_ns, row.violations[0].bound_ns) == (7, 900_001, 900_000)
    assert len(list_violations([row])) == count
