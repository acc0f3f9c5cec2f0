# SPDX-License-Identifier: Apache-2.0
"""Repeats the outcome of the last check of an unchanged project without reading it again.

An outcome is stored only if every input is known and none was written shortly before the run. It is repeated only if every input, git
query, tool file, argument, environment variable and the date are equal. A damaged or unexpected file does not count as an outcome.

@satisfies SWR-TRC-091, SWR-TRC-092      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from mamori_trace.cache import inputs, state

SCHEMA = "mamori_trace.outcome/1"
KEPT_MAX = 8
"""Maximum number of outcomes of one project; the oldest is removed first."""
OFF = "--no-cache"

_ACTION = "check"
_REPEATABLE = (0, 1)
_HARMLESS = {"_", "SHLVL", "OLDPWD", "PYTEST_CURRENT_TEST", "MAMORI_LOCK_KEYS"}


def run_kept(words: Sequence[str], run: Callable[[], int]) -> int:
    """The outcome of `run`, which is `mamori trace WORDS`: repeated if nothing changed since it was stored, otherwise computed and stored."""
    root = _find_root(words)
    if root is None:
        return run()
    folder = os.path.join(root, "build", state.FOLDER_NAME)
    key = _make_key(words)
    path = os.path.join(folder, f"{hashlib.sha256(json.dumps(key[:-1]).encode()).hexdigest()[:16]}.json")
    kept = _load(path)
    if kept is not None and kept["key"] == key and _is_unchanged(kept):
        sys.stdout.write(kept["out"])
        sys.stderr.write(kept["err"])
        return int(kept["status"])
    return _run_and_keep(words, root, key, path, run)


def _find_root(words: Sequence[str]) -> str | None:
    """Folder of the project whose outcome may be stored. None for another action, a forbidding option, or a missing folder `build`."""
    if list(words[:1]) != [_ACTION]:
        return None
    root = "."
    for index, word in enumerate(words):
        name, mark, value = word.partition("=")
        if name == "--root":
            root = value if mark else "".join(words[index + 1 : index + 2])
        elif len(name) > 2 and ("--root".startswith(name) or OFF.startswith(name)):
            return None  # also a shortened option, because argparse accepts it
    return root if os.path.isdir(os.path.join(root, "build")) else None


def _make_key(words: Sequence[str]) -> list[Any]:
    """All values besides the inputs that determine the outcome. The tool comes last, because it does not select the file."""
    environment = sorted((name, value) for name, value in os.environ.items() if name not in _HARMLESS)
    package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    libraries = [path for path in sys.path if path.endswith("site-packages")]
    tool = [sys.version, state.read_tool_state([package]), [state.read_listing(path) for path in libraries]]
    now = time.time()
    dates = [time.strftime("%Y-%m-%d", time.gmtime(now)), time.strftime("%Y-%m-%d", time.localtime(now))]
    secret = hashlib.sha256(json.dumps(environment).encode()).hexdigest()  # the environment may contain secrets
    key = [SCHEMA, list(words), os.getcwd(), sys.stdout.isatty(), sys.stderr.isatty(), secret, dates, tool]
    return json.loads(json.dumps(key))


def _load(path: str) -> dict[str, Any] | None:
    """A complete stored outcome, or None."""
    try:
        with open(path, "rb") as file:
            digest, _, body = file.read().partition(b"\n")
        if hashlib.sha256(body).hexdigest().encode() != digest:
            return None
        kept = json.loads(body)
        shape = {"key": list, "files": dict, "folders": dict, "questions": list, "out": str, "err": str, "status": int}
        is_whole = isinstance(kept, dict) and all(isinstance(kept.get(name), kind) for name, kind in shape.items())
        return kept if is_whole and kept["status"] in _REPEATABLE else None
    except (OSError, ValueError, RecursionError):
        return None


def _is_unchanged(kept: dict[str, Any]) -> bool:
    if any(state.read_file_state(path) != was for path, was in kept["files"].items()):
        return False
    if any(state.read_listing(path) != was for path, was in kept["folders"].items()):
        return False
    from mamori_trace.cache.questions import ask  # this import takes as long as the rest of the function

    return all(ask(root, *words) == answer for root, words, answer in kept["questions"])


def _run_and_keep(words: Sequence[str], root: str, key: list[Any], path: str, run: Callable[[], int]) -> int:
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        started_ns = state.read_clock_ns(os.path.dirname(path))
    except OSError:
        return run()  # the record lists no conditions of uncalled functions
    named = _list_named(words, root)
    out, err = _Copy(sys.stdout), _Copy(sys.stderr)
    watch = inputs.start()
    sys.stdout, sys.stderr = out, err
    try:
        status = run()
    finally:
        inputs.stop()
        sys.stdout, sys.stderr = out.stream, err.stream
    watch.folders = {**watch.folders, **named}
    tool = key[-1][1]
    racy = any(state.is_racy(one, started_ns) for one in [*watch.files.values(), *tool.values()])
    if status in _REPEATABLE and watch.is_sure and out.is_whole and err.is_whole and not racy and key == _make_key(words):
        kept = {"key": key, "files": watch.files, "folders": watch.folders, "questions": watch.questions,
                "out": out.text, "err": err.text, "status": status}  # fmt: skip
        _store(path, kept)
    return status


def _list_named(words: Sequence[str], root: str) -> dict[str, str | None]:
    """Folders in which a reader may search a name without listing them: below the project, its evidence, and each path in the arguments."""
    folders = state.list_folders(root)
    build = os.path.join(root, "build")
    for name in (state.read_listing(build) or "").split("\0"):
        folders |= state.list_folders(os.path.join(build, name[1:], "evidence"))
    for word in words[1:]:
        path = word.partition("=")[2] or word
        if os.path.abspath(path) not in folders:
            folders |= state.list_folders(path)
    return folders


def _store(path: str, kept: dict[str, Any]) -> None:
    """Writes the outcome atomically; a full disk must not fail a completed check."""
    body = json.dumps(kept, ensure_ascii=True).encode()
    folder = os.path.dirname(path)
    from mamori_trace.base.whole_file import whole_file  # not needed when an outcome is repeated

    with contextlib.suppress(OSError):
        with whole_file(Path(path)) as part:
            part.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
        others = sorted((entry for entry in os.scandir(folder) if entry.is_file()), key=lambda entry: entry.stat().st_mtime_ns)
        for entry in others[:-KEPT_MAX]:
            os.unlink(entry.path)


class _Copy(io.TextIOBase):
    """Forwards to a stream and keeps a copy of the text."""

    def __init__(self, stream: Any) -> None:
        self.stream = stream
        self.is_whole = True
        self._parts: list[str] = []

    def __getattr__(self, name: str) -> Any:
        """Forwards `buffer` and similar attributes, whose output is not copied."""
        self.is_whole = False
        return getattr(self.stream, name)

    def fileno(self) -> int:
        self.is_whole = False
        return self.stream.fileno()

    @property
    def text(self) -> str:
        return "".join(self._parts)

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return self.stream.encoding

    def write(self, text: str) -> int:
        self._parts.append(text)
        return self.stream.write(text)

    def flush(self) -> None:
        self.stream.flush()

    def isatty(self) -> bool:
        return self.stream.isatty()

    def writable(self) -> bool:
        return True
