# SPDX-License-Identifier: Apache-2.0
"""Records the inputs of a run: every opened file, listed folder and git query, in all modules.

Python reports each input through its audit events, so a new reader needs no code for the cache. If the watch cannot check an input (another
process, a connection, a written file), the outcome is not stored.

@satisfies SWR-TRC-091      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import os
import sys
from typing import Any

from mamori_trace.cache.state import FOLDER_NAME, FileState, read_file_state, read_listing

_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_UNKNOWN = ("os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "os.forkpty", "pty.spawn", "socket.connect", "sqlite3.connect",
            "os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.truncate", "os.chdir")  # fmt: skip
_LIVING = ("/proc/", "/sys/", "/dev/")


class InputWatch:
    """The inputs read between `start` and `stop`, each with its state just before the first access."""

    def __init__(self) -> None:
        self.files: dict[str, FileState] = {}
        self.folders: dict[str, str | None] = {}
        self.questions: list[tuple[str, tuple[str, ...], str]] = []
        self.doubt = ""
        self._process_count = 0

    @property
    def is_sure(self) -> bool:
        """Whether all inputs are known."""
        return not self.doubt and self._process_count == len(self.questions)

    def take(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event == "open":
            self._take_open(*arguments)
        elif event in ("os.scandir", "os.listdir"):
            self._take_listing(arguments[0])
        elif event == "subprocess.Popen":
            self._process_count += 1
        elif event in _UNKNOWN and not _is_byte_code(arguments):
            self.doubt = event

    def _take_open(self, path: Any, _mode: str | None, flags: int) -> None:
        if isinstance(path, int) or _is_byte_code((path,)):
            return  # an already open descriptor, or a byte-code file of Python
        name = os.path.abspath(os.fsdecode(path))
        if flags & _WRITING or name.startswith(_LIVING):
            self.doubt = self.doubt or ("" if name == os.devnull else f"open {name}")
        elif name not in self.files:
            self.files[name] = read_file_state(name)

    def _take_listing(self, path: Any) -> None:
        if isinstance(path, int):
            self.doubt = "a folder listed by its descriptor"
            return
        name = os.path.abspath(os.fsdecode(path or "."))
        if name not in self.folders and os.path.basename(name) != FOLDER_NAME:
            self.folders[name] = ""  # recorded first, because the following line also lists the folder
            self.folders[name] = read_listing(name)


_active: InputWatch | None = None
_is_hooked = False


def start() -> InputWatch:
    """Starts a new watch; a running watch is abandoned."""
    global _active, _is_hooked
    if not _is_hooked:
        sys.addaudithook(_hook)  # stays until the process ends; has no effect between watches
        _is_hooked = True
    _active = InputWatch()
    return _active


def stop() -> None:
    global _active
    _active = None


def note_question(root: str, arguments: tuple[str, ...], answer: str) -> None:
    """Records a git query whose process the watch has seen. The query can be repeated; its output is the same if nothing changed."""
    if _active is not None:
        _active.questions.append((os.path.abspath(root), arguments, answer))


def _hook(event: str, arguments: tuple[Any, ...]) -> None:
    if _active is not None:
        _active.take(event, arguments)


def _is_byte_code(arguments: tuple[Any, ...]) -> bool:
    return any(isinstance(one, str) and (one.endswith((".pyc", "__pycache__")) or ".pyc." in one) for one in arguments)
