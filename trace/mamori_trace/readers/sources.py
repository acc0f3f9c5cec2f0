# SPDX-License-Identifier: Apache-2.0
"""One hash over all current sources, so that evidence can name its sources.

@satisfies SWR-TRC-035      Design: docs/design/trace.md#records
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from pathlib import Path

from mamori_trace.cache.questions import ask

_SHA1_DIGITS = 40
_SHA256_DIGITS = 64
_MADE = ("__pycache__", "node_modules", "target")


def calc_sources(root: Path, without: tuple[str, ...] = ()) -> str:
    """Hash over names and contents of all files below `root` that git does not ignore, committed or not; empty without git.

    The hash covers contents, not commits. git already knows the contents of unchanged files, so only changed files are read. A commit of
    tested files does not change the hash. @param without excluded paths and folders.
    """
    listed = ask(root, "ls-files", "-s", "-z")
    changed = ask(root, "ls-files", "-m", "-o", "--exclude-standard", "-z")
    if not listed:
        return ""
    contents: dict[str, str] = {}
    for row in filter(None, listed.split("\0")):
        about, _, name = row.partition("\t")
        contents[name] = about.split(" ")[1]
    digits = len(next(iter(contents.values()), "")) or _SHA1_DIGITS
    for name in sorted(set(filter(None, changed.split("\0")))):
        content = _hash_file(root / name, digits)
        if content:
            contents[name] = content
        else:
            contents.pop(name, None)
    kept = (name for name in sorted(contents) if not any(name == one or name.startswith(f"{one}/") for one in without))
    text = "".join(f"{contents[name]} {name}\n" for name in kept)
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()


def calc_sources_of(root: Path, folders: Sequence[str]) -> str:
    """Hash over names and contents of all files of `folders`, with or without git. Build output in them is excluded."""
    found: dict[str, Path] = {}
    for name in folders:
        top = root / name
        if top.is_file():
            found[name] = top
        for folder, inner, files in os.walk(top):
            inner[:] = [one for one in inner if one not in _MADE and not one.startswith((".", "build"))]
            paths = (Path(folder) / one for one in files if not one.endswith(".pyc"))
            found.update((path.relative_to(root).as_posix(), path) for path in paths)
    text = "".join(f"{_hash_file(found[name], _SHA256_DIGITS)} {name}\n" for name in sorted(found))
    return hashlib.sha256(text.encode(errors="surrogateescape")).hexdigest()


def _hash_file(path: Path, digits: int) -> str:
    """The git name of the content; empty for a removed file or anything but a file."""
    try:
        if path.is_symlink():
            data = os.fsencode(os.readlink(path))
        elif path.is_file():
            data = path.read_bytes()
        else:
            return ""
    except OSError:
        return "unreadable"
    maker = hashlib.sha1 if digits == _SHA1_DIGITS else hashlib.sha256
    return maker(b"blob %d\0" % len(data) + data).hexdigest()
