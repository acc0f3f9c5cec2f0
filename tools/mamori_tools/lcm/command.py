# SPDX-License-Identifier: Apache-2.0
"""`./mamori lcm types PROGRAM --out DIR`: writes the `.lcm` files of the message types that a program prints.
`./mamori lcm replay LOG PROGRAM`: replays a log of lcm-logger.

@satisfies SWR-LCM-013, SWR-LCM-016      Design: docs/design/lcm.md#types
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_OK
from mamori_tools.lcm.replay import replay
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import write_text

TYPES, REPLAY = "types", "replay"
HEAD = "// Made by Mamori from the field list of "
NAME = r"[A-Za-z_][A-Za-z0-9_]*"
STRUCT = re.compile(rf"{re.escape(HEAD)}[^\n]*\npackage (?P<package>{NAME}(?:\.{NAME})*);\n\nstruct (?P<name>{NAME}) {{\n(?:    [^\n]*\n)+}}\n")
TIMEOUT_S = 60
HINT = "its main function must return mamori::ports::lcm::print_lcm_types<...>()"


def run(arguments: argparse.Namespace) -> int:
    """@raise InputError in one line for wrong arguments or a program without the mode."""
    wanted = {TYPES: 1, REPLAY: 2}[arguments.action]
    if len(arguments.paths) != wanted:
        raise InputError(f"lcm {arguments.action}: {len(arguments.paths)} paths instead of {wanted}; see ./mamori lcm --help")
    if arguments.action == REPLAY:
        if arguments.out is not None:
            raise InputError("lcm replay: --out is for types; omit it")
        return replay(arguments.paths[0], arguments.paths[1], arguments.passed_on)
    if arguments.out is None or arguments.passed_on:
        raise InputError("lcm types: needs --out DIR and no arguments after the program; see ./mamori lcm --help")
    return _write_types(arguments.paths[0], arguments.out)


def _write_types(program: Path, folder: Path) -> int:
    """@raise InputError if the program does not print types; then nothing is written."""
    files = split_types(program, _run_program(program))
    _make_folder(folder)
    for name, text in files.items():
        path = folder / name
        write_text(path, text)
        print(f"mamori: wrote {path}", file=sys.stderr)
    return EXIT_OK


def split_types(program: Path, output: str) -> dict[str, str]:
    """@return file name and text of each struct, in the order of `output`. @raise InputError for any other output."""
    files: dict[str, str] = {}
    position = 0
    while position < len(output):
        struct = STRUCT.match(output, position)
        if struct is None:
            line = output.count("\n", 0, position) + 1
            raise InputError(f"line {line} of its output does not begin an LCM type; {HINT}", program)
        name = f"{struct['package']}.{struct['name']}.lcm"
        if files.setdefault(name, struct[0]) != struct[0]:
            raise InputError(f"two different types are named {name.removesuffix('.lcm')}; rename one", program)
        position = struct.end()
    if not files:
        raise InputError(f"printed no LCM type; {HINT}", program)
    return files


def _run_program(program: Path) -> str:
    if not program.is_file():
        raise InputError("not a program; build it, then specify its path", program)
    try:
        done = subprocess.run([str(program.absolute())], capture_output=True, check=False, stdin=subprocess.DEVNULL, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired as error:
        raise InputError(f"did not end within {TIMEOUT_S} s; {HINT}", program) from error
    except OSError as error:
        raise InputError(f"cannot be started: {error.strerror}; specify an executable program", program) from error
    if done.returncode != 0:
        raise InputError(f"ended with status {done.returncode}, so its output is incomplete; {HINT}", program)
    try:
        return done.stdout.decode("ascii")
    except UnicodeDecodeError as error:
        raise InputError(f"byte {error.start} of its output is not ASCII; {HINT}", program) from error


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be made: {error.strerror}; specify a folder that can be written", folder) from error


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = f"%(prog)s {TYPES} PROGRAM --out DIR\n       %(prog)s {REPLAY} LOG PROGRAM [-- ARGUMENTS]"
    parser.add_argument("action", choices=[TYPES, REPLAY], metavar=f"{TYPES}, {REPLAY}",
                        help="write the .lcm files of message types; or run a program with a log of lcm-logger, twice, and compare")  # fmt: skip
    parser.add_argument("paths", type=Path, nargs="+", metavar="PATH",
                        help=f"{TYPES}: program that returns print_lcm_types(); {REPLAY}: log, and program that returns replay_main()")  # fmt: skip
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for one file per struct, PACKAGE.STRUCT.lcm")


COMMAND = Command(
    add_arguments, run, "write the message types of a program as .lcm files; replay a log of an LCM network",
    "Runs PROGRAM, which prints the LCM types that ports/lcm makes of its field lists, and writes each struct to a file of its own. lcm-gen and the "
    "tools of LCM read these files.\n\nA replay runs the replay mode of PROGRAM in virtual time and prints its counters and hashes.",
    {1: "the log is damaged, or two replays differ"},
    examples=("lcm types build/my_types --out types", "lcm replay run.lcmlog build/my_replay"))  # fmt: skip
