# SPDX-License-Identifier: Apache-2.0
"""The folders that a command writes to: the lock of each, and build trees that were created in another folder.

@satisfies SWR-CLI-040, SWR-CLI-042      Design: docs/design/launcher.md#lock
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import shutil
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from mamori_tools.host.process import end_children
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, MissingError
from mamori_trace.base.project_lock import LOCK, hold_lock

MADE_IN = re.compile(r"^CMAKE_CACHEFILE_DIR:INTERNAL=(.*)$", re.MULTILINE)


@contextlib.contextmanager
def hold_locks(arguments: argparse.Namespace, words: Sequence[str]) -> Iterator[None]:
    """Holds the locks of a writing command; readers take none. A stopped command ends its children before it releases the locks.

    @raise MissingError if another command holds a lock, or the folder is not writable.
    """
    command = " ".join(("./mamori", *words))
    with contextlib.ExitStack() as stack:
        for folder in list_written(arguments):
            try:
                stack.enter_context(hold_lock(folder, command))
            except MissingError as error:
                raise MissingError(str(error)) from None
            except OSError as error:
                raise MissingError(f"{folder / LOCK}: cannot be written ({error.strerror}); make {folder} writable, or use a copy of it") from None
            discard_moved_trees(folder)
        try:
            yield
        except (KeyboardInterrupt, OSError):  # also after the reader of the output has ended: no child process writes without the lock
            end_children()
            raise


def list_written(arguments: argparse.Namespace) -> list[Path]:
    """Folders of the projects that the command writes to: the checkout, and the project among its arguments."""
    match arguments.command:
        case "demo" | "run" | "test" | "fuzz" | "prove":
            return [ROOT]
        case "bench" | "hil" | "mutate":
            return [] if arguments.list else [ROOT]
        case "build" | "verify":
            return _with_project(arguments.project)
        case "timing" | "cost":
            return _with_project(_find_project(arguments.system))
        case _:
            return []  # readers; `trace` has its own locks, and the folder of `new` does not exist yet


def _with_project(folder: Path | None) -> list[Path]:
    if folder is None or not (folder / "CMakeLists.txt").is_file() or folder.resolve() == ROOT:
        return [ROOT]
    return [ROOT, folder.resolve()]


def _find_project(system: str) -> Path | None:
    """The user project that contains the folder `system`; None for any other folder or a program."""
    from mamori_tools.timing.system import find_project

    folder = Path(system)
    with contextlib.suppress(InputError):
        return find_project(folder.resolve(), Project(ROOT), "").root if folder.is_dir() else None
    return None


def discard_moved_trees(root: Path) -> None:
    """Permits CMake to configure a build tree again after its folder was moved or copied; otherwise CMake rejects the tree."""
    for cache in sorted(path for pattern in ("*", "*/*") for path in (root / "build").glob(f"{pattern}/CMakeCache.txt")):
        found = MADE_IN.search(cache.read_text(encoding="utf-8", errors="replace"))
        if found is None or os.path.realpath(found[1]) == os.path.realpath(cache.parent):
            continue
        print(f"mamori: {cache.parent} was configured in {found[1]}; it is configured again", file=sys.stderr)
        cache.unlink()
        shutil.rmtree(cache.parent / "CMakeFiles", ignore_errors=True)
