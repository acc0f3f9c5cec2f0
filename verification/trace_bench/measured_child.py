# SPDX-License-Identifier: Apache-2.0
"""Runs one command and writes its resource usage: `measured_child.py RESULT LIMIT COMMAND...`.

A separate, small process, because the reported maximum memory of a process is never below that of its parent.
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
    except BaseException:  # stopped: no process may continue
        os.killpg(child, signal.SIGKILL)
        raise
    wall_s = time.monotonic() - started
    row = [os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, wall_s, used.ru_maxrss * 1024, ended]
    with open(result, "w", encoding="utf-8") as file:
        json.dump(row, file)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]), sys.argv[3:])
