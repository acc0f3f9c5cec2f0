# SPDX-License-Identifier: Apache-2.0
"""Entry of the command: arguments, exit status, orderly stop.

The help texts are those of the launcher script, which answers --help before anything is installed.

@satisfies SWR-CLI-005, SWR-CLI-008, SWR-CLI-044, SWR-CLI-046      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from mamori.profiles.input_error import InputError, nearest_names
from mamori.trace.system_error import describe
from mamori.verification.command import jobs
from mamori.verification.command.errors import EXIT_INTERRUPTED, EXIT_MISSING, EXIT_PIPE, EXIT_USAGE, MissingError, UsageError
from mamori.verification.command.locks import hold_locks
from mamori.verification.command.process import discard_output, end_children, raise_on_signals
from mamori.verification.command.project import RELEASE
from mamori.verification.command.steps import Tier
from mamori.verification.recorder import command as recorder_log
from mamori.verification.table_dump import command as table_dump

PROGRAM = "mamori"
DIGITS_MAX = 12  # of an option that counts something


class Parser(argparse.ArgumentParser):
    """Answers a wrong word with one line that names the nearest right ones."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{self.prog.removeprefix(PROGRAM).strip() or PROGRAM}: {message}")

    def _check_value(self, action: argparse.Action, value: object) -> None:
        if action.choices is not None and value not in action.choices:
            where = self.prog.removeprefix(PROGRAM).strip() or "the command line"
            raise UsageError(f"{where}: there is no '{value}'; {nearest_names(str(value), map(str, action.choices))}")

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def]
        known, rest = super().parse_known_args(args, namespace)
        if rest:
            raise UsageError(self._describe_unknown(rest[0]))
        return known, rest

    def _describe_unknown(self, word: str) -> str:
        command = self.prog.removeprefix(PROGRAM).strip()
        if not word.startswith("-"):
            return f"{command} does not take '{word}'; see ./mamori {command} --help"
        options = [text for action in self._actions for text in action.option_strings]
        return f"{command} has no option '{word}'; {nearest_names(word.partition('=')[0], options)}"


def at_least_one(text: str) -> int:
    """Type of an option that counts something."""
    if not (text.isascii() and text.isdecimal()) or not text.strip("0"):
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 1 on")
    if len(text) > DIGITS_MAX:
        raise argparse.ArgumentTypeError(f"'{text[:DIGITS_MAX]}...' has more than {DIGITS_MAX} digits; give a smaller number")
    return int(text)


def make_parser(with_trace: bool = False) -> Parser:
    """@param with_trace mount the trace tool, whose libraries no other command needs."""
    parser = Parser(prog=PROGRAM, allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=Parser)

    def add(name: str, with_project: bool = False) -> argparse.ArgumentParser:
        command = commands.add_parser(name, allow_abbrev=False)
        command.add_argument("--jobs", type=at_least_one, default=os.cpu_count() or 1, metavar="N")
        if with_project:
            command.add_argument("project", nargs="?", type=Path, metavar="PROJECT")
        return command

    demo = add("demo")
    demo.add_argument("--motion", type=Path, metavar="FILE")
    demo.add_argument("--scenario", nargs="+", default=[], metavar="NAME", action="extend")
    demo.add_argument("--instants", type=at_least_one, metavar="N")
    one = add("run")
    one.add_argument("--motion", type=Path, metavar="FILE")
    one.add_argument("--fault", metavar="FAULT")
    tier = add("test").add_mutually_exclusive_group()
    for option, steps in (("--quick", Tier.QUICK), ("--all", Tier.ALL)):
        tier.add_argument(option, action="store_const", dest="tier", const=steps, default=Tier.GATE)
    add("build", with_project=True).add_argument("--preset", default=RELEASE, metavar="NAME")
    add("verify", with_project=True)
    commands.add_parser("new", allow_abbrev=False).add_argument("path", type=Path, metavar="NAME")
    recorder_log.add_arguments(commands.add_parser("log", allow_abbrev=False))
    table_dump.add_arguments(commands.add_parser("table", allow_abbrev=False))
    bench = add("bench")
    bench.add_argument("--only", nargs="+", default=[], metavar="NAME", action="extend")
    bench.add_argument("--out", type=Path, metavar="DIR")
    for option in ("--quick", "--gate", "--list", "--accept", "--json"):
        bench.add_argument(option, action="store_true")
    mutate = add("mutate")
    mutate.add_argument("files", nargs="*", metavar="FILE")
    mutate.add_argument("--sample", type=at_least_one, metavar="N")
    mutate.add_argument("--seed", type=int, default=1, metavar="S")
    mutate.add_argument("--list", action="store_true")
    mutate.add_argument("--store", action="store_true")
    mutate.add_argument("--missing", action="store_true")
    timing = add("timing")
    timing.add_argument("system", metavar="SYSTEM")
    timing.add_argument("--cycles", type=at_least_one, default=60_000, metavar="N")
    timing.add_argument("--out", type=Path, metavar="DIR")
    timing.add_argument("--load", action="store_true")
    timing.add_argument("--check", type=Path, metavar="BASELINE")
    timing.add_argument("--accept", type=Path, metavar="BASELINE")
    timing.add_argument("--json", action="store_true")
    cost = add("cost")
    cost.add_argument("system", metavar="SYSTEM")
    cost.add_argument("--class", nargs="+", default=[], metavar="NAME", action="extend", dest="classes")
    cost.add_argument("--out", type=Path, metavar="DIR")
    cost.add_argument("--check", type=Path, metavar="BASELINE")
    cost.add_argument("--accept", type=Path, metavar="BASELINE")
    cost.add_argument("--json", action="store_true")
    end_to_end = commands.add_parser("e2e", allow_abbrev=False)
    for option in ("--profile", "--length", "--rate", "--pe"):
        end_to_end.add_argument(option, required=True, metavar=option.removeprefix("--").upper())
    end_to_end.add_argument("--receivers", default="1", metavar="M")
    end_to_end.add_argument("--json", action="store_true")
    prove = add("prove")
    prove.add_argument("machine", choices=("safe-state",), metavar="MACHINE")
    prove.add_argument("--json", action="store_true")
    prove.add_argument("--out", type=Path, metavar="DIR")
    prove.add_argument("--defect", metavar="NAME")
    fuzz = add("fuzz")
    fuzz.add_argument("names", nargs="*", metavar="NAME")
    fuzz.add_argument("--seconds", type=at_least_one, default=30, metavar="N")
    fuzz.add_argument("--keep", action="store_true")
    if with_trace:
        from mamori.trace.command import add_arguments

        add_arguments(commands)
    return parser


def run(argv: list[str]) -> int:
    """Runs the command. @return the exit status."""
    own, passed_on = _split(argv)
    arguments = make_parser(with_trace=argv[:1] == ["trace"]).parse_args(own)
    with hold_locks(arguments, argv):
        return _dispatch(arguments, passed_on)


def _dispatch(arguments: argparse.Namespace, passed_on: tuple[str, ...]) -> int:
    match arguments.command:
        case "demo":
            return jobs.demo(arguments.jobs, arguments.motion, tuple(arguments.scenario), arguments.instants)
        case "run":
            from mamori.verification.command.run_case import run_case

            return run_case(arguments.jobs, arguments.motion, arguments.fault)
        case "test":
            return jobs.test(arguments.jobs, arguments.tier)
        case "build":
            return jobs.build(arguments.jobs, arguments.project, arguments.preset)
        case "verify":
            return jobs.verify(arguments.jobs, arguments.project)
        case "new":
            from mamori.verification.command.new_project import new

            return new(arguments.path)
        case "log":
            return recorder_log.run(arguments)
        case "table":
            return table_dump.run(arguments)
        case "bench":
            return _run_bench(arguments)
        case "timing":
            return _run_timing(arguments, passed_on)
        case "cost":
            from mamori.verification.cost import command as costing

            wanted = costing.Request(arguments.system, tuple(arguments.classes), arguments.out, arguments.check, arguments.accept,
                                     arguments.json)  # fmt: skip
            return costing.cost(wanted, arguments.jobs)
        case "e2e":
            from mamori.verification.e2e import command as end_to_end

            return end_to_end.run(arguments)
        case "mutate":
            from mamori.verification.mutation import command as mutation

            return mutation.mutate(
                mutation.Request(tuple(arguments.files), arguments.sample, arguments.seed, arguments.jobs, arguments.list,
                                 arguments.store, arguments.missing)
            )  # fmt: skip
        case "prove":
            from mamori.verification.safe_state import command as proving

            return proving.prove_safe_state(proving.Request(arguments.json, arguments.out, arguments.defect, arguments.jobs))
        case "fuzz":
            from mamori.verification.fuzz import command as fuzzing

            return fuzzing.fuzz(fuzzing.Request(tuple(arguments.names), arguments.seconds, arguments.jobs, arguments.keep))
        case _:
            from mamori.trace.command import run as run_trace

            return run_trace(arguments)


def _split(argv: list[str]) -> tuple[list[str], tuple[str, ...]]:
    """@return our own words, and those that `timing` passes on: what comes after the first `--`."""
    if argv[:1] != ["timing"] or "--" not in argv:
        return argv, ()
    place = argv.index("--")
    return argv[:place], tuple(argv[place + 1 :])


def _run_bench(arguments: argparse.Namespace) -> int:
    from mamori.verification.bench.command import Request, bench, list_benches

    if arguments.list:
        return list_benches()
    request = Request(tuple(arguments.only), arguments.quick, arguments.gate, arguments.accept, arguments.out, arguments.json)
    return bench(request, arguments.jobs)


def _run_timing(arguments: argparse.Namespace, passed_on: tuple[str, ...]) -> int:
    from mamori.verification.timing.command import Request, timing

    request = Request(arguments.system, arguments.cycles, arguments.out, arguments.load, arguments.check, arguments.accept, passed_on,
                      arguments.json)  # fmt: skip
    return timing(request, arguments.jobs)


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
    except (UsageError, InputError) as error:
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
