# SPDX-License-Identifier: Apache-2.0
"""Times per state of the system, and the instant at which it left its operating state.

@satisfies SWR-TIM-046      Design: docs/design/timing.md#states
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mamori_tools.timing.analysis import Distribution, calc_execution, calc_lateness, describe
from mamori_tools.timing.reader import COMPLETED, OVERRUN, Array, Measurement
from mamori_tools.timing.switches import NO_STATE


@dataclass(frozen=True)
class StateRow:
    """One window in one state. `response`: planned start to end."""

    state: str
    is_operating: bool
    window: str
    count: int
    lateness: Distribution | None
    response: Distribution | None


@dataclass(frozen=True)
class StateComponent:
    """Execution time of one component in one state."""

    state: str
    component: str
    execution: Distribution


def list_states(run: Measurement) -> list[StateRow]:
    """The states that occurred, window by window; empty for a system without states."""
    rows = []
    for index, state in enumerate(run.states):
        for number, window in enumerate(run.table.windows):
            of_it = _states(run, number) == index
            if of_it.any():
                openings = run.openings[run.rows_of(number)][of_it]
                late = calc_lateness(run, number)
                ran = openings[np.isin(openings["outcome"], (COMPLETED, OVERRUN))]
                rows.append(StateRow(state.name, state.is_operating, window.name, int(of_it.sum()),
                                     describe(late.values[np.isin(late.releases, openings["release_ns"])]),
                                     describe(ran["closed_ns"] - ran["release_ns"])))  # fmt: skip
    return rows


def list_state_components(run: Measurement) -> list[StateComponent]:
    """Components in the states in which they ran."""
    rows = []
    for index, state in enumerate(run.states):
        for number, component in enumerate(run.table.components):
            if component.window is not None:
                series, _ = calc_execution(run, number)
                releases = run.openings["release_ns"][run.rows_of(component.window)][_states(run, component.window) == index]
                found = describe(series.values[np.isin(series.releases, releases)])
                rows += [] if found is None else [StateComponent(state.name, component.name, found)]
    return rows


def _states(run: Measurement, window: int) -> Array:
    """State of each instance of a window."""
    if run.switches is None:
        return np.full(0, NO_STATE, np.uint32)
    return np.asarray(run.switches.window_use["state"][run.rows_of(window)])


def list_state_findings(run: Measurement) -> list[str]:
    """The first change from an operating state to another one."""
    if run.switches is None or not run.states:
        return []
    # A core asks for the state when its window ends; windows of other cores may have been released before and end later.
    order = np.argsort(run.openings["closed_ns"], kind="stable")
    order = order[run.switches.window_use["state"][order] != NO_STATE]
    states = run.switches.window_use["state"][order].astype(np.int64)
    is_operating = np.array([state.is_operating for state in run.states])[states]
    left = np.flatnonzero(is_operating[:-1] & ~is_operating[1:])
    if not len(left):
        return []
    row = int(left[0]) + 1
    cycle = int(run.openings["release_ns"][order[row]]) // run.table.frame_ns
    return [f"the system left its operating state '{run.states[int(states[row - 1])].name}' in cycle {cycle}: '{run.states[int(states[row])].name}'"]


def list_state_notes(run: Measurement) -> list[str]:
    """A system that was never in an operating state."""
    if not run.states or any(row.is_operating for row in list_states(run)):
        return []
    return ["the system was never in an operating state during the run"]
