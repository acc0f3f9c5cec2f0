# SPDX-License-Identifier: Apache-2.0
"""Resolves SYSTEM: a folder with a `timing.toml`, in Mamori or in a user project, or an existing program.

@satisfies SWR-TIM-022, SWR-TIM-029      Design: docs/design/timing.md#system
"""

from __future__ import annotations

import os
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names
from mamori_trace.base.text_file import read_text

FILE = "timing.toml"
KEYS = ("program", "target", "arguments", "cost")
_USES_MAMORI = re.compile(r"^\s*find_package\s*\(\s*mamori\b", re.MULTILINE)


@dataclass(frozen=True)
class System:
    """A program that writes the files of docs/design/timing.md#files. `project` receives its build and its evidence. `target`: its CMake
    target; empty: nothing to build. `cost`: the unchecked table of `mamori cost` in the file; its `file` is empty if there is none."""

    name: str
    program: Path
    target: str = ""
    arguments: tuple[str, ...] = ()
    cost: dict[str, Any] = field(default_factory=dict)
    file: Path | None = None
    project: Project = Project(ROOT)


def find_system(text: str, project: Project, command: str = "timing") -> System:
    """@param command name of the command for the messages. @raise InputError if `text` names no system."""
    path = Path(text)
    if not path.exists() and (project.root / text).exists():
        path = project.root / text  # the command may be called from any folder
    if path.is_dir():
        return _read_folder(path.resolve(), project, command)
    if not path.is_file():
        raise InputError(f"{command}: there is no system '{text}'; {nearest_names(text, list_systems(project))}")
    if not os.access(path, os.X_OK):
        raise InputError(f"{command}: '{text}' is not an executable program; specify a folder with a {FILE} or an executable file")
    return System(path.resolve().name, path.resolve(), project=project)


def list_systems(project: Project) -> list[str]:
    """Folders of the project that can be measured, relative to its root."""
    return sorted(str(path.parent.relative_to(project.root)) for path in project.root.glob(f"examples/*/{FILE}"))


def find_project(folder: Path, shipped: Project, command: str) -> Project:
    """The project that contains `folder`: the shipped project, or the nearest parent folder that is built against its package.

    @raise InputError if there is none.
    """
    if folder.is_relative_to(shipped.root) and not folder.is_relative_to(shipped.root / "build"):
        return shipped
    for root in (folder, *folder.parents):
        lists = root / "CMakeLists.txt"
        if lists.is_file() and _USES_MAMORI.search(lists.read_text(encoding="utf-8", errors="replace")):
            return Project(root, shipped.preset)
    raise InputError(f"{command}: neither '{folder}' nor a folder above it has a CMakeLists.txt that calls find_package(mamori); add it")


def _read_folder(folder: Path, shipped: Project, command: str) -> System:
    file = folder / FILE
    if not file.is_file():
        raise InputError(f"{command}: '{folder}' has no {FILE}; {nearest_names(folder.name, list_systems(shipped))}")
    project = find_project(folder, shipped, command)
    try:
        data = tomllib.loads(read_text(file, "system description", 100_000).text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"invalid TOML: {error}; correct it", file) from error
    for key in data:
        if key not in KEYS:
            raise InputError(f"has an unknown key '{key}'; {nearest_names(key, KEYS)}", file)
    program, target = (_read_text(data, key, file) for key in ("program", "target"))
    words = read_words(data.get("arguments", []), "'arguments'", project, file)
    cost = data.get("cost", {})
    if not isinstance(cost, dict):
        raise InputError("'cost' must be a table", file)
    path = (project.build / program).resolve()
    if not path.is_relative_to(project.build.resolve()):
        raise InputError(f"'program' is '{program}', which is outside the build folder; specify a path below it", file)
    return System(folder.name, path, target, words, cost, file, project)


def read_words(value: object, what: str, project: Project, file: Path) -> tuple[str, ...]:
    """Arguments of a command line, with `{root}` replaced. @raise InputError for anything else."""
    if not isinstance(value, list) or not all(isinstance(word, str) and "\0" not in word for word in value):
        raise InputError(f"{what} must be a list of strings without NUL", file)
    return tuple(word.replace("{root}", str(project.root)) for word in value)


def _read_text(data: dict[str, object], key: str, file: Path) -> str:
    value = data.get(key)
    if not isinstance(value, str) or not value or "\0" in value:
        raise InputError(f"has no '{key}'; it must be a non-empty string without NUL", file)
    return value
