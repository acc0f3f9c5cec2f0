# SPDX-License-Identifier: Apache-2.0
"""`mamori table FILE`: shows the JSON of a system table as text, as a page and as pictures.

Exit status: 0 shown, 1 shown, but the table violates a rule, 2 nothing to show or wrong usage.

@satisfies SWR-TAB-004, SWR-TAB-007, SWR-TAB-008, SWR-CLI-047, SWR-CYC-033      Design: docs/design/cost.md#the-command-table
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.table.document import Table, read_table
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text, refuse_output
from mamori_trace.base.whole_file import whole_file

FILES = {"text": "table.txt", "page": "table.md", "time_line": "time_line.svg", "graph": "graph.svg", "modes": "modes.svg"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=Path, metavar="FILE",
                        help="JSON that a program wrote with mamori::table_dump, for example by `safe_arm table --out FILE`")  # fmt: skip
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--text", action="store_true",
                      help="print windows, connections, modes, parameters, reactions, safety rows, and every violated rule; the default")  # fmt: skip
    form.add_argument("--markdown", action="store_true", help="print the same rows as a Markdown page, for example for a safety manual")
    form.add_argument("--json", action="store_true", help="print the table as JSON after it has been checked")
    parser.add_argument("--svg-time-line", type=Path, metavar="OUT",
                        help="write a picture of one major frame: a lane for each core, windows with their budgets")  # fmt: skip
    parser.add_argument("--svg-graph", type=Path, metavar="OUT",
                        help="write a picture of the data flow: components by core and window, connections by port")  # fmt: skip
    parser.add_argument("--svg-modes", type=Path, metavar="OUT",
                        help="write a picture of the modes: transitions, events, initial mode and safe mode")  # fmt: skip
    parser.add_argument("--as", dest="target", choices=("rtmsafety",), help="write the eight tables of RTMSafety in C99 to the folder of --out instead")
    parser.add_argument("--out", type=Path, metavar="DIR", help=f"write all five to DIR: {', '.join(FILES.values())}")


def run(arguments: argparse.Namespace) -> int:
    """Raises InputError in one line; then nothing is written. @return exit status."""
    outputs = _choose_outputs(arguments)
    table = read_table(arguments.file)
    # All outputs are created before the first file is written.
    texts = [(path, make(table)) for path, make in outputs]
    if arguments.target is not None:
        texts += _make_tables(table, arguments.out)
    if arguments.out is not None:
        _make_folder(arguments.out)
    _write_all(texts)
    if arguments.json:
        print(json.dumps(json.loads(read_text(arguments.file, "table").text), indent=1))
    elif arguments.markdown:
        print(_make_page(table), end="")
    elif arguments.text or not texts:
        _print(table)
    elif table.findings:
        print(f"mamori: {arguments.file}: the table breaks {len(table.findings)} rule(s), first: {table.findings[0]}; --text shows all",
              file=sys.stderr)  # fmt: skip
    return EXIT_FAILED if table.findings else EXIT_OK


def _choose_outputs(arguments: argparse.Namespace) -> list[tuple[Path, Callable[[Table], str]]]:
    makers = {"text": _make_text, "page": _make_page, "time_line": _make_time_line, "graph": _make_graph, "modes": _make_modes}
    pictures = {"time_line": arguments.svg_time_line, "graph": arguments.svg_graph, "modes": arguments.svg_modes}
    outputs: list[tuple[Path, Callable[[Table], str]]] = [(path, makers[kind]) for kind, path in pictures.items() if path is not None]
    if arguments.target is not None and arguments.out is None:
        raise InputError("table: --as needs --out DIR, the folder for the tables")
    if arguments.out is not None and arguments.target is None:
        outputs += [(arguments.out / name, makers[kind]) for kind, name in FILES.items()]
    seen = {os.path.realpath(arguments.file)}
    for path in (*(path for path, _ in outputs), *_name_tables(arguments)):
        if os.path.realpath(path) in seen:
            raise InputError(f"table: '{path}' is named twice; give each file a name of its own")
        seen.add(os.path.realpath(path))
    return outputs


def _write_all(texts: list[tuple[Path, str]]) -> None:
    """Raises InputError; then no file has changed, unless a rename fails."""
    path = Path()
    try:
        with contextlib.ExitStack() as files:
            for path, text in texts:
                files.enter_context(whole_file(path)).write_text(text, encoding="utf-8", newline="\n")
    except OSError as error:
        raise refuse_output(path, error) from error
    for path, _ in texts:
        print(f"mamori: wrote {path}", file=sys.stderr)


# Each picture needs its own library or program; the other outputs do not need them.


def _make_text(table: Table) -> str:
    from mamori_tools.table.text import make_text

    return make_text(table)


def _make_page(table: Table) -> str:
    from mamori_tools.table.page import make_page

    return make_page(table)


def _make_time_line(table: Table) -> str:
    from mamori_tools.table.time_line import make_time_line

    return make_time_line(table)


def _make_graph(table: Table) -> str:
    from mamori_tools.table.graph import make_graph

    return make_graph(table)


def _make_modes(table: Table) -> str:
    from mamori_tools.table.mode_graph import make_mode_graph

    return make_mode_graph(table)


def _name_tables(arguments: argparse.Namespace) -> list[Path]:
    from mamori_tools.table.rtmsafety import get_file_names

    return [] if arguments.target is None else [arguments.out / name for name in get_file_names()]


def _make_tables(table: Table, folder: Path) -> list[tuple[Path, str]]:
    from mamori_tools.table.rtmsafety import make_files

    return [(folder / name, text) for name, text in make_files(table).items()]


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be made: {error.strerror}; name a folder that can be written", folder) from error


def _print(table: Table) -> None:
    from mamori_tools.table.show import print_table

    try:
        print_table(table)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader of the output has ended; Python must not print an error at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


COMMAND = Command(
    add_arguments, run, "show the system table of a program as text and as pictures",
    "Shows a system table that a program wrote. Without an option, it prints the text.",
    {0: "shown", 1: "shown, but the table violates a rule", 2: "nothing to show, or wrong arguments"},
    examples=("table table.json --out pictures", "table table.json --as rtmsafety --out tables"))  # fmt: skip
