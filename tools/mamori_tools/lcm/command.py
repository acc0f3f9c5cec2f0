# SPDX-License-Identifier: Apache-2.0
"""`./mamori lcm types PROGRAM --out DIR`: writes the `.lcm` files of the message types that a program prints.

@satisfies SWR-LCM-013      Design: docs/design/lcm.md#types
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from pathlib import Path

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_OK
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import write_text

HEAD = "// Made by Mamori from the field list of "
NAME = r"[A-Za-z_][A-Za-z0-9_]*"
STRUCT = re.compile(rf"{re.escape(HEAD)}[^\n]*\npackage (?P<package>{NAME}(?:\.{NAME})*);\n\nstruct (?P<name>{NAME}) {{\n(?:    [^\n]*\n)+}}\n")
TIMEOUT_S = 60
HINT = "its main function must return mamori::ports::lcm::print_lcm_types<...>()"


def run(arguments: argparse.Namespace) -> int:
    """@raise InputError in one line if PROGRAM does not print types; then nothing is written."""
    files = split_types(arguments.program, _run_program(arguments.program))
    _make_folder(arguments.out)
    for name, text in files.items():
        path = arguments.out / name
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
    parser.add_argument("action", choices=["types"], metavar="types", help="write the .lcm files of message types")
    parser.add_argument("program", type=Path, metavar="PROGRAM", help="program that prints its types with print_lcm_types()")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for one file per struct, PACKAGE.STRUCT.lcm")


COMMAND = Command(
    add_arguments, run, "write the message types of a program as .lcm files for lcm-gen",
    "Runs PROGRAM, which prints the LCM types that ports/lcm makes of its field lists, and writes each struct to a file of its own. lcm-gen and the "
    "tools of LCM read these files.",
    examples=("lcm types build/my_types --out types",))  # fmt: skip
