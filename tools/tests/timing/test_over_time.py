# SPDX-License-Identifier: Apache-2.0
# Goal: the trace and the picture over time show the run as it was measured. Method: a small run with one loss; the trace is read back with
# the classes of its format, the picture by the texts of its SVG and by its curves.
from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from perfetto.protos.perfetto.trace.perfetto_trace_pb2 import Trace, TrackEvent
from timing_run import COMPONENTS, make_program, make_rows, make_run, make_switches, make_table, prepare, write_run, write_switches

from mamori_tools.command.main import main
from mamori_tools.timing.analysis import Miss, list_misses, list_windows
from mamori_tools.timing.reader import MISSED, Measurement, read_measurement
from mamori_tools.timing.time_picture import COLUMNS, make_curve, make_time_figure
from mamori_tools.timing.trace_file import CYCLES_AROUND, CYCLES_FIRST, CYCLES_MAX, choose_cycles, list_tracks, read_trace, write_trace
from mamori_tools.timing.verdict import OUTSIDE

RUNNER, OTHER = 11, 41
MS = 1_000_000


def read(folder: Path, cycles: int = 20, lost: int = 7) -> Measurement:
    """The control window of instance `lost` is skipped because another process ran. The state changes in the middle of the run."""
    table = make_table()
    openings, steps = make_rows(table, [row[3] for row in COMPONENTS], cycles, first_frame=0)
    row = int(np.flatnonzero(openings["window"] == 1)[lost])
    release = int(openings["release_ns"][row])
    openings["outcome"][row] = MISSED
    openings["woke_ns"][row] = openings["closed_ns"][row] = release + 450_000
    steps = steps[~((steps["component"] == 2) & (steps["release_ns"] == release))]
    switches = make_switches([{"thread": OTHER, "process": 41, "kind": 1, "priority": 0, "name": "hog"}], windows=3)
    states = [{"name": "starting", "is_operating": False}, {"name": "moving", "is_operating": True}]
    write_run(folder, table, openings, steps, make_run(table, cycles, cycles) | {"switches": switches, "states": states})
    write_switches(folder, len(openings), [(1000, 0, 0)] * len(steps),
                   [(release - 5_000, release + 440_000, OTHER, 41, 0), (release + 440_000, release + 460_000, RUNNER, 10, 1)],
                   [int(instant >= cycles // 2 * MS) for instant in openings["release_ns"]])  # fmt: skip
    return read_measurement(folder)


def list_events(trace: Trace, track: str) -> list[TrackEvent]:
    [uuid] = [one.track_descriptor.uuid for one in trace.packet if one.track_descriptor.name == track]
    return [one.track_event for one in trace.packet if one.track_event.track_uuid == uuid]


@pytest.mark.verifies("SWR-TIM-047", technique="interface")
def test_trace_is_read_back_with_the_classes_of_its_format(tmp_path: Path) -> None:
    run = read(tmp_path / "run")
    trace = read_trace(write_trace(tmp_path / "out", "arm", run, list_misses(run)))

    names = {one.track_descriptor.name for one in trace.packet if one.HasField("track_descriptor")}
    assert names == {"arm", "windows of core 0", "steps of window 'sense'", "steps of window 'control'", "steps of window 'act'", "processor 0",
                     "state", "losses"}  # fmt: skip
    windows = list_events(trace, "windows of core 0")
    assert [event.name for event in windows[:2]] == ["sense", ""]
    assert [event.type for event in windows[:2]] == [TrackEvent.TYPE_SLICE_BEGIN, TrackEvent.TYPE_SLICE_END]
    assert len(windows) == 2 * (3 * 20 - 1)
    [loss] = list_events(trace, "losses")
    assert (loss.type, loss.name) == (TrackEvent.TYPE_INSTANT, "missed: outside")
    assert {note.name: note.string_value for note in loss.debug_annotations}["reason"].endswith("process 41 ('hog') ran for 440.0 us")
    assert [event.name for event in list_events(trace, "processor 0") if event.name] == ["process 41 ('hog')", "runner of core 0"]
    assert [event.name for event in list_events(trace, "state") if event.name] == ["starting", "moving"]
    instants = [one.timestamp for one in trace.packet if one.track_event.track_uuid == windows[0].track_uuid]
    assert instants == sorted(instants) and instants[0] == int(run.openings["woke_ns"].min())


@pytest.mark.verifies("SWR-TIM-047", technique="boundary_values")
def test_long_run_is_stored_around_its_losses_only(tmp_path: Path) -> None:
    run = read(tmp_path, cycles=3000, lost=2500)
    misses = list_misses(run)

    chosen = choose_cycles(run, misses)
    assert chosen.tolist() == [*range(CYCLES_FIRST), *range(2500 - CYCLES_AROUND, 2500 + CYCLES_AROUND + 1)]
    many = choose_cycles(run, [replace(misses[0], cycle=cycle) for cycle in range(500, 2990, 12)])
    assert CYCLES_MAX - 11 < len(many) <= CYCLES_MAX
    assert len(list_tracks(run, misses)[0].spans) == 3 * len(chosen) - 1


@pytest.mark.verifies("SWR-TIM-047")
def test_command_writes_the_trace_next_to_the_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mamori_tools.timing.picture.draw_report", lambda report, folder: [])
    prepare(tmp_path)
    assert main(["timing", str(make_program(tmp_path)), "--cycles", "100", "--out", str(tmp_path / "out")]) == 0

    trace = read_trace(tmp_path / "out" / "timing.perfetto-trace")
    count = json.loads((tmp_path / "out" / "timing.json").read_text(encoding="utf-8"))["windows"][0]["outcomes"]["completed"]
    assert sum(event.name == "sense" for event in list_events(trace, "windows of core 0")) == count == 100


@pytest.mark.verifies("SWR-TIM-048")
def test_picture_over_time_shows_curves_limits_and_verdicts(tmp_path: Path) -> None:
    run = read(tmp_path / "run")
    figure = make_time_figure(run, list_windows(run), list_misses(run), "subtitle", ["MARK"])

    figure.savefig(tmp_path / "out.svg")
    texts = re.findall(r"<!-- (.*?) -->", (tmp_path / "out.svg").read_text(encoding="utf-8"))
    for wanted in ("window sense", "window control", "window act", "lateness", "response", "window length", "lost: outside (1)",
                   "time of the run [s]", "MARK"):  # fmt: skip
        assert wanted in texts


@pytest.mark.verifies("SWR-TIM-048", technique="boundary_values")
@pytest.mark.parametrize("count", [1, COLUMNS, COLUMNS + 1, 10 * COLUMNS])
def test_curve_keeps_each_maximum_at_its_instant(count: int) -> None:
    releases = 5 * MS + np.arange(count) * MS
    values = np.full(count, 10)
    values[count // 2] = 99

    curve = make_curve(releases, values, int(releases[0]), int(releases[-1]))

    assert len(curve.values_ns) <= COLUMNS
    assert curve.values_ns.max() == 99
    assert curve.times_s[int(np.argmax(curve.values_ns))] == pytest.approx(count // 2 / 1000)


@pytest.mark.verifies("SWR-TIM-048", technique="equivalence_classes")
def test_run_of_a_single_instant_can_be_drawn(tmp_path: Path) -> None:
    run = read(tmp_path / "run", cycles=1, lost=0)
    miss = Miss(0, 0, "sense", "missed", None, 0, "", OUTSIDE, "", 0)

    make_time_figure(run, list_windows(run), [miss], "", []).savefig(tmp_path / "out.png")
    assert (tmp_path / "out.png").stat().st_size > 0
