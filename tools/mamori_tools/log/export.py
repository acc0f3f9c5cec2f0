# SPDX-License-Identifier: Apache-2.0
"""Writes a recording atomically as MCAP, CSV or JSON.

@satisfies SWR-REC-012, SWR-PRT-028      Design: docs/design/recorder.md#export
Source: https://mcap.dev/spec and the schema foxglove.Log, which log panels find by its name
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from mcap.writer import Writer

from mamori_tools.log.names import Names
from mamori_tools.log.region import Finding, Record, Recording
from mamori_tools.log.show import format_crash, format_time
from mamori_trace.base.text_file import refuse_output, write_text
from mamori_trace.base.whole_file import whole_file

SCHEMA_NAME = "foxglove.Log"
LEVELS = {"info": 2, "warning": 3, "fault": 4}
METADATA = "mamori.log"
CSV_COLUMNS = ("sequence", "session", "time_s", "severity", "source", "source_name", "code", "code_name", "argument",
               "argument_name")  # fmt: skip
JSON_SCHEMA = "mamori.log/1"

_INTEGER = {"type": "integer"}
_COUNT = {"type": "integer", "minimum": 0}
_STRING = {"type": "string"}
SCHEMA = {
    "title": SCHEMA_NAME,
    "description": "An event of a flight recorder. The first six fields are those of a log message; time is that of the session.",
    "type": "object",
    "properties": {
        "timestamp": {"type": "object", "title": "time",
                      "properties": {"sec": _COUNT, "nsec": {"type": "integer", "minimum": 0, "maximum": 999_999_999}}},
        "level": {"type": "integer", "description": "2 info, 3 warning, 4 fault"},
        "message": _STRING,
        "name": _STRING,
        "file": _STRING,
        "line": _COUNT,
        "sequence": _COUNT,
        "session": _COUNT,
        "time_ns": _INTEGER,
        "severity": {"type": "string", "enum": list(LEVELS)},
        "source": _COUNT,
        "code": _COUNT,
        "argument": _INTEGER,
    },
    "required": ["timestamp", "level", "message", "name", "file", "line"],
}  # fmt: skip


def write_mcap(path: Path, recording: Recording, names: Names) -> None:
    """Raises InputError if `path` cannot be written."""
    with open_mcap(path) as writer:
        schema = writer.register_schema(SCHEMA_NAME, "jsonschema", json.dumps(SCHEMA).encode())
        channels: dict[int, int] = {}
        for record in recording.records:
            if record.session not in channels:
                channels[record.session] = writer.register_channel(f"/events/session_{record.session}", "json", schema)
            time_ns = max(0, record.time_ns)
            writer.add_message(channels[record.session], time_ns, json.dumps(_make_message(recording, record, names)).encode(),
                               time_ns, record.sequence & 0xFFFF_FFFF)
        facts = {"file": recording.path.name, "capacity": recording.capacity, "session": recording.session,
                 "overwritten": recording.overwritten, "findings": [_make_finding(finding) for finding in recording.findings],
                 "crash": _make_crash(recording)}
        writer.add_metadata(METADATA, {key: value if isinstance(value, str) else json.dumps(value) for key, value in facts.items()})


def write_csv(path: Path, recording: Recording, names: Names) -> None:
    """Raises InputError if `path` cannot be written."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(CSV_COLUMNS)
    for record in recording.records:
        writer.writerow((record.sequence, record.session, format_time(record.time_ns), record.severity, record.source,
                         names.source(record), record.code, names.code(record), record.argument, names.argument(record)))  # fmt: skip
    write_text(path, text.getvalue())


def make_json(recording: Recording, names: Names) -> str:
    """The complete recording as one document."""
    return json.dumps({
        "schema": JSON_SCHEMA, "file": str(recording.path), "capacity": recording.capacity, "session": recording.session,
        "overwritten": recording.overwritten,
        "records": [{**_make_numbers(record), "offset": record.offset, "source_name": names.source(record),
                     "code_name": names.code(record), "argument_name": names.argument(record)} for record in recording.records],
        "findings": [_make_finding(finding) for finding in recording.findings],
        "crash": _make_crash(recording),
    }, indent=1)  # fmt: skip


def _make_numbers(record: Record) -> dict[str, object]:
    return {"sequence": record.sequence, "session": record.session, "time_ns": record.time_ns, "severity": record.severity,
            "source": record.source, "code": record.code, "argument": record.argument}  # fmt: skip


def _make_message(recording: Recording, record: Record, names: Names) -> dict[str, object]:
    seconds, rest = divmod(max(0, record.time_ns), 1_000_000_000)
    return {"timestamp": {"sec": seconds, "nsec": rest}, "level": LEVELS[record.severity],
            "message": f"{names.code(record)} {names.argument(record)}", "name": names.source(record),
            "file": recording.path.name, "line": 0, **_make_numbers(record)}  # fmt: skip


def _make_finding(finding: Finding) -> dict[str, object]:
    return {"kind": finding.kind, "offset": finding.offset, "text": finding.text}


def _make_crash(recording: Recording) -> dict[str, object] | None:
    return None if recording.crash is None else {**asdict(recording.crash), "text": format_crash(recording.crash)}


@contextmanager
def open_mcap(path: Path) -> Iterator[Writer]:
    """A temporary file that replaces `path` if the block ends without an exception; otherwise it is removed."""
    try:
        with whole_file(path) as part, part.open("wb") as stream:
            writer = Writer(stream)
            writer.start(library=f"mamori {version('mamori')}")
            yield writer
            writer.finish()
    except OSError as error:
        raise refuse_output(path, error) from error
