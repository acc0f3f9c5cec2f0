# SPDX-License-Identifier: Apache-2.0
"""`mamori trace ACTION`: calls the module of the action.

Exit status: 0 clean, 1 findings of severity error, 2 wrong usage or unreadable input, 3 another command writes there; for `record` the
status of its command.

@satisfies SWR-TRC-010, SWR-TRC-008      Design: docs/design/trace.md#command
"""

from __future__ import annotations

import argparse
import gc
import importlib
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from types import ModuleType

from mamori_trace.base.errors import InputError, MissingError
from mamori_trace.base.project_lock import hold_lock
from mamori_trace.base.system_error import describe

_SUMMARY = "requirements: check every link and result, show the chain from hazard to result, write the report"
_ABOUT = "Compares requirements with the results of executed tests, and shows the chain from hazard to result."
_EPILOG = """check, report and show take --format FORMAT PATH for a project in the format of another tool.

./mamori trace check --help shows the options of an action. docs/manual/trace.md has examples."""
_ACTIONS = {
    "check": "check",
    "report": "report",
    "show": "show",
    "review": "review",
    "impact": "impact",
    "init": "init",
    "new": "new",
    "query": "query",
    "bundle": "bundle",
    "verify": "verify",
    "record": "record",
    "import": "import_items",
    "export": "export_items",
}
"""Module of each action, below `actions`."""
_WRITERS = ("report", "review", "init", "new", "record", "import", "bundle")
"""Actions that change the project, or need unchanged evidence while they run."""
_EXIT_INPUT = 2
_EXIT_LOCKED = 3
_EXIT_PIPE = 141
"""Exit status of a program that wrote to a closed pipe, in the convention of the shell."""
_SHOWN_MAX = 400


def add_arguments(subparsers: argparse._SubParsersAction) -> None:
    """Adds the command `trace` to the sub-commands of the main command."""
    _add_actions(subparsers.add_parser("trace", help=_SUMMARY, description=_ABOUT, epilog=_EPILOG), list(_ACTIONS))


def run(arguments: argparse.Namespace) -> int:
    """Runs what `add_arguments` parsed. @return the exit status."""
    try:
        with _without_collector(), _hold_lock(arguments):
            status = int(_load(arguments.trace_action).run(arguments))
        sys.stdout.flush()  # output errors occur here, and not when Python ends
        return status
    except BrokenPipeError:  # the reader, such as `head`, has read enough
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (Python closes it at its end)
        return _EXIT_PIPE
    except MissingError as error:
        _refuse(str(error))
        return _EXIT_LOCKED
    except InputError as error:
        return _refuse(str(error))
    except OSError as error:
        return _refuse(describe(error))
    except UnicodeEncodeError as error:  # half of a surrogate pair, from an argument, a file name or a JSON escape; no file can store it
        near = error.object[max(0, error.start - 20) : error.end]
        return _refuse(f"nothing was written: {near!a} ends with what is no letter, so UTF-8 cannot hold it")


def _refuse(message: str) -> int:
    if len(message) > 2 * _SHOWN_MAX:  # an argument may have any length; the remedy is at the end of the message
        message = f"{message[:_SHOWN_MAX]} ... {message[-_SHOWN_MAX:]}"
    print(f"mamori trace: {message}", file=sys.stderr)
    return _EXIT_INPUT


def main(argv: Sequence[str] | None = None) -> int:
    """@return the exit status; argparse ends the process with 2 on wrong usage."""
    words = sys.argv[1:] if argv is None else argv
    parser = argparse.ArgumentParser(prog="mamori trace", description=_ABOUT, epilog=_EPILOG)
    # The first argument names the action; the remaining arguments do not need the other action modules.
    _add_actions(parser, [words[0]] if words and words[0] in _ACTIONS else list(_ACTIONS))
    return run(parser.parse_args(argv))


@contextmanager
def _without_collector() -> Iterator[None]:
    """Pauses Python's search for cyclic garbage. A run keeps its inputs until its end, so searches find nothing, but take a twentieth of
    the time."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


@contextmanager
def _hold_lock(arguments: argparse.Namespace) -> Iterator[None]:
    """The lock of the project during a writing action. If its file cannot be created, the action itself reports the error."""
    with ExitStack() as stack:
        if arguments.trace_action in _WRITERS and arguments.root.is_dir():
            with suppress(OSError):
                stack.enter_context(hold_lock(arguments.root, f"mamori trace {arguments.trace_action}"))
        yield


def _add_actions(parser: argparse.ArgumentParser, names: Sequence[str]) -> None:
    actions = parser.add_subparsers(dest="trace_action", required=True, metavar="|".join(_ACTIONS), prog=parser.prog)
    parser.usage = "%(prog)s ACTION [options]"
    for name in names:
        action = _load(name)
        action.add_arguments(actions.add_parser(name, help=action.HELP, description=f"{action.HELP[0].upper()}{action.HELP[1:]}."))


def _load(name: str) -> ModuleType:
    return importlib.import_module(f"mamori_trace.actions.{_ACTIONS[name]}")
