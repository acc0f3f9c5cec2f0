# SPDX-License-Identifier: Apache-2.0
"""Checks all Python files with ruff and mypy; their rules are in pyproject.toml.

    python -m mamori.verification.tools.check_python [--root FOLDER]

Exit status 0 without findings, 1 with, 2 for wrong arguments, 3 when a tool is missing. Caches and links are below build/.

Design: docs/design/launcher.md#python-checks
"""

from __future__ import annotations

import argparse
import importlib.util
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = (("ruff", "check"), ("mypy",))
PACKAGE = "build/python/mamori"
"""mypy finds the packages here by the names under which they are imported: their folders are at the top of the tree."""
MEMBERS = ("trace", "profiles", "verification", "examples", "conftest.py")


def link_packages(root: Path) -> None:
    """Makes `PACKAGE`, or completes it."""
    folder = root / PACKAGE
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "__init__.py").touch()  # without it, mypy takes a folder of data for the module of the same name beside it
    for name in MEMBERS:
        link, target = folder / name, Path("../../..") / name
        if not link.is_symlink() or link.readlink() != target:
            link.unlink(missing_ok=True)
            link.symlink_to(target)


def check(root: Path) -> int:
    """@return exit status."""
    missing = [tool for tool, *_ in COMMANDS if importlib.util.find_spec(tool) is None]
    if missing:
        print(f"Python checks: not installed: {', '.join(missing)}; run ./mamori test, which installs the test packages", file=sys.stderr)
        return 3
    link_packages(root)
    failed = []
    for command in COMMANDS:
        done = subprocess.run([sys.executable, "-P", "-m", *command], cwd=root, capture_output=True, text=True, check=False)
        print(f"$ {' '.join(command)}\n{done.stdout.replace(f'{PACKAGE}/', '')}{done.stderr}", end="", flush=True)
        failed += [command[0]] if done.returncode else []
    print(f"Python checks: {'failed: ' + ', '.join(failed) if failed else 'no findings'}")
    return 1 if failed else 0


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="check_python", description="Checks all Python files with ruff and mypy.")
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree (default: the one of this file)")
    return check(parser.parse_args(argv).root.resolve())


if __name__ == "__main__":
    sys.exit(main())
