# SPDX-License-Identifier: Apache-2.0
"""Writes evidence/records.json: the hash of each evidence file and of its inputs (docs/design/trace.md#evidence-files).

@satisfies SWR-TRC-036      Design: docs/design/trace.md#records
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TextIO

from mamori_tools.host.process import Tick
from mamori_tools.host.project import Project
from mamori_tools.host.project_run import find_program
from mamori_tools.host.steps import Context
from mamori_trace.actions.records import Rows, hash_text, make_rows, read_rows, write_rows
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.readers.code_schema import read_code_schema
from mamori_trace.readers.evidence_records import NAME, list_recorded
from mamori_trace.readers.sources import calc_sources

_SKIPPED = ("CMakeFiles", "_deps", "evidence")


def collect_inputs(project: Project, compilers: dict[str, str], python: str) -> dict[str, str]:
    """Hashes of the current inputs of results. Sources outside git have none."""
    try:
        sources = calc_sources(project.root, read_code_schema(project.root).no_evidence)
    except InputError:  # the trace check reports the error
        sources = ""
    presets = project.root / "CMakePresets.json"
    preset = presets.read_text(encoding="utf-8") if presets.is_file() else ""
    tools = json.dumps({**compilers, "python": python}, sort_keys=True)
    return {"sources": sources, "tool_chain": hash_text(tools), "configuration": hash_text(f"{project.preset}\n{preset}")}


def record_evidence(context: Context, _tick: Tick, log: TextIO) -> None:
    """The step of a run that creates the records of all its files. @raise WorkError if the environment is not recorded."""
    count = write_records(context.project)
    print(f"{count} files recorded", file=log)


def write_records(project: Project) -> int:
    """Records every evidence file with the inputs in environment.json. @return their number. @raise WorkError without that file."""
    rows = _make_rows(project, list_recorded(project.evidence), _read_inputs(project))
    write_rows(project.evidence, rows)
    return len(rows)


def renew_records(project: Project, files: Iterable[Path], inputs: dict[str, str]) -> None:
    """Records `files`, which one command has created from `inputs`. Other unrecorded evidence stays unrecorded."""
    if (project.evidence / NAME).is_file():
        write_rows(project.evidence, read_rows(project.evidence) | _make_rows(project, files, inputs))


def _read_inputs(project: Project) -> dict[str, str]:
    path = project.evidence / "environment.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))["inputs"]
    except (OSError, ValueError, KeyError) as error:
        raise WorkError(f"{path}: no record of what the evidence is made from ({error}); run the command again") from error


def _make_rows(project: Project, files: Iterable[Path], inputs: dict[str, str]) -> Rows:
    programs = _find_programs(project.build)

    def find(path: Path) -> Path | None:
        return (find_program(project, path) or programs.get(path.stem)) if path.parent == project.junit else None

    return make_rows(project.evidence, files, inputs, find)


def _find_programs(build: Path) -> dict[str, Path]:
    """Test programs by name, because a JUnit file has the name of its program."""
    programs: dict[str, Path] = {}
    for folder, folders, files in os.walk(build):
        folders[:] = sorted(name for name in folders if name not in _SKIPPED)
        for name in sorted(files):
            path = Path(folder) / name
            if "." not in name and name not in programs and os.access(path, os.X_OK):
                programs[name] = path
    return programs
