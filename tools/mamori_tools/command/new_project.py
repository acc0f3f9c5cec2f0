# SPDX-License-Identifier: Apache-2.0
"""`mamori new NAME`: creates a user project from the first example, so that API changes affect only one source.

The sources of examples/minimal are split at landmarks and recombined. Only parts that the example lacks (requirements, tests, CMake of a
separate project) are stored as text, in start/. The folder is created atomically.

@satisfies SWR-CLI-024, SWR-CLI-025      Design: docs/design/launcher.md#new-projects
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import re
import shutil
import signal
import tempfile
from pathlib import Path

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_OK
from mamori_tools.host.project import ROOT
from mamori_trace.actions import review
from mamori_trace.base.errors import InputError

START = Path(__file__).parent / "start"
EXAMPLE = ROOT / "examples" / "minimal"
NAME_LENGTH_MAX = 64
# Targets that CMake or this project already defines.
RESERVED = frozenset("all clean help install list_install_components package package_source edit_cache rebuild_cache test mamori".split())
LANDMARKS = ("using namespace mamori::literals;", "static Wheel wheel;", "static void print(", "int main() {\n")


def new(path: Path) -> int:
    """Creates the project. @return exit status. @raise InputError: then nothing is written."""
    target = check_target(path)
    files = make_files(target.name)
    try:
        write_project(target, files)
    except OSError as error:
        raise InputError(f"'{path}' cannot be created: {error.strerror}; name a place where you may write") from None
    except InputError as error:
        raise InputError(f"'{path}' cannot be created: {error}") from None
    print(f"created: {target}")
    print(f"next:    {ROOT / 'mamori'} verify {path}")
    return EXIT_OK


def check_target(path: Path) -> Path:
    """@return the absolute path of the new folder. @raise InputError if the folder is unsuitable."""
    name = path.name
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or len(name) > NAME_LENGTH_MAX:
        raise InputError(f"'{path}' ends in no valid name of a project; use a lower-case letter, then lower-case letters, digits "
                         f"and _ (at most {NAME_LENGTH_MAX})")  # fmt: skip
    if name in RESERVED:
        raise InputError(f"'{name}' is a name that CMake or Mamori uses itself; choose another one")
    if not path.parent.is_dir():
        raise InputError(f"'{path.parent}' is no folder; create it first, or name another place")
    target = path.parent.resolve() / name
    if target.is_relative_to(ROOT):
        raise InputError(f"'{path}' is inside Mamori's own source tree; name a place outside {ROOT}")
    if os.path.lexists(target):
        raise InputError(f"'{path}' exists already; choose another name, or remove it")
    return target


def make_files(name: str) -> dict[str, str]:
    """@return the content of each file by its path in the project, except requirements/trace.lock."""
    head, components, table, printer, main = cut(EXAMPLE / "main.cpp")
    used = re.search(r"target_link_libraries\(\S+ PRIVATE ([^)]+)\)", (EXAMPLE / "CMakeLists.txt").read_text(encoding="utf-8"))
    version = re.search(r"^project\(mamori VERSION (\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)
    if used is None or version is None:
        raise RuntimeError("examples/minimal/CMakeLists.txt or CMakeLists.txt has changed its form")
    words = {"name": name, "version": version[1], "libraries": used[1], "components": used[1].replace("mamori::", "")}  # fmt: skip
    kernel, ports = (re.findall(rf'#include "mamori/{layer}/.*\n', head) for layer in ("kernel", "ports"))
    return {
        "CMakeLists.txt": fill("CMakeLists.txt.in", words),
        "README.md": fill("README.md.in", words),
        ".gitignore": "build/\nreport/\n",
        "src/components.hpp": make_header("The two components.", name, "COMPONENTS", "".join(kernel), tag_monitor(components)),
        "src/system.hpp": make_header("The system table and the machine that runs it.", name, "SYSTEM",
                                      "".join(ports) + '\n#include "components.hpp"\n', table),
        "src/main.cpp": f'// SPDX-License-Identifier: Apache-2.0\n#include <cstdio>\n\n#include "system.hpp"\n\n{printer}{main}',
        "tests/system_test.cpp": fill("system_test.cpp.in", words),
        "requirements/system.md": (START / "system.md").read_text(encoding="utf-8"),
        "requirements/software.md": (START / "software.md").read_text(encoding="utf-8"),
        "requirements/schema/items.toml": (ROOT / "trace" / "mamori_trace" / "start" / "items.toml").read_text(encoding="utf-8"),
    }  # fmt: skip


def cut(source: Path) -> tuple[str, str, str, str, str]:
    """@return head, components, table, printing function and main function of the example."""
    text = source.read_text(encoding="utf-8")
    places = [0]
    for landmark in LANDMARKS:
        if text.count(landmark) != 1:
            raise RuntimeError(f"{source}: '{landmark.strip()}' must be there once")
        places.append(text.index(landmark))
    head, components, table, devices, main = (text[a:b] for a, b in zip(places, [*places[1:], len(text)], strict=True))
    return head, components, table, devices, main


def replace_once(text: str, old: str, new_text: str) -> str:
    if text.count(old) != 1:
        raise RuntimeError(f"examples/minimal/main.cpp: '{old.strip()}' must be there once")
    return text.replace(old, new_text)


def tag_monitor(components: str) -> str:
    """Adds the requirement to the component that satisfies it."""
    return replace_once(components, "class Monitor ", "/// @satisfies SWR-APP-001, SYS-001\nclass Monitor ")


def make_header(about: str, name: str, part: str, includes: str, body: str) -> str:
    guard = f"{name.upper()}_{part}_HPP"
    return (f"// SPDX-License-Identifier: Apache-2.0\n/// @file\n/// {about}\n#ifndef {guard}\n#define {guard}\n\n{includes}\n"
            f"{body.rstrip()}\n\n#endif  // {guard}\n")  # fmt: skip


def fill(template: str, words: dict[str, str]) -> str:
    return (START / template).read_text(encoding="utf-8").format(**words)


def write_project(target: Path, files: dict[str, str]) -> None:
    """Writes `files` and the record of their links to a temporary folder and renames it to `target`. @raise OSError"""
    part = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        for name, text in files.items():
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            (part / name).write_text(text, encoding="utf-8")
        with contextlib.redirect_stdout(io.StringIO()):
            review.run(argparse.Namespace(root=part, items=[], all=True, format=None, schema=None, by="mamori new"))
        mask = os.umask(0)
        os.umask(mask)
        part.chmod(0o777 & ~mask)
        if os.path.lexists(target):
            raise FileExistsError(0, "it exists already")
        part.rename(target)
    finally:
        handlers = [(number, signal.signal(number, signal.SIG_IGN)) for number in (signal.SIGINT, signal.SIGTERM)]
        shutil.rmtree(part, ignore_errors=True)
        for number, handler in handlers:
            signal.signal(number, handler)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("path", type=Path, metavar="NAME", help="name in the current folder, or a path; the folder must not exist. Its last part "
                        "begins with a letter and has only lower-case letters, digits and _")  # fmt: skip


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return new(arguments.path)


COMMAND = Command(
    add_arguments, run, "create a project of yours: two components, a table, requirements, tests",
    "Creates the folder NAME with a project of yours: two components, a system table, one chain of requirements from need to software, tests "
    "and CMake. ./mamori verify NAME builds it, runs its tests and writes its report.",
    {0: "created", 2: "invalid name, existing folder, or not writable; nothing is written"})  # fmt: skip
