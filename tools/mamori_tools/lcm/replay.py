# SPDX-License-Identifier: Apache-2.0
"""Replays a log with the replay mode of a program, twice, and compares the outputs.

@satisfies SWR-LCM-016      Design: docs/design/lcm.md#transports
"""

from __future__ import annotations

import itertools
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK, EXIT_USAGE
from mamori_tools.lcm.log_file import is_lcm_log
from mamori_trace.base.errors import InputError

HASH_LINE = "trace hash "
OPTION = "--replay"
HINT = "its main function must return mamori::ports::lcm::replay_main(...)"


@dataclass(frozen=True)
class _Run:
    status: int
    output: str
    errors: str


def replay(log: Path, program: Path, arguments: tuple[str, ...]) -> int:
    """@return exit status: failed for a damaged log or different outputs. @raise InputError for a file that is not a log, or a program without
    replay mode."""
    if not is_lcm_log(log):
        raise InputError("not a log of lcm-logger; specify the path of the log", log)
    if not program.is_file():
        raise InputError("not a program; build it, then specify its path", program)
    first = _run(log, program, arguments)
    print(first.output, end="", flush=True)
    if first.errors:
        print(first.errors, end="" if first.errors.endswith("\n") else "\n", file=sys.stderr)
    if first.status:
        print(f"mamori: {program} ended with status {first.status}; ./mamori log {log} lists all damaged parts of the log", file=sys.stderr)
        return EXIT_FAILED
    second = _run(log, program, arguments)
    if second != first:
        print(f"mamori: {_describe_difference(first, second)}; the program depends on more than the log", file=sys.stderr)
        return EXIT_FAILED
    print("mamori: both replays have this output", file=sys.stderr)
    return EXIT_OK


def _run(log: Path, program: Path, arguments: tuple[str, ...]) -> _Run:
    try:
        done = subprocess.run([str(program.absolute()), *arguments, OPTION, str(log.absolute())], capture_output=True, check=False,
                              stdin=subprocess.DEVNULL)  # fmt: skip
    except OSError as error:
        raise InputError(f"cannot be started: {error.strerror}; specify an executable program", program) from error
    output, errors = (text.decode("utf-8", "backslashreplace") for text in (done.stdout, done.stderr))
    if done.returncode == EXIT_USAGE:
        raise InputError(f"rejects the replay: {errors.strip() or 'no reason'}; {HINT}", program)
    if done.returncode < 0:
        raise InputError(f"was ended by signal {-done.returncode} during the replay", program)
    if HASH_LINE not in output:
        raise InputError(f"prints no trace hash; {HINT}", program)
    return _Run(done.returncode, output, errors)


def _describe_difference(first: _Run, second: _Run) -> str:
    if first.status != second.status:
        return f"two replays ended with status {first.status} and {second.status}"
    lines = itertools.zip_longest((first.output + first.errors).splitlines(), (second.output + second.errors).splitlines(), fillvalue="")
    return "two replays differ: " + next((f"'{one}' and '{other}'" for one, other in lines if one != other), "line ends")
