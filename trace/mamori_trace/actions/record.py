# SPDX-License-Identifier: Apache-2.0
"""`mamori trace record --results GLOB... -- COMMAND`: the only action that runs a program of the project.

@satisfies SWR-TRC-103      Design: docs/design/trace.md#record
"""

from __future__ import annotations

import argparse
import glob
import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from mamori_trace.actions.common import EXIT_FINDINGS, add_root
from mamori_trace.actions.records import hash_text, make_rows, read_rows, write_rows
from mamori_trace.base.errors import InputError
from mamori_trace.base.system_error import explain
from mamori_trace.readers.code_schema import read_code_schema
from mamori_trace.readers.evidence_records import hash_file
from mamori_trace.readers.sources import calc_sources, calc_sources_of

HELP = "run a test command, record what produced its results, and end with the status of the command"
EXIT_MISSING = 3
_EXIT_INTERRUPTED = 130
_EXIT_SIGNAL = 128
_JUNIT = "junit"
_ENVIRONMENT = "environment.json"

Stamp = tuple[int, int, int]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("--results", nargs="+", action="extend", required=True, metavar="GLOB", help="result files that COMMAND writes (JUnit)")
    parser.add_argument("--program", nargs="+", action="extend", default=[], type=Path, metavar="FILE", help="test programs that write them")
    parser.add_argument("--source", nargs="+", action="extend", default=[], type=Path, metavar="DIR",
                        help="sources that they are made from (default: all files that git does not ignore)")  # fmt: skip
    parser.add_argument("--evidence", type=Path, metavar="DIR", help="folder of records.json (default: the folder of the results; above `junit`)")
    parser.add_argument("command", nargs="+", metavar="COMMAND", help="the test command, after `--`")
    parser.usage = "%(prog)s --results GLOB ... [options] -- COMMAND"


def run(arguments: argparse.Namespace) -> int:
    root, folders = arguments.root, _name_folders(arguments.root, arguments.source)
    program = shutil.which(arguments.command[0])
    if program is None:
        print(f"mamori trace: record: '{arguments.command[0]}' is no program that can be run; nothing was recorded", file=sys.stderr)
        return EXIT_MISSING
    inputs = _collect_inputs(root, folders, program, arguments.command)
    before = {path: _get_stamp(path) for path in _find(arguments.results)}
    status = _run(arguments.command)
    if status == _EXIT_INTERRUPTED:
        return status
    if _collect_inputs(root, folders, program, arguments.command)["sources"] != inputs["sources"]:
        raise InputError("record: the sources changed while the command ran; nothing was recorded, run it again")
    programs = _check_programs(arguments.program)
    made = [path for path in _find(arguments.results) if _get_stamp(path) != before.get(path)]
    for path in sorted(set(before) - set(made)):
        print(f"mamori trace: record: {path}: the command did not write it; it is not recorded", file=sys.stderr)
    if not made:
        print(f"mamori trace: record: the command wrote no file {' '.join(arguments.results)}; nothing was recorded", file=sys.stderr)
        return status or EXIT_FINDINGS
    folder = arguments.evidence or _find_folder(made)
    _record(folder, made, inputs, programs, folders)
    print(f"mamori trace: record: {len(made)} result file{'' if len(made) == 1 else 's'} recorded in {folder / 'records.json'}", file=sys.stderr)
    return status


def _run(command: list[str]) -> int:
    """@return the exit status in the convention of the shell."""
    sys.stdout.flush()
    try:
        with subprocess.Popen(command) as child:
            try:
                status = child.wait()
            except KeyboardInterrupt:  # the terminal has also sent the signal to the child
                child.terminate()
                child.wait()
                return _EXIT_INTERRUPTED
    except OSError as error:
        raise InputError(f"record: {command[0]}: cannot be run: {explain(error)}") from None
    return status if status >= 0 else _EXIT_SIGNAL - status


def _record(folder: Path, made: list[Path], inputs: dict[str, str], programs: list[Path], folders: list[str]) -> None:
    """Adds the rows of new files, drops the rows of removed files, and keeps all others."""
    base = folder.resolve()
    outside = [path for path in made if not path.resolve().is_relative_to(base)]
    if outside:
        raise InputError(f"record: {outside[0]}: is not below {folder}; name the folder of all results with --evidence")
    files = [path.resolve() for path in made]
    if (base / _ENVIRONMENT).is_file():
        files.append(base / _ENVIRONMENT)
    by_name = {path.stem: path for path in programs}

    def find_program(path: Path) -> Path | None:
        return by_name.get(path.stem, programs[0] if len(programs) == 1 else None)

    rows = make_rows(base, files, inputs, find_program)
    kept = {name: row for name, row in read_rows(base).items() if (base / name).is_file()}
    write_rows(base, kept | rows, folders)


def _collect_inputs(root: Path, folders: list[str], program: str, command: list[str]) -> dict[str, str]:
    """Raises InputError if the sources cannot be determined."""
    sources = calc_sources_of(root, folders) if folders else calc_sources(root, read_code_schema(root).no_evidence)
    if not sources:
        raise InputError(f"record: {root}: no git repository tells the sources; name their folders with --source")
    tools = json.dumps({"command": hash_file(Path(program)), "python": platform.python_version(), "machine": platform.machine()}, sort_keys=True)
    return {"sources": sources, "tool_chain": hash_text(tools), "configuration": hash_text(json.dumps(command))}


def _name_folders(root: Path, given: list[Path]) -> list[str]:
    """Folders relative to the root. Raises InputError if a folder is missing or outside the root."""
    names = []
    for path in given:
        if not path.exists():
            raise InputError(f"record: --source {path}: is not there; name a folder of sources")
        if not path.resolve().is_relative_to(root.resolve()):
            raise InputError(f"record: --source {path}: is not below {root}; name the project with --root")
        names.append(path.resolve().relative_to(root.resolve()).as_posix())
    return sorted(set(names))


def _check_programs(programs: list[Path]) -> list[Path]:
    for path in programs:
        if not path.is_file():
            raise InputError(f"record: --program {path}: is no file; name a test program")
    return programs


def _find(patterns: list[str]) -> list[Path]:
    found = {name for pattern in patterns for name in glob.glob(pattern, recursive=True)}
    return sorted(Path(name) for name in found if os.path.isfile(name))


def _find_folder(made: list[Path]) -> Path:
    """The folder that contains all results; its parent if it is named `junit`."""
    folder = Path(os.path.commonpath([path.parent.resolve() for path in made]))
    return folder.parent if folder.name == _JUNIT else folder


def _get_stamp(path: Path) -> Stamp:
    """Values that change when the file is written or replaced."""
    status = path.stat()
    return status.st_ino, status.st_size, status.st_mtime_ns
