# SPDX-License-Identifier: Apache-2.0
"""Reads the content of a bundle, folder or archive, in bounded memory; links and special files are listed but never opened.

@satisfies SWR-TRC-075, SWR-TRC-076      Design: docs/design/trace.md#verify
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator
from pathlib import Path

from mamori_trace.base.errors import FormatError, InputError
from mamori_trace.base.system_error import explain
from mamori_trace.base.tar_file import MAX_MEMBERS, read_members
from mamori_trace.model.bundle import MANIFEST, SIGNATURE, Content, Entry

_CHUNK = 1 << 16
_MAX_MANIFEST = 64 * 1024 * 1024
_MAX_SIGNATURE = 64 * 1024
_KEPT = {MANIFEST: _MAX_MANIFEST, SIGNATURE: _MAX_SIGNATURE}


def read_bundle(path: Path) -> Content:
    """Raises InputError if there is nothing to read, or the archive is rejected."""
    if path.is_dir():
        return _read_folder(path)
    if not path.is_file():
        raise InputError(f"{path}: no such bundle; name the folder or the .tar file that `mamori trace bundle` wrote")
    content = Content()
    try:
        with path.open("rb") as file:
            for name, size, chunks in read_members(file):
                _take(content, name, size, chunks)
    except FormatError as error:
        raise InputError(f"{path}: refused: {error}") from None
    return content


def _read_folder(root: Path) -> Content:
    content = Content()
    if not os.path.lexists(root / MANIFEST):
        return content  # not a bundle; perhaps a complete disk
    for count, (name, entry) in enumerate(_walk(root)):
        if count >= MAX_MEMBERS:
            raise InputError(f"{root}: refused: more than {MAX_MEMBERS} files")
        if entry.is_symlink():
            content.irregular[name] = "is a link"
        elif not entry.is_file(follow_symlinks=False):
            content.irregular[name] = "is no regular file"
        else:
            _take_file(content, name, Path(entry.path))
    return content


def _walk(root: Path) -> Iterator[tuple[str, os.DirEntry]]:
    """Everything except folders, which are searched; links are not followed."""
    folders = [(root, "")]
    while folders:
        folder, prefix = folders.pop()
        with os.scandir(folder) as entries:
            for entry in sorted(entries, key=lambda each: each.name):
                if entry.is_dir(follow_symlinks=False):
                    folders.append((Path(entry.path), prefix + entry.name + "/"))
                else:
                    yield prefix + entry.name, entry


def _take_file(content: Content, name: str, path: Path) -> None:
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        content.irregular[name] = f"cannot be read: {explain(error)}"
        return
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            content.irregular[name] = "is no regular file"
            return
        _take(content, name, status.st_size, iter(lambda: file.read(_CHUNK), b""))


def _take(content: Content, name: str, size: int, chunks: Iterable[bytes]) -> None:
    limit = _KEPT.get(name)
    if limit is not None and size > limit:
        raise InputError(f"{name}: refused: {size} bytes, more than {limit}")
    digest = hashlib.sha256()
    counted = 0
    kept: list[bytes] = []
    for chunk in chunks:
        digest.update(chunk)
        counted += len(chunk)
        if limit is not None:
            kept.append(chunk)
            if counted > limit:
                raise InputError(f"{name}: refused: more than {limit} bytes")
    if name == MANIFEST:
        content.manifest = b"".join(kept)
    elif name == SIGNATURE:
        content.signature = b"".join(kept)
    else:
        content.files[name] = Entry(counted, digest.hexdigest())
