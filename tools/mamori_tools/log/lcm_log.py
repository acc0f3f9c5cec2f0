# SPDX-License-Identifier: Apache-2.0
"""Shows the channels of an LCM log and exports its events as MCAP.

@satisfies SWR-REC-016, SWR-REC-017      Design: docs/design/recorder.md#lcm-logs
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from mcap.writer import Writer

from mamori_tools.lcm.decoder import FINGERPRINT_BYTES, DecodeError, decode, find_type, make_schema
from mamori_tools.lcm.log_file import Damage, LcmLog, open_log
from mamori_tools.lcm.type_files import Struct, Types, read_types
from mamori_tools.log.export import METADATA, open_mcap
from mamori_tools.log.output import until_reader_ends
from mamori_tools.log.show import format_time
from mamori_trace.base.errors import InputError

COLUMNS = ("channel", "type", "events", "octets", "first [s]", "last [s]")
OPAQUE = "x-lcm"
"""Message encoding of messages without a known type: the octets of LCM."""


@dataclass
class Channel:
    """Events of one LCM channel with one fingerprint. Instants [us] in the time of the log."""

    name: str
    fingerprint: str
    kind: Struct | None
    events: int = 0
    octets: int = 0
    first_us: int = 0
    last_us: int = 0


@dataclass
class Contents:
    channels: dict[tuple[str, str], Channel] = field(default_factory=dict)
    damage: list[Damage] = field(default_factory=list)
    first_us: int | None = None
    invalid: list[Damage] = field(default_factory=list)
    """Messages that do not match the type of their fingerprint."""

    @property
    def event_count(self) -> int:
        return sum(channel.events for channel in self.channels.values())


@dataclass(frozen=True)
class Shown:
    """`findings`: damage and invalid messages. `notes`: channels of unknown type."""

    findings: list[str]
    notes: list[str]


def show_and_export(path: Path, mcap: Path | None, types_folder: Path | None) -> Shown:
    """Prints the channels, then writes `mcap`. @raise InputError."""
    types = None if types_folder is None else read_types(types_folder)
    with open_log(path) as log:
        contents = _survey(log, types)
        if not contents.event_count:
            raise InputError("contains no intact event; specify the log that lcm-logger wrote", path)
        with until_reader_ends():
            _print(contents)
        if mcap is not None and types is not None:
            _write(mcap, path, log, types, contents)
    return Shown(_list_findings(path, contents), [] if types is None else _list_opaque(contents))


def _survey(log: LcmLog, types: Types | None) -> Contents:
    contents = Contents()
    for event in log.read():
        if isinstance(event, Damage):
            contents.damage.append(event)
            continue
        fingerprint = event.data[:FINGERPRINT_BYTES].hex()
        channel = contents.channels.get((event.channel, fingerprint))
        if channel is None:
            kind = None if types is None else find_type(types, event.data)
            channel = Channel(event.channel, fingerprint, kind, first_us=event.time_us)
            contents.channels[event.channel, fingerprint] = channel
        channel.events += 1
        channel.octets += len(event.data)
        channel.last_us = event.time_us
        if contents.first_us is None:
            contents.first_us = event.time_us
        if types is not None and channel.kind is not None:
            try:
                decode(types, channel.kind, event.data)
            except DecodeError as error:
                contents.invalid.append(Damage(event.offset, len(event.data), f"message on '{event.channel}' is no {channel.kind.name}: {error}"))
    return contents


def _print(contents: Contents) -> None:
    begin = contents.first_us or 0
    rows = [(one.name, one.kind.name if one.kind is not None else f"fingerprint {one.fingerprint or 'missing'}", str(one.events), str(one.octets),
             format_time((one.first_us - begin) * 1000), format_time((one.last_us - begin) * 1000)) for one in contents.channels.values()]  # fmt: skip
    widths = [max(len(row[i]) for row in [COLUMNS, *rows]) for i in range(len(COLUMNS))]
    for row in [COLUMNS, *rows]:
        print("  ".join(cell.ljust(width) if i < 2 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths, strict=True))).rstrip())
    for damage in contents.damage:
        print(f"  -- damaged at offset {damage.offset}: {damage.size} bytes, {damage.text}")
    print(f"{contents.event_count} events; {len(contents.damage)} damaged parts")


def _write(path: Path, source: Path, log: LcmLog, types: Types, contents: Contents) -> None:
    invalid = {one.offset for one in contents.invalid}
    with open_mcap(path) as writer:
        schemas: dict[str, int] = {}
        channels: dict[tuple[str, str], int] = {}
        opaque: Counter[str] = Counter()
        for event in log.read():
            if isinstance(event, Damage):
                continue
            kind = None if event.offset in invalid else find_type(types, event.data)
            key = (event.channel, "" if kind is None else kind.name)
            if key not in channels:
                channels[key] = _register(writer, types, event.channel, kind, schemas)
            opaque[event.channel] += kind is None
            data = event.data if kind is None else json.dumps(decode(types, kind, event.data), allow_nan=False).encode()
            time_ns = max(0, event.time_us * 1000)
            writer.add_message(channels[key], time_ns, data, time_ns, event.number & 0xFFFF_FFFF)
        facts = {"file": source.name, "events": contents.event_count, "opaque": {name: count for name, count in opaque.items() if count},
                 "damage": [{"offset": one.offset, "bytes": one.size, "text": one.text} for one in (*contents.damage, *contents.invalid)]}  # fmt: skip
        writer.add_metadata(METADATA, {key: value if isinstance(value, str) else json.dumps(value) for key, value in facts.items()})


def _register(writer: Writer, types: Types, channel: str, kind: Struct | None, schemas: dict[str, int]) -> int:
    if kind is None:
        return writer.register_channel(channel, OPAQUE, 0)
    if kind.name not in schemas:
        schemas[kind.name] = writer.register_schema(kind.name, "jsonschema", json.dumps(make_schema(types, kind)).encode())
    return writer.register_channel(channel, "json", schemas[kind.name])


def _list_opaque(contents: Contents) -> list[str]:
    """One line for each channel whose type is unknown."""
    return [f"'{one.name}': {one.events} messages of unknown type (fingerprint {one.fingerprint or 'missing'}) written without decoding; add its .lcm file"
            for one in contents.channels.values() if one.kind is None]  # fmt: skip


def _list_findings(path: Path, contents: Contents) -> list[str]:
    findings = []
    for parts, what in ((contents.damage, "damaged parts"), (contents.invalid, "invalid messages")):
        if parts:
            findings.append(str(InputError(f"{len(parts)} {what}, first at offset {parts[0].offset}: {parts[0].text}", path)))
    return findings
