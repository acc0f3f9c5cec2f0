# SPDX-License-Identifier: Apache-2.0
"""`mamori log FILE`: prints the file of a flight recorder or an LCM log, and exports it.

Exit status: 0 all records are readable, 1 printed but something is damaged or missing, 2 nothing to print or wrong usage.

@satisfies SWR-REC-011, SWR-REC-012, SWR-REC-013, SWR-REC-016      Design: docs/design/recorder.md#the-command-log
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.lcm.log_file import is_lcm_log
from mamori_tools.log.names import Names, default_names_path, read_names
from mamori_tools.log.output import until_reader_ends
from mamori_tools.log.region import Recording, read_recording
from mamori_trace.base.errors import InputError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, metavar="FILE", help="file of a flight recorder, or log of lcm-logger")
    parser.add_argument("--mcap", type=Path, metavar="OUT", help="also write the events as MCAP, for Foxglove and other log viewers")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--csv", type=Path, metavar="OUT", help="also write the events of a flight recorder as CSV")
    form.add_argument("--json", action="store_true", help="print the events of a flight recorder as JSON instead of a table")
    parser.add_argument("--names", type=Path, metavar="NAMES",
                        help="table of names for sources, codes and arguments (JSON, YAML or TOML); default: FILE.names.json, if present")  # fmt: skip
    parser.add_argument("--types", type=Path, metavar="DIR", help="folder of the .lcm files of an LCM log; needed for its --mcap")


def run(arguments: argparse.Namespace) -> int:
    """Raises InputError in one line if there is nothing to print. @return exit status."""
    _refuse_input_as_output(arguments)
    if is_lcm_log(arguments.file):
        return _run_lcm(arguments)
    if arguments.types is not None:
        raise InputError("log: --types is for LCM logs; omit it for the file of a flight recorder")
    recording = read_recording(arguments.file)  # rejects a path without a file name, such as '.'
    names, complaint = _choose_names(arguments)
    with until_reader_ends():
        _print(arguments, recording, names)
    _export(arguments, recording, names)
    for line in filter(None, (complaint, _make_complaint(recording))):
        print(f"mamori: {line}", file=sys.stderr)
    return EXIT_FAILED if recording.findings or complaint else EXIT_OK


def _run_lcm(arguments: argparse.Namespace) -> int:
    for option, value in (("--csv", arguments.csv), ("--json", arguments.json), ("--names", arguments.names)):
        if value:
            raise InputError(f"log: {option} is for the file of a flight recorder; omit it for an LCM log", arguments.file)
    if arguments.mcap is not None and arguments.types is None:
        raise InputError("log: --mcap of an LCM log needs --types DIR with its .lcm files (./mamori lcm types)", arguments.file)
    from mamori_tools.log.lcm_log import show_and_export

    shown = show_and_export(arguments.file, arguments.mcap, arguments.types)
    for line in (*shown.notes, *shown.findings):
        print(f"mamori: {line}", file=sys.stderr)
    return EXIT_FAILED if shown.findings else EXIT_OK


def _refuse_input_as_output(arguments: argparse.Namespace) -> None:
    for option, out in (("--mcap", arguments.mcap), ("--csv", arguments.csv)):
        if out is not None and (out.absolute() == arguments.file.absolute() or (out.exists() and arguments.file.exists()
                                                                               and out.samefile(arguments.file))):
            raise InputError(f"log: {option} would replace the input file '{out}'; name another file")


def _choose_names(arguments: argparse.Namespace) -> tuple[Names, str]:
    """The names to use, and one line if a default table of names is invalid."""
    if arguments.names is not None:
        return read_names(arguments.names), ""
    found = default_names_path(arguments.file)
    if not found.is_file():
        return Names(), ""
    try:
        return read_names(found), ""
    except InputError as error:
        return Names(), f"{error}; printed without names"


def _print(arguments: argparse.Namespace, recording: Recording, names: Names) -> None:
    if arguments.json:
        from mamori_tools.log.export import make_json

        print(make_json(recording, names))
    else:
        from mamori_tools.log.show import print_recording

        print_recording(recording, names)
    sys.stdout.flush()


def _export(arguments: argparse.Namespace, recording: Recording, names: Names) -> None:
    if arguments.mcap is None and arguments.csv is None:
        return
    from mamori_tools.log.export import write_csv, write_mcap

    if arguments.mcap is not None:
        write_mcap(arguments.mcap, recording, names)
    if arguments.csv is not None:
        write_csv(arguments.csv, recording, names)


def _make_complaint(recording: Recording) -> str:
    if not recording.findings:
        return ""
    from mamori_tools.log.show import format_damage

    first = min(recording.findings, key=lambda finding: finding.offset)
    return str(InputError(f"{format_damage(recording)}, first at offset {first.offset} ({first.text}); what could be read was "
                          "printed; keep a copy of the file before a program goes on over it", recording.path))


COMMAND = Command(
    add_arguments, run, "print the file of a flight recorder or an LCM log; export it for viewers",
    "Prints the events in FILE, which a flight recorder wrote. This also works while the recorder writes and after a crash. Missing, torn and "
    "corrupt parts are reported with their offset in the file. Of a log of lcm-logger, the channels are printed; --mcap decodes its messages with the "
    "types in DIR.",
    {0: "all events were read", 1: "printed, but something is damaged or missing", 2: "nothing to print, or wrong arguments"},
    examples=("log run.rec --mcap run.mcap", "log run.lcmlog --types types --mcap run.mcap"))  # fmt: skip
