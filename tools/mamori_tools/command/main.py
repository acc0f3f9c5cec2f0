# SPDX-License-Identifier: Apache-2.0
"""Entry of the command: arguments, exit status, orderly stop.

The launcher script prints the help texts before anything is installed. They are stored by mamori_tools.command.help_texts.

@satisfies SWR-CLI-004, SWR-CLI-005, SWR-CLI-008, SWR-CLI-044, SWR-CLI-046      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib.metadata import EntryPoint, entry_points

from mamori_tools.command.locks import hold_locks
from mamori_tools.host.arguments import PROGRAM, Command, Parser
from mamori_tools.host.exit_status import EXIT_INTERRUPTED, EXIT_MISSING, EXIT_OK, EXIT_PIPE, EXIT_USAGE
from mamori_tools.host.process import discard_output, end_children, raise_on_signals
from mamori_trace.base.errors import InputError, MissingError
from mamori_trace.base.system_error import describe

GROUP = "mamori.commands"
TRACE = "trace"
ORDER = ("demo", "run", "campaign", "test", "build", "verify", "new", TRACE, "log",
         "bench", "timing", "cost", "e2e", "table", "constraint", "profile", "mutate", "fuzz", "prove")  # fmt: skip
"""Of the overview. Other commands follow in alphabetical order."""
ABOUT = ("Mamori is a safety-oriented real-time middleware kernel for robots. Its tools turn a build into evidence.\n\n"
         "./mamori COMMAND --help shows the options of a command.")  # fmt: skip
HELP = ("help", "-h", "--help")


def list_commands() -> dict[str, EntryPoint]:
    """The registered commands by name. Each command is imported on its first call."""
    return {point.name: point for point in sorted(entry_points(group=GROUP), key=lambda point: point.name)}


def make_parser(wanted: str | None = None, with_trace: bool = False) -> Parser:
    """@param wanted the command whose arguments are added; None: all except `trace`, whose libraries only `trace` needs."""
    parser = Parser(prog=PROGRAM, allow_abbrev=False, usage="%(prog)s COMMAND [options]", description=ABOUT)
    parser.statuses = {4: "timing without real-time privileges"}
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=Parser, prog=PROGRAM)
    points = list_commands()
    for name in sorted({TRACE, *points}, key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name)):
        if name != TRACE:
            _add_command(commands, points[name], wanted in (None, name))
        elif wanted == TRACE or with_trace:
            from mamori_trace.command import add_arguments, run

            add_arguments(commands)
            commands.choices[TRACE].set_defaults(run=run)
            commands.choices[TRACE].statuses = {1: "a finding of severity error; `record` ends with the status of its test command"}
    return parser


def _add_command(commands: argparse._SubParsersAction[Parser], point: EntryPoint, is_loaded: bool) -> None:
    if not is_loaded:
        commands.add_parser(point.name, allow_abbrev=False)
        return
    command: Command = point.load()
    epilog = "\n".join(["examples:", *(f"  ./mamori {line}" for line in command.examples)]) if command.examples else None
    own = commands.add_parser(point.name, allow_abbrev=False, help=command.summary, description=command.description, epilog=epilog)
    own.statuses, own.usage_end = command.statuses, command.usage_end
    command.add_arguments(own)
    own.set_defaults(run=command.run)


def run(argv: list[str]) -> int:
    """Runs the command. @return the exit status."""
    if argv and argv[0] in HELP:
        print(make_parser(with_trace=True).format_help(), end="")
        return EXIT_OK
    own, passed_on = _split(argv)
    arguments = make_parser(own[0] if own else "").parse_args(own)
    arguments.passed_on = passed_on
    with hold_locks(arguments, argv):
        return _dispatch(arguments)


def _dispatch(arguments: argparse.Namespace) -> int:
    status: int = arguments.run(arguments)
    return status


def _split(argv: list[str]) -> tuple[list[str], tuple[str, ...]]:
    """@return the arguments of the command, and those after the first `--`, which `timing` and `lcm` forward to their program."""
    if not argv or argv[0] not in ("timing", "lcm") or "--" not in argv:
        return argv, ()
    place = argv.index("--")
    return argv[:place], tuple(argv[place + 1 :])


def main(argv: Sequence[str] | None = None) -> int:
    """@return exit status: 0, 1 (something failed), 2 (wrong arguments or input), 3 (a tool is missing, or another command holds the lock),
    4 (timing without privileges), 130 (stopped) or 141 (the reader of the output has ended)."""
    try:
        raise_on_signals()
        status = run(list(sys.argv[1:] if argv is None else argv))
        sys.stdout.flush()  # output errors occur here, not when Python ends
        return status
    except BrokenPipeError:  # the reader of standard output has ended
        discard_output()
        return EXIT_PIPE
    except InputError as error:
        return _refuse(str(error), EXIT_USAGE)
    except MissingError as error:
        return _refuse(str(error), EXIT_MISSING)
    except OSError as error:
        try:
            sys.stdout.flush()
        except OSError:  # the remaining output would fail again when Python ends
            discard_output()
        return _refuse(describe(error), EXIT_USAGE)
    except UnicodeEncodeError as error:
        return _refuse(f"{error.object!a} has a character that is not valid text; use names in UTF-8", EXIT_USAGE)
    except KeyboardInterrupt:
        end_children()
        print(f"\n{PROGRAM}: stopped; no report was written", file=sys.stderr)
        return EXIT_INTERRUPTED


def _refuse(message: str, status: int) -> int:
    """Makes one line of any name that the user gives."""
    line = " ".join(message.split())
    print(f"{PROGRAM}: {line.encode('utf-8', 'backslashreplace').decode('utf-8')}", file=sys.stderr)
    return status
