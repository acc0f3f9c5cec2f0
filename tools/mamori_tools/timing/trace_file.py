# SPDX-License-Identifier: Apache-2.0
"""Writes a run as a Perfetto trace: windows, steps, threads on the processors, states and losses on one time axis.

@satisfies SWR-TIM-047      Design: docs/design/timing.md#trace
Source: https://perfetto.dev/docs/reference/synthetic-track-event
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from perfetto.protos.perfetto.trace.perfetto_trace_pb2 import Trace, TracePacket, TrackEvent

from mamori_tools.timing.analysis import Miss
from mamori_tools.timing.reader import COMPLETED, NOT_BACK, OVERRUN, PASSES, Array, Measurement
from mamori_tools.timing.switches import IDLE, NO_STATE, UNKNOWN_THREAD
from mamori_trace.base.whole_file import whole_file

FILE = "timing.perfetto-trace"
CYCLES_FIRST = 500
CYCLES_AROUND = 5
CYCLES_MAX = 2_000
"""Stored cycles: the first ones, then those around each loss, up to a maximum, because a trace of minutes takes minutes to write and open."""
SEQUENCE = 1
SYSTEM_UUID = 1


@dataclass(frozen=True)
class Span:
    """An interval [ns] on a track; an instant if `end_ns` is None. `notes` are shown when it is selected."""

    begin_ns: int
    end_ns: int | None
    name: str
    notes: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Track:
    name: str
    spans: Sequence[Span] = field(default_factory=tuple)


def choose_cycles(run: Measurement, misses: Sequence[Miss]) -> Array:
    """@return the stored cycles, ascending."""
    cycles = np.unique(run.openings["release_ns"] // run.table.frame_ns)
    chosen = dict.fromkeys(cycles[:CYCLES_FIRST].tolist())
    for miss in misses:
        near = cycles[np.searchsorted(cycles, miss.cycle - CYCLES_AROUND) : np.searchsorted(cycles, miss.cycle + CYCLES_AROUND, side="right")]
        if len(chosen.keys() | set(near.tolist())) > CYCLES_MAX:
            break
        chosen.update(dict.fromkeys(near.tolist()))
    return np.array(sorted(chosen), np.int64)


def list_tracks(run: Measurement, misses: Sequence[Miss]) -> list[Track]:
    """Tracks of the chosen cycles. Spans of one track do not overlap."""
    cycles = choose_cycles(run, misses)
    tracks = [Track(f"windows of {run.table.core_title(core)}", _list_windows(run, core, cycles)) for core in sorted({one.core for one in run.table.windows})]
    tracks += [Track(f"steps of window '{window.name}'", _list_steps(run, index, cycles)) for index, window in enumerate(run.table.windows)]
    if run.switches is not None:
        tracks += [Track(f"processor {log.processor}", _list_threads(run, core, cycles)) for core, log in enumerate(run.switches.cores)]
        if run.states:
            tracks.append(Track("state", _list_states(run)))
    marks = [Span(miss.release_ns, None, f"{miss.outcome}: {miss.verdict}", (("window", miss.window), ("component", miss.component or "-"),
             ("reason", miss.reason))) for miss in misses if miss.cycle in set(cycles.tolist())]  # fmt: skip
    return [one for one in (*tracks, Track("losses", marks)) if one.spans]


def _list_windows(run: Measurement, core: int, cycles: Array) -> list[Span]:
    spans = []
    numbers = [index for index, window in enumerate(run.table.windows) if window.core == core]
    rows = run.openings[np.isin(run.openings["window"], numbers) & np.isin(run.openings["release_ns"] // run.table.frame_ns, cycles)]
    for row in rows[np.argsort(rows["woke_ns"], kind="stable")]:
        if row["outcome"] in (COMPLETED, OVERRUN):
            late = (int(row["woke_ns"]) - int(row["release_ns"])) / 1e3
            spans.append(Span(int(row["woke_ns"]), int(row["closed_ns"]), run.table.windows[int(row["window"])].name, (("late [us]", f"{late:.1f}"),)))
    return spans


def _list_steps(run: Measurement, window: int, cycles: Array) -> list[Span]:
    of_it = run.openings["window"][run.opening_of_step] == window
    rows = run.steps[of_it & np.isin(run.steps["release_ns"] // run.table.frame_ns, cycles)]
    last = int(run.openings["closed_ns"].max())
    return [Span(int(row["start_ns"]), last if row["end_ns"] == NOT_BACK else int(row["end_ns"]), run.table.component_name(int(row["component"])),
                 (("pass", PASSES[int(row["pass"])]),)) for row in rows[np.argsort(rows["start_ns"], kind="stable")]]  # fmt: skip


def _list_threads(run: Measurement, core: int, cycles: Array) -> list[Span]:
    assert run.switches is not None
    log = run.switches.cores[core]
    names = dict(zip(log.window_threads, (f"window '{one.name}'" for one in run.table.windows), strict=True)) | {log.runner: f"runner of core {core}"}
    rows = log.slices[np.isin(log.slices["end_ns"] // run.table.frame_ns, cycles)]
    return [Span(int(row["begin_ns"]), int(row["end_ns"]), names.get(int(row["thread"])) or
                 ("not recorded" if row["thread"] == UNKNOWN_THREAD else run.switches.name(int(row["thread"]), int(row["process"]))))
            for row in rows if row["process"] != IDLE]  # fmt: skip


def _list_states(run: Measurement) -> list[Span]:
    assert run.switches is not None
    order = np.argsort(run.openings["release_ns"], kind="stable")
    states, instants = run.switches.window_use["state"][order], run.openings["release_ns"][order]
    begins = np.flatnonzero(np.concatenate(([True], states[1:] != states[:-1])))
    ends = np.concatenate((instants[begins[1:]], run.openings["closed_ns"].max(keepdims=True)))
    return [Span(int(instants[begin]), int(end), run.states[int(states[begin])].name)
            for begin, end in zip(begins, ends, strict=True) if states[begin] != NO_STATE]  # fmt: skip


def make_packets(system: str, tracks: Sequence[Track]) -> Iterator[TracePacket]:
    """The messages of a trace. Instants before the epoch are shifted to it."""
    yield _make_descriptor(SYSTEM_UUID, system, 0)
    for number, track in enumerate(tracks, start=SYSTEM_UUID + 1):
        yield _make_descriptor(number, track.name, SYSTEM_UUID)
        for span in track.spans:
            yield _make_event(number, span.begin_ns, TrackEvent.TYPE_SLICE_BEGIN if span.end_ns is not None else TrackEvent.TYPE_INSTANT, span)
            if span.end_ns is not None:
                yield _make_event(number, span.end_ns, TrackEvent.TYPE_SLICE_END, None)


def _make_descriptor(uuid: int, name: str, parent: int) -> TracePacket:
    packet = TracePacket(trusted_packet_sequence_id=SEQUENCE)
    packet.track_descriptor.uuid = uuid
    packet.track_descriptor.name = name
    if parent:
        packet.track_descriptor.parent_uuid = parent
    return packet


def _make_event(track: int, instant_ns: int, kind: TrackEvent.Type, span: Span | None) -> TracePacket:
    packet = TracePacket(trusted_packet_sequence_id=SEQUENCE, timestamp=max(0, instant_ns))
    packet.track_event.track_uuid = track
    packet.track_event.type = kind
    if span is not None:
        packet.track_event.name = span.name
        for key, text in span.notes:
            note = packet.track_event.debug_annotations.add()
            note.name, note.string_value = key, text
    return packet


def write_trace(path: Path, system: str, run: Measurement, misses: Sequence[Miss]) -> Path:
    """Writes the trace atomically. @return its path."""
    with whole_file(path) as part, part.open("wb") as out:
        for packet in make_packets(system, list_tracks(run, misses)):
            # Serialised messages of one packet each add up to one trace.
            out.write(Trace(packet=[packet]).SerializeToString())
    return path


def read_trace(path: Path) -> Trace:
    """@raise google.protobuf.message.DecodeError for a damaged trace."""
    trace = Trace()
    trace.ParseFromString(path.read_bytes())
    return trace
