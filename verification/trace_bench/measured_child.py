# SPDX-License-Identifier: Apache-2.0
"""Runs one command and writes what it took: `measured_child.py RESULT LIMIT COMMAND...`.

A process of its own, as small as can be: the largest memory that the system tells of a process is never below that of the one that started it.
"""

import json
import os
import signal
import sys
import time

_POLL_S = 0.01


def main(result: str, limit_s: float, command: list[str]) -> None:
    started = time.monotonic()
    child = os.posix_spawnp(command[0], command, os.environ, setsid=True)
    try:
        ended = True
        while True:
            done, status, used = os.wait4(child, os.WNOHANG)
            if done:
                break
            if ended and time.monotonic() - started > limit_s:
                ended = False
                os.killpg(child, signal.SIGKILL)
            time.sleep(_POLL_S)
    except BaseException:  # stopped: nothing may run on
        os.killpg(child, signal.SIGKILL)
        raise
    wall_s = time.monotonic() - started
    row = [os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, wall_s, used.ru_maxrss * 1024, ended]
    with open(result, "w", encoding="utf-8") as file:
        json.dump(row, file)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), sys.argv[3:])
