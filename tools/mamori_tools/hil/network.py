# SPDX-License-Identifier: Apache-2.0
"""The network namespace of the processes: only a loopback device, with multicast, so no message leaves the host.

@satisfies SWR-HIL-007      Design: docs/design/safe_arm.md#hardware-in-the-loop
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from mamori_trace.base.errors import MissingError

URL = "udpm://239.255.76.67:7667?ttl=0"
PORT = 7667
CLONE_NEWNET = 0x40000000  # linux/sched.h
SET_UP = (("link", "set", "lo", "up", "multicast", "on"), ("route", "add", "224.0.0.0/4", "dev", "lo"))
TOOLS = {"ip": "iproute2", "lcm-logger": "liblcm-bin"}


def check_tools() -> None:
    """@raise MissingError if a tool is missing, or this process is not root."""
    for tool, package in TOOLS.items():
        if shutil.which(tool) is None:
            raise MissingError(f"hil: the tool '{tool}' is missing; as root: apt-get install --no-install-recommends {package}")
    if os.geteuid() != 0:
        raise MissingError("hil: a network namespace and fixed priorities need root; call this command as root, for example with sudo")


def enter_own_network() -> None:
    """Moves this process, and with it all later children, to a new network namespace. @raise MissingError if the system denies it."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(CLONE_NEWNET) != 0:
        reason = os.strerror(ctypes.get_errno())
        raise MissingError(f"hil: a network namespace cannot be made ({reason}); call this command as root, outside of a restricted container")
    for words in SET_UP:
        done = subprocess.run(["ip", *words], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise MissingError(f"hil: 'ip {' '.join(words)}' failed ({done.stderr.strip()}); the kernel must allow multicast on the loopback device")


def has_joined(pid: int) -> bool:
    """True once the process, or a child of it, has a UDP socket on the port of the LCM network."""
    inodes = {line.split()[9] for line in Path("/proc/self/net/udp").read_text(encoding="ascii").splitlines()[1:]
              if int(line.split()[1].rpartition(":")[2], 16) == PORT}  # fmt: skip
    return any(f"socket:[{inode}]" in _list_files(each) for each in (pid, *_list_children(pid)) for inode in inodes)


def wait_until(is_true: Callable[[], bool], limit_s: float) -> bool:
    """Polls until `is_true`. @return False after `limit_s`."""
    end = time.monotonic() + limit_s
    while not is_true():
        if time.monotonic() >= end:
            return False
        time.sleep(0.01)
    return True


def _list_files(pid: int) -> set[str]:
    files: set[str] = set()
    try:
        for entry in Path(f"/proc/{pid}/fd").iterdir():
            files.add(os.readlink(entry))
    except OSError:  # the process, or one of its files, has ended
        pass
    return files


def _list_children(pid: int) -> list[int]:
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()]
    except OSError:
        return []
