# SPDX-License-Identifier: Apache-2.0
"""Reads `records.json` and compares each evidence file with it (docs/design/trace.md#evidence-files).

@satisfies SWR-TRC-036      Design: docs/design/trace.md#records
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from mamori_trace.base.files import UNREADABLE, get_shown_path, note_unreadable
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.json_file import Each, Maybe, find_misfit, read_json
from mamori_trace.model.evidence import Evidence, FileRecord
from mamori_trace.readers.sources import calc_sources_of

NAME = "records.json"
SCHEMA = "mamori.records/1"
RECORDED = ("environment.json", "junit/*.xml", "campaign/campaign.json", "coverage/*", "coverage/by_test/*", "static/*")
"""Files that decide about requirements and therefore have a record. Times depend on the host and the run, and decide nothing."""

ALTERED = "evidence-altered"
FOLDERS = "source_folders"
"""The folders whose files `sources` covers; if empty, all files that git does not ignore."""
_FILE = {"sha256": str, "sources": str, "tool_chain": str, "configuration": str, "binary": Maybe(str)}
_REMEDY = "run the tests again"


def list_recorded(folder: Path) -> list[Path]:
    """The files below an evidence folder that have, or should have, a record."""
    return sorted(path for pattern in RECORDED for path in folder.glob(pattern) if path.is_file() and not path.name.startswith("."))


def hash_file(path: Path) -> str:
    """SHA-256 of the bytes of a file. Raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def read_evidence_records(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the records. If there are any, each changed, missing or unrecorded file is a problem."""
    path = folder / NAME
    if not path.exists():
        return
    table = read_json(path, SCHEMA, root, problems)
    if table is None:
        return
    place = Place(get_shown_path(path, root), 1)
    misfit = find_misfit({FOLDERS: [], **table[0]}, {"files": Each(_FILE), FOLDERS: [str]}, "")
    folders = table[0].get(FOLDERS, []) if not misfit else []
    if any(name.startswith("/") or ".." in name.split("/") for name in folders):
        misfit = f"{FOLDERS} leads out of the project"
    if misfit:
        problems.append(Problem(UNREADABLE, place, f"{misfit}; {_REMEDY}"))
        return
    rows = table[0]["files"]
    intact = _compare(folder, root, {name: row["sha256"] for name, row in rows.items()}, place, problems)
    now = calc_sources_of(root, folders) if folders else ""
    for name in sorted(rows):
        shown = get_shown_path(folder / name, root)
        evidence.records[name if name not in evidence.records else shown] = FileRecord(shown, rows[name]["sources"], now, name in intact)


def _compare(folder: Path, root: Path, recorded: dict[str, str], place: Place, problems: list[Problem]) -> set[str]:
    """@return names of the files that match their records."""
    intact: set[str] = set()
    present = {path.relative_to(folder).as_posix(): path for path in list_recorded(folder)}
    present |= {name: folder / name for name in recorded if (folder / name).is_file()}
    for name in sorted(recorded.keys() - present.keys()):
        problems.append(Problem(ALTERED, place, f"{name} was recorded and is gone; {_REMEDY}"))
    for name, path in present.items():
        shown = Place(get_shown_path(path, root), 1)
        if name not in recorded:
            problems.append(Problem(ALTERED, shown, f"is in no record of {place.file}: nothing tells what made it; {_REMEDY}"))
            continue
        try:
            if hash_file(path) == recorded[name]:
                intact.add(name)
            else:
                problems.append(Problem(ALTERED, shown, f"differs from what was recorded when it was made; {_REMEDY}"))
        except OSError as error:
            note_unreadable(error, shown.file, problems)
    return intact
