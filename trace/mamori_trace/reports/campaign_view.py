# SPDX-License-Identifier: Apache-2.0
"""Turns campaign cases into table rows and figures.

@satisfies SWR-TRC-012, SWR-TRC-110, SWR-TRC-111      Design: docs/design/trace.md#plots
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, get_shown_path
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.evidence import PASSED, CampaignCase
from mamori_trace.model.project import Project
from mamori_trace.readers.series import JOINTS, Series, read_series

if TYPE_CHECKING:
    from mamori_trace.reports.plots import Drawing, Marks

ABSENT = "–"
_ORIGIN = (("trace hash", "trace_hash"), ("seed", "seed"), ("motion", "motion"), ("model", "model"), ("built by", "compiler"))


@dataclass(slots=True)
class CaseView:
    """One row of the campaign table and its figure. Texts are formatted; `share` is reaction time divided by its bound."""

    case: CampaignCase
    anchor: str
    fault: str
    where: str
    when: str
    reaction_time: str
    share: float | None
    standstill: str
    travel: str
    drift: str
    peak_speed: str
    detected: str
    reaction: str
    final_state: str
    origin: str
    checks: list[tuple[str, str, str, bool]]
    drawings: list[Drawing] = field(default_factory=list)
    keys: list[tuple[str, str]] = field(default_factory=list)
    """Key of the drawings: text and colour."""
    plot_problem: str = ""

    @property
    def facts(self) -> list[tuple[str, str]]:
        """Measured values of the run: names and values; missing ones are omitted."""
        rows = (("Fault", self.fault if self.where == ABSENT else f"{self.fault}, {self.where}"), ("Fault at", self.when),
                ("Detected as", self.detected), ("Reaction", self.reaction or ABSENT), ("Reaction time", self.reaction_time),
                ("Standstill after", self.standstill), ("Travel until standstill", self.travel), ("Drift at standstill", self.drift),
                ("Highest speed, of its limit", self.peak_speed), ("Final state", self.final_state))  # fmt: skip
        return [(name, value) for name, value in rows if value != ABSENT]


@dataclass(slots=True)
class ScenarioView:
    """Cases of one scenario; one fold of the page contains all their figures."""

    name: str
    title: str
    cases: list[CaseView]

    @property
    def passed(self) -> int:
        return sum(view.case.status == PASSED for view in self.cases)

    @property
    def is_bad(self) -> bool:
        return self.passed < len(self.cases)


def make_scenario_views(project: Project, problems: list[Problem]) -> list[ScenarioView]:
    """Scenarios and cases in the order of the campaign. A series that cannot be drawn becomes a problem."""
    groups: dict[str, list[CaseView]] = defaultdict(list)
    base = Path(project.evidence.folder) / "campaign"
    for index, case in enumerate(project.evidence.cases):
        view = make_case_view(case, base, index)
        if view.plot_problem:
            place = Place(get_shown_path(base / case.folder / "series.csv", project.root), 1)
            problems.append(Problem(UNREADABLE, place, f"{view.plot_problem}; run the campaign again"))
        groups[case.scenario].append(view)
    return [ScenarioView(name, _get_common_title(views), views) for name, views in groups.items()]


def make_case_view(case: CampaignCase, base: Path, index: int = 0) -> CaseView:
    """One case with its drawings. `base`: folder of the campaign; `index` makes ids unique in a page. `plot_problem`: why the series cannot
    be drawn."""
    from mamori_trace.reports.plots import draw_case  # loads matplotlib, which takes longer than a small report

    view = _describe_case(case, index)
    path = base / case.folder / "series.csv"
    try:
        if not path.resolve().is_relative_to(base.resolve()):
            raise FormatError(f"folder {case.folder!r} lies outside of the campaign")
        series, marks = read_series(path), _find_marks(case)
        view.drawings = draw_case(series, marks, f"p{index}", f"{case.id}: {case.title}")
        view.keys = _list_keys(series, marks)
    except FormatError as error:
        view.plot_problem = str(error)
    return view


def list_filled(scenarios: list[ScenarioView]) -> set[str]:
    """Names of the columns that have a value in at least one case."""
    views = [view for scenario in scenarios for view in scenario.cases]
    names = ("when", "detected", "reaction_time", "standstill", "travel", "drift", "peak_speed", "final_state")
    filled = {name for name in names if any(getattr(view, name) != ABSENT for view in views)}
    return filled | ({"detected"} if any(view.reaction for view in views) else set())


def _list_keys(series: Series, marks: Marks) -> list[tuple[str, str]]:
    from mamori_trace.reports.plots import JOINT_COLOURS, list_state_colours

    instants = [(f"{name} {time_s:.3f} s", colour) for name, time_s, colour in marks.list_instants()]
    joints = [(f"J{index + 1}", colour) for index, colour in enumerate(JOINT_COLOURS)]
    return [*instants, *list_state_colours(series).items(), *joints]


def find_slowest(scenarios: list[ScenarioView]) -> CaseView | None:
    """The case with the smallest margin to its bound."""
    views = [view for scenario in scenarios for view in scenario.cases if view.share is not None]
    return max(views, key=lambda view: (view.share, view.case.id), default=None)


def _find_marks(case: CampaignCase) -> Marks:
    """Raises FormatError if the run has no speed limits."""
    from mamori_trace.reports.plots import Marks

    limits = _get_numbers(_get_table(case.run, "physics"), "speed_limit_rad_s")
    if len(limits) != JOINTS or min(limits) <= 0:
        raise FormatError(f"the run of {case.id} tells no speed limits of {JOINTS} joints")
    fault = _get_table(case.run, "fault")
    joint = fault.get("joint") if isinstance(fault.get("joint"), int) else None
    return Marks(_get_number(fault, "at_s"), _get_number(case.run, "reacted_at_s"), _get_number(case.run, "standstill_at_s"), limits, joint)


def _get_common_title(views: list[CaseView]) -> str:
    titles = list(dict.fromkeys(view.case.title for view in views))
    return "; ".join(titles)


def _describe_case(case: CampaignCase, index: int) -> CaseView:
    run = case.run
    fault = _get_table(run, "fault") or None
    at_s = _get_number(fault, "at_s")
    physics = _get_table(run, "physics")
    reaction_s = _subtract(_get_number(run, "reacted_at_s"), at_s)
    bound_s = _get_number(case.expected, "within_s")
    standstill_s = _subtract(_get_number(run, "standstill_at_s"), at_s)
    stopped = reaction_s is not None or standstill_s is not None
    return CaseView(
        case=case,
        anchor=f"case-{index}-{re.sub(r'[^A-Za-z0-9_-]+', '-', case.id)}",
        fault=str(fault.get("kind", ABSENT)).replace("_", " ") if fault else "none",
        where=_describe_where(fault),
        when=ABSENT if at_s is None else f"{at_s:.3f} s",
        reaction_time=_describe_reaction(reaction_s, bound_s, run),
        share=reaction_s / bound_s if reaction_s is not None and bound_s else None,
        standstill=ABSENT if standstill_s is None else f"{1e3 * standstill_s:.0f} ms",
        # An arm that continued neither stopped nor held its position.
        travel=_format_milli(max(_get_numbers(physics, "stop_travel_rad"), default=None)) if stopped else ABSENT,
        drift=_format_milli(_get_number(physics, "hold_drift_rad")) if stopped else ABSENT,
        peak_speed=_describe_peak_speed(physics),
        detected=str(run.get("detected_fault") or ABSENT),
        reaction=str(run.get("reaction") or ""),
        final_state=str(run.get("final_state") or ABSENT),
        origin=", ".join(f"{name} {run[key]}" for name, key in _ORIGIN if run.get(key) is not None),
        checks=[
            (str(check.get("name", ABSENT)), str(check.get("wanted", ABSENT)), str(check.get("measured", ABSENT)), check.get("passed") is True)
            for check in case.checks
        ],
    )


def _describe_where(fault: dict[str, Any] | None) -> str:
    """Joints count from 1, in run.json too."""
    parts = []
    if fault and isinstance(fault.get("joint"), int):
        parts.append(f"joint {fault['joint']}")
    if fault and fault.get("channel"):
        channel = str(fault["channel"])
        parts.append("both channels" if channel == "both" else f"channel {channel.upper()}")
    return ", ".join(parts) or ABSENT


def _describe_reaction(reaction_s: float | None, bound_s: float | None, run: dict[str, Any]) -> str:
    if reaction_s is None:
        return "watchdog" if run.get("watchdog_bitten") else ABSENT
    return f"{1e3 * reaction_s:.0f} of {1e3 * bound_s:.0f} ms" if bound_s else f"{1e3 * reaction_s:.0f} ms"


def _describe_peak_speed(physics: dict[str, Any]) -> str:
    speeds, limits = _get_numbers(physics, "max_speed_rad_s"), _get_numbers(physics, "speed_limit_rad_s")
    if not speeds or len(speeds) != len(limits) or not all(limits):
        return ABSENT
    return f"{100 * max(speed / limit for speed, limit in zip(speeds, limits, strict=True)):.0f} %"


def _get_number(table: dict[str, Any] | None, key: str) -> float | None:
    value = (table or {}).get(key)
    return float(value) if _is_number(value) else None


def _get_numbers(table: dict[str, Any], key: str) -> list[float]:
    """The list of numbers under `key`, or an empty one for any other value."""
    values = table.get(key)
    return list(map(float, values)) if isinstance(values, list) and all(map(_is_number, values)) else []


def _get_table(table: dict[str, Any], key: str) -> dict[str, Any]:
    value = table.get(key)
    return value if isinstance(value, dict) else {}


def _is_number(value: object) -> TypeGuard[int | float]:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _subtract(later: float | None, earlier: float | None) -> float | None:
    return None if later is None or earlier is None else later - earlier


def _format_milli(value_rad: float | None) -> str:
    if value_rad is None:
        return ABSENT
    return f"{1e3 * value_rad:.1f} mrad" if value_rad >= 1e-3 else f"{1e3 * value_rad:.3f} mrad"
