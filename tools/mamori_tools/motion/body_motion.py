# SPDX-License-Identifier: Apache-2.0
"""BodyMotion YAML in the form of Choreonoid and OpenHRP tools.

First format: `type: BodyMotion` with a component `MultiValueSeq` / `JointPosition`. Second format (`formatVersion: 2`):
`type: CompositeSeq`, `content: BodyMotion` with `MultiValueSeq` / `JointDisplacement`. Keys of the parent (frameRate, numFrames) apply to a
component without its own. The file is read from parser events, because a walking motion of 7,000 frames has 300,000 events. Each sample
keeps its line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from mamori_tools.motion.motion import MAX_DURATION_S, MAX_SAMPLES, Samples
from mamori_tools.motion.number_text import parse_number
from mamori_trace.base.errors import InputError
from mamori_trace.base.marked_yaml import line_of, parse_events
from mamori_trace.base.text_file import SourceText

_JOINT_CONTENTS = frozenset({"JointPosition", "JointDisplacement"})

_INHERITED = ("frameRate", "numFrames")
"""Keys of the parent that apply to a component without its own."""

Header = dict[str, tuple[str, int]]
"""Scalar entries of a mapping: key -> (text, line)."""


@dataclass
class _Component:
    line: int
    header: Header = field(default_factory=dict)
    frames: list[tuple[int, list[str]]] | None = None
    frames_fault: InputError | None = None

    @property
    def content(self) -> str:
        # Early files name the key "purpose".
        return (self.header.get("content") or self.header.get("purpose") or ("", 0))[0]


def read_body_motion(source: SourceText, joints: int, surplus: int = 0) -> Samples:
    """Reads the joint positions of `joints` joints. One note names unused parts: `surplus` parts after the joints, which are
    optional in a file (`motion_columns_ignored` of the arm), and other components (root link, ZMP).

    Raises InputError: not a BodyMotion, newer format, no or two joint components, frameRate or numFrames missing or
    invalid, wrong number of joints, a truncated frame, a value that is not a finite number.
    """
    header, components, components_line = _read_document(source, _refuse_aliases(source))
    _check_kind(source, header)
    chosen = [component for component in components if component.content in _JOINT_CONTENTS]
    if not chosen:
        raise InputError("no component with content JointPosition; add one", source.path, components_line)
    if len(chosen) > 1:
        raise InputError(f"a second component {chosen[1].content}; keep one", source.path, chosen[1].line)
    inherited = {key: header[key] for key in _INHERITED if key in header}
    parts = _count_parts(source, chosen[0], joints, surplus)
    samples = _take_joints(source, chosen[0], inherited | chosen[0].header, joints, parts)
    notes = [f"not used: parts {joints + 1} to {parts} (no arm joints)"] if parts > joints else []
    others = [component.content or "without content" for component in components if component is not chosen[0]]
    if others:
        notes.append(f"components not used: {', '.join(others)}")
    if notes:
        samples.notes.append("; ".join(notes))
    return samples


def _count_parts(source: SourceText, component: _Component, joints: int, surplus: int) -> int:
    """Parts per frame: as the component declares, otherwise as in the first frame."""
    text, line = component.header.get("numParts", ("", 0))
    frames = component.frames or []
    if text:
        parts = int(text) if text.isdecimal() else 0
    elif frames:
        parts, line = len(frames[0][1]), frames[0][0]
    else:
        return joints
    if parts not in (joints, joints + surplus):
        what = f"numParts {text}" if text else f"{parts} joints per frame"
        more = f" (or {joints + surplus} parts with those the model ignores)" if surplus else ""
        raise InputError(f"{what}, the arm has {joints} joints{more}; give a motion of this arm", source.path, line)
    return parts


def _check_kind(source: SourceText, header: Header) -> None:
    kind, line = header.get("type", ("", 1))
    content = header.get("content", ("", 1))[0]
    version, version_line = header.get("formatVersion", ("1", line))
    if kind != "BodyMotion" and not (kind == "CompositeSeq" and content == "BodyMotion"):
        raise InputError(f"type is '{kind}', 'BodyMotion' is wanted; give a BodyMotion file", source.path, line)
    if version not in ("1", "1.0", "2", "2.0"):
        raise InputError(f"formatVersion {version}, versions 1 and 2 are read; save the motion as version 2",
                         source.path, version_line)


def _take_joints(source: SourceText, component: _Component, header: Header, joints: int, parts: int) -> Samples:
    path = source.path
    kind, kind_line = header.get("type", ("", component.line))
    if kind != "MultiValueSeq":
        raise InputError("the joint component is no MultiValueSeq; give joint values as MultiValueSeq", path, kind_line)
    if component.frames_fault is not None:
        raise component.frames_fault
    if component.frames is None:
        raise InputError("the joint component has no frames; add them", path, component.line)
    rate_hz = _frame_rate(source, component, header)
    frames = component.frames
    _check_counts(source, component, header)
    if len(frames) > 1 and (len(frames) - 1) / rate_hz > MAX_DURATION_S:
        raise InputError(f"{len(frames)} frames at {rate_hz:g} Hz last {(len(frames) - 1) / rate_hz:g} s, "
                         f"limit {MAX_DURATION_S:g} s; cut the motion into parts", path, frames[0][0])
    samples = Samples(path, source.sha256)
    for number, (line, words) in enumerate(frames, start=1):
        if len(words) != parts:
            raise InputError(f"frame {number} has {len(words)} values, {parts} wanted; the frame is cut or has too "
                             "many, write it again", path, line)
        samples.lines.append(line)
        samples.time_s.append((number - 1) / rate_hz)
        values = [parse_number(word, path, line, f"frame {number}, joint {joint}") for joint, word in enumerate(words, start=1)]
        samples.rows.append(values[:joints])
    return samples


def _frame_rate(source: SourceText, component: _Component, header: Header) -> float:
    if "frameRate" not in header:
        raise InputError("frameRate is missing; add it in Hz", source.path, component.line)
    text, line = header["frameRate"]
    rate_hz = parse_number(text, source.path, line, "frameRate")
    if rate_hz <= 0.0:
        raise InputError(f"frameRate {text}, above 0 is wanted; write it in Hz", source.path, line)
    return rate_hz


def _check_counts(source: SourceText, component: _Component, header: Header) -> None:
    frames = component.frames or []
    declared, line = header.get("numFrames", ("", 0))
    if declared and declared != str(len(frames)):
        raise InputError(f"numFrames {declared}, but {len(frames)} frames follow; the file is cut or the number is "
                         "wrong", source.path, line)


def _refuse_aliases(source: SourceText) -> Iterator[yaml.Event]:
    for event in parse_events(source):
        if isinstance(event, yaml.AliasEvent):
            raise InputError(f"alias *{event.anchor}; write the value out, motions have no aliases", source.path,
                             line_of(event))
        yield event


def _read_document(source: SourceText, events: Iterator[yaml.Event]) -> tuple[Header, list[_Component], int]:
    next(events)  # the start of the document
    root = next(events)
    if not isinstance(root, yaml.MappingStartEvent):
        raise InputError("no BodyMotion: keys such as 'type: BodyMotion' are wanted at the top", source.path,
                         line_of(root))
    header: Header = {}
    components: list[_Component] = []
    components_line = line_of(root)
    for key, key_line, value in _entries(source, events, header):
        if key == "components" and isinstance(value, yaml.SequenceStartEvent):
            components_line = key_line
            while not isinstance(item := next(events), yaml.SequenceEndEvent):
                components.append(_read_component(source, events, item))
        else:
            _skip(events, value)
    for _ in events:  # detects a second document
        pass
    return header, components, components_line


def _read_component(source: SourceText, events: Iterator[yaml.Event], start: yaml.Event) -> _Component:
    if not isinstance(start, yaml.MappingStartEvent):
        raise InputError("a component is no mapping; write '- type: MultiValueSeq' and so on", source.path,
                         line_of(start))
    component = _Component(line_of(start))
    for key, _, value in _entries(source, events, component.header):
        if key == "frames" and isinstance(value, yaml.SequenceStartEvent):
            component.frames = _read_frames(source, events, component)
        else:
            _skip(events, value)
    return component


def _read_frames(source: SourceText, events: Iterator[yaml.Event],
                 component: _Component) -> list[tuple[int, list[str]]]:
    """Frames as texts with their lines. An error is stored: it matters only if this is the joint component."""
    frames: list[tuple[int, list[str]]] = []
    while not isinstance(item := next(events), yaml.SequenceEndEvent):
        line = line_of(item)
        if len(frames) == MAX_SAMPLES:
            raise InputError(f"more than {MAX_SAMPLES} frames; cut the motion into parts", source.path, line)
        words: list[str] = []
        if isinstance(item, yaml.SequenceStartEvent):
            while not isinstance(value := next(events), yaml.SequenceEndEvent):
                if isinstance(value, yaml.ScalarEvent):
                    words.append(value.value)
                else:
                    _skip(events, value)
                    component.frames_fault = component.frames_fault or InputError(
                        f"frame {len(frames) + 1} holds a list, numbers are wanted", source.path, line)
        else:
            _skip(events, item)
            component.frames_fault = component.frames_fault or InputError(
                f"frame {len(frames) + 1} is no list; write [ q1, q2, .. ]", source.path, line)
        frames.append((line, words))
    return frames


def _entries(source: SourceText, events: Iterator[yaml.Event],
             header: Header) -> Iterator[tuple[str, int, yaml.Event]]:
    """Reads a mapping. Scalars are added to `header`; for other values the start is yielded, and the caller consumes the value."""
    seen: set[str] = set()
    while not isinstance(key := next(events), yaml.MappingEndEvent):
        line = line_of(key)
        if not isinstance(key, yaml.ScalarEvent):
            raise InputError("a key is no text; write key: value", source.path, line)
        if key.value in seen:
            raise InputError(f"key '{key.value}' stands twice; remove one", source.path, line)
        seen.add(key.value)
        value = next(events)
        if isinstance(value, yaml.ScalarEvent):
            header[key.value] = (value.value, line)
        else:
            yield key.value, line, value


def _skip(events: Iterator[yaml.Event], start: yaml.Event) -> None:
    """Consumes the rest of the value that begins with `start`; counts depth instead of recursion."""
    depth = 1 if isinstance(start, yaml.CollectionStartEvent) else 0
    while depth > 0:
        event = next(events)
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
