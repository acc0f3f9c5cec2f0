# SPDX-License-Identifier: Apache-2.0
"""The only function that writes files of host tools: atomically.

A symbolic link stays; the file at its target is replaced and keeps its mode. Devices and folders are rejected.

@satisfies SWR-CLI-043      Design: docs/design/launcher.md#files-that-are-written
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path


class TargetError(OSError):
    """The path cannot be a regular file. `str()` gives the reason and the remedy, without the path."""


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A temporary name in the folder of the target of `path`. If the block ends without an exception, that file replaces the target.

    Raises OSError. After any exception, including KeyboardInterrupt, the old file is unchanged and the temporary file is removed.
    """
    target = find_target(path)
    part = name_part(target)
    try:
        yield part
        with contextlib.suppress(FileNotFoundError):
            part.chmod(stat.S_IMODE(target.stat().st_mode))
        part.replace(target)
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def find_target(path: Path) -> Path:
    """The file to write, after following links. Raises TargetError and OSError."""
    if not path.name:
        raise TargetError(f"'{path}' names no file")
    target = Path(os.path.realpath(path))
    if target.is_symlink():
        raise TargetError("is a loop of links; mend the link")
    if target.exists() and not target.is_file():  # the rename would replace a device, such as /dev/stdout, by a file
        raise TargetError("is a folder or a device; name a file")
    if path.is_symlink() and not target.parent.is_dir():
        raise TargetError(f"leads to {target}, and there is no such folder; mend the link")
    return target


def name_part(target: Path) -> Path:
    """A temporary name in the folder of `target` for an incomplete file."""
    return target.with_name(f".{target.name}.{os.getpid()}.part")


def remove_parts(folder: Path) -> None:
    """Removes the temporary files of killed processes in `folder`. The caller must be the only process that writes there. Raises
    OSError."""
    for part in folder.glob(".*.part"):
        part.unlink()
