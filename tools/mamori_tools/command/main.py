# SPDX-License-Identifier: Apache-2.0
"""Entry of the command: arguments, exit status, orderly stop.

The help texts are those of the launcher script, which answers --help before anything is installed.

@satisfies SWR-CLI-005, SWR-CLI-008, SWR-CLI-044, SWR-CLI-046      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib.metadata import EntryPoint, entry_points

from mamori_tools.command.locks import hold_locks
from mamori_tools.host.arguments import PROGRAM, Command, Parser
from mamori_tools.host.exit_status import EXIT_INTERRUPTED, EXIT_MISSING, EXIT_PIPE, EXIT_USAGE
from mamori_tools.host.process import discard_output, end_children, raise_on_signals
from mamori_trace.base.errors import InputError, MissingError
from mamori_trace.base.system_error import describe

GROUP = "mamori.commands"


def list_commands() -> dict[str, EntryPoint]:
    """The registered commands by name. A command is imported when it is called."""
    return {point.name: point for point in sorted(entry_points(group=GROUP), key=lambda point: point.name)}


def make_parser(wanted: str | None = None) -> Parser:
    """@param wanted the command whose arguments are known; None: all but `trace`, whose libraries no other command needs."""
    parser = Parser(prog=PROGRAM, allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=Parser)
    for name, point in list_commands().items():
        own = commands.add_parser(name, allow_abbrev=False)
        if wanted in (None, name):
            command: Command = point.load()
            command.add_arguments(own)
            own.set_defaults(run=command.run)
    if wanted == "trace":
        from mamori_trace.command import add_arguments, run

        add_arguments(commands)
        commands.choices["trace"].set_defaults(run=run)
    return parser


def run(argv: list[str]) -> int:
    """Runs the command. @return the exit status."""
    own, passed_on = _split(argv)
    arguments = make_parser(own[0] if own else "").parse_args(own)
    arguments.passed_on = passed_on
    with hold_locks(arguments, argv):
        return _dispatch(arguments)


def _dispatch(arguments: argparse.Namespace) -> int:
    status: int = arguments.run(arguments)
    return status


def _split(argv: list[str]) -> tuple[list[str], tuple[str, ...]]:
    """@return our own words, and those that `timing` passes on: what comes after the first `--`."""
    if argv[:1] != ["timing"] or "--" not in argv:
        return argv, ()
    place = argv.index("--")
    return argv[:place], tuple(argv[place + 1 :])


def main(argv: Sequence[str] | None = None) -> int:
    """@return exit status: 0, 1 (something failed), 2 (wrong arguments or input), 3 (a tool is missing, or another command holds
    the lock), 4 (timing without rights), 130 (stopped) or 141 (nobody reads the output)."""
    try:
        raise_on_signals()
        status = run(list(sys.argv[1:] if argv is None else argv))
        sys.stdout.flush()  # what cannot be written is reported here, not when Python ends
        return status
    except BrokenPipeError:  # whoever reads standard output has read enough
        discard_output()
        return EXIT_PIPE
    except InputError as error:
        return _refuse(str(error), EXIT_USAGE)
    except MissingError as error:
        return _refuse(str(error), EXIT_MISSING)
    except OSError as error:
        try:
            sys.stdout.flush()
        except OSError:  # what is left would fail once more when Python ends
            discard_output()
        return _refuse(describe(error), EXIT_USAGE)
    except UnicodeEncodeError as error:
        return _refuse(f"{error.object!a} has a character that is not valid text; use names in UTF-8", EXIT_USAGE)
    except KeyboardInterrupt:
        end_children()
        print(f"\n{PROGRAM}: stopped; no report was written", file=sys.stderr)
        return EXIT_INTERRUPTED


def _refuse(message: str, status: int) -> int:
    """One line, whatever a name of the user's contains."""
    line = " ".join(message.split())
    print(f"{PROGRAM}: {line.encode('utf-8', 'backslashreplace').decode('utf-8')}", file=sys.stderr)
    return status
