# SPDX-License-Identifier: Apache-2.0
"""Writes an evidence bundle, folder or archive, atomically. Equal inputs give equal bytes.

@satisfies SWR-TRC-074      Design: docs/design/trace.md#bundle
"""

from __future__ import annotations

import hashlib
import os
import shutil
import tarfile
from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.files import walk_whole
from mamori_trace.base.signature import sign
from mamori_trace.base.system_error import explain
from mamori_trace.base.whole_file import name_part, whole_file
from mamori_trace.base.write import find_target
from mamori_trace.model.bundle import MANIFEST, SIGNATURE, Entry, Manifest, describe_path, format_manifest

FIXED_TIME_S = 315532800  # 1980-01-01: the earliest time in all archive formats
_CHUNK = 1 << 16


def check_out(out: Path, sources: list[Path]) -> None:
    """Raises InputError if `out` is an existing folder or is inside the bundled folders."""
    if out.is_dir() or (out.exists() and out.suffix != ".tar"):
        raise InputError(f"{out}: is there already; remove it, or name another")
    for source in sources:
        if out.resolve().is_relative_to(source.resolve()):
            raise InputError(f"{out}: lies in {source}, which is bundled; name a place outside")


def stage(sources: list[tuple[Path, str]], folder: Path, manifest: Manifest) -> None:
    """Copies each file to its path below `folder` and records the copied bytes in the manifest."""
    for source, name in sources:
        for path, inner in _list_files(source):
            target = f"{name}/{inner}" if inner else name
            fault = describe_path(target)
            if fault:
                raise InputError(f"{path}: cannot be bundled: its name {fault}")
            manifest.files[target] = _copy(path, folder / target)


def finish(folder: Path, manifest: Manifest, key: Path | None, out: Path) -> None:
    """Writes manifest and signature, and moves the staged folder or its archive to `out`."""
    data = format_manifest(manifest).encode()
    (folder / MANIFEST).write_bytes(data)
    if key is not None:
        (folder / SIGNATURE).write_bytes(sign(data, key))
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    try:
        target = find_target(out)
        (_place_archive if out.suffix == ".tar" else _place_folder)(folder, names, target)
    except OSError as error:
        raise InputError(f"{out}: cannot be written: {explain(error)}") from None


def _place_archive(folder: Path, names: list[str], out: Path) -> None:
    with whole_file(out) as part:
        _write_tar(folder, names, part)


def _place_folder(folder: Path, names: list[str], out: Path) -> None:
    part = name_part(out)
    try:
        for name in names:
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(folder / name, part / name)
            (part / name).chmod(0o644)
            os.utime(part / name, (FIXED_TIME_S, FIXED_TIME_S))
        part.rename(out)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _write_tar(folder: Path, names: list[str], out: Path) -> None:
    """USTAR: one header of fixed size for each file. The verifying reader supports only this format."""
    with tarfile.open(out, "w", format=tarfile.USTAR_FORMAT) as archive:
        for name in names:
            head = tarfile.TarInfo(name)
            head.size = (folder / name).stat().st_size
            head.mtime = FIXED_TIME_S
            head.mode = 0o644
            try:
                head.tobuf(tarfile.USTAR_FORMAT)
            except ValueError as error:
                raise InputError(f"{name}: does not fit into an archive ({error}); bundle into a folder") from None
            with (folder / name).open("rb") as file:
                archive.addfile(head, file)


def _list_files(source: Path) -> Iterator[tuple[Path, str]]:
    """Regular files below `source` in order. Links and special files are rejected, because bundles cannot contain them."""
    if source.is_file():
        yield source, ""
        return
    for base, folders, files in walk_whole(source):
        folders.sort()
        for name in sorted(files) + [each for each in folders if Path(base, each).is_symlink()]:
            path = Path(base, name)
            if path.is_symlink() or not path.is_file():
                raise InputError(f"{path}: is a link or no regular file; a bundle holds regular files only")
            yield path, path.relative_to(source).as_posix()


def _copy(source: Path, target: Path) -> Entry:
    target.parent.mkdir(parents=True, exist_ok=True)
    digest = hashlib.sha256()
    size = 0
    with source.open("rb") as reader, target.open("wb") as writer:
        for chunk in iter(lambda: reader.read(_CHUNK), b""):
            digest.update(chunk)
            size += len(chunk)
            writer.write(chunk)
    return Entry(size, digest.hexdigest())


def add_text(folder: Path, name: str, text: str, manifest: Manifest) -> None:
    """Adds a file that is generated for the bundle."""
    data = text.encode()
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    manifest.files[name] = Entry(len(data), hashlib.sha256(data).hexdigest())
