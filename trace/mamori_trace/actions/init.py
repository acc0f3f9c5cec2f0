# SPDX-License-Identifier: Apache-2.0
"""`mamori trace init`.

@satisfies SWR-TRC-096      Design: docs/design/trace.md#new-items
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_root
from mamori_trace.base.errors import InputError
from mamori_trace.base.write import write_folder

HELP = "begin a project: the words and levels of its items, and a first chain from need to software requirement"
_START = Path(__file__).parents[1] / "start"
_PLACES = {"items.toml": "schema/items.toml", "system.md": "system.md", "software.md": "software.md"}
_NEXT = """next: write your own items over these, and look at their links: mamori trace review --all --by NAME
      name them in code (`@satisfies SWR-APP-001`) and tests (`@verifies SWR-APP-001`), and set Status to approved
      run the tests with JUnit results: mamori trace check --evidence FOLDER --allow-missing, which reads FOLDER/junit/*.xml;
      with {"commit": "..."} in FOLDER/environment.json, and without --allow-missing, missing and stale results are errors"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)


def run(arguments: argparse.Namespace) -> int:
    folder = arguments.root / "requirements"
    if not arguments.root.is_dir():
        raise InputError(f"{arguments.root}: is no folder; make it first, or name another with --root")
    if os.path.lexists(folder):
        raise InputError(f"{folder}: is there already; `new` adds an item, `import` takes those of another tool over")
    write_folder(folder, {place: (_START / name).read_text(encoding="utf-8") for name, place in _PLACES.items()})
    for place in _PLACES.values():
        print(folder / place)
    print(_NEXT)
    return EXIT_CLEAN
