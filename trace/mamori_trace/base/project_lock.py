# SPDX-License-Identifier: Apache-2.0
"""Permits only one writing command at a time in a project folder: an exclusive `flock` on `build/mamori.lock`, which names its holder.

The kernel releases the lock when its holder ends for any reason. A remaining file is therefore not a lock.
Child processes do not inherit the descriptor. They inherit the key of the lock in the environment, which gives them access.

@satisfies SWR-CLI-040, SWR-CLI-041      Design: docs/design/launcher.md#lock
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import secrets
import stat
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import MissingError

LOCK = Path("build", "mamori.lock")
KEYS = "MAMORI_LOCK_KEYS"
"""Environment variable with the keys of all locks that the callers of this process hold."""
_READ_TRIES = 20
_READ_PAUSE_S = 0.02


@contextlib.contextmanager
def hold_lock(folder: Path, command: str) -> Iterator[None]:
    """Holds the lock of `folder` for `command`; has no effect if a caller of this process holds it.

    Raises MissingError immediately if another command holds it, OSError if the file cannot be created.
    """
    path = folder.resolve() / LOCK
    is_made = not path.parent.exists()
    descriptor = _acquire(path)
    if descriptor is None:
        yield
        return
    key, keys = secrets.token_hex(8), os.environ.get(KEYS)
    try:
        holder = {"pid": os.getpid(), "start": time.strftime("%Y-%m-%d %H:%M:%S"), "command": command, "key": key}
        os.ftruncate(descriptor, 0)
        os.write(descriptor, json.dumps(holder).encode() + b"\n")
        os.environ[KEYS] = f"{keys} {key}" if keys else key
        yield
    finally:
        if keys is None:
            os.environ.pop(KEYS, None)
        else:
            os.environ[KEYS] = keys
        with contextlib.suppress(OSError):
            path.unlink()  # before the release: a process that opened the file meanwhile detects the removed name and opens it again
            if is_made:
                path.parent.rmdir()
        os.close(descriptor)


def _acquire(path: Path) -> int | None:
    """A descriptor that holds the lock; None if a caller of this process holds it. Raises MissingError and OSError."""
    tries = 0
    while True:
        try:
            path.parent.mkdir(exist_ok=True)
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o666)
        except (FileExistsError, FileNotFoundError):  # the previous holder removed its folder between two steps
            if not path.parents[1].is_dir() or _is_in_the_way(path.parent):
                raise
            continue
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if _is_same_file(descriptor, path):
                kept, descriptor = descriptor, -1
                return kept
        except BlockingIOError:
            holder = _read_holder(descriptor)
            if holder is not None and holder.get("key") in os.environ.get(KEYS, "").split() and _is_running(holder):
                return None
            tries += 1
            if _is_running(holder) or tries >= _READ_TRIES:
                raise MissingError(_describe(holder, path)) from None
            time.sleep(_READ_PAUSE_S)  # the holder has not yet written its name
        finally:
            if descriptor >= 0:
                os.close(descriptor)


def _is_in_the_way(folder: Path) -> bool:
    """True if the name belongs to something other than a folder or a link to a folder."""
    try:
        mode = folder.lstat().st_mode
    except FileNotFoundError:
        return False
    return not stat.S_ISDIR(mode) and not folder.is_dir()


def _is_same_file(descriptor: int, path: Path) -> bool:
    """False if the previous holder removed the file between opening and locking."""
    try:
        named = path.stat()
    except FileNotFoundError:
        return False
    held = os.fstat(descriptor)
    return (named.st_dev, named.st_ino) == (held.st_dev, held.st_ino)


def _read_holder(descriptor: int) -> dict[str, Any] | None:
    try:
        holder = json.loads(os.pread(descriptor, 65536, 0))
    except ValueError:
        return None
    return holder if isinstance(holder, dict) else None


def _is_running(holder: dict[str, Any] | None) -> bool:
    pid = holder.get("pid") if holder else None
    return isinstance(pid, int) and Path("/proc", str(pid)).exists()


def _describe(holder: dict[str, Any] | None, path: Path) -> str:
    who = "another command"
    if holder is not None:
        command = " ".join(str(holder.get("command")).split())
        who = f"'{command}' (process {holder.get('pid')}, started {holder.get('start')})"
    return f"{path.parents[1]}: {who} writes there; wait for its end, or stop it, then call again"
