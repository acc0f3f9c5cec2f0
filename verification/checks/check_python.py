# SPDX-License-Identifier: Apache-2.0
"""Checks all Python files with ruff and mypy; their rules are in pyproject.toml.

    python -m verification.checks.check_python [--root FOLDER]

Exit status 0 without findings, 1 with findings, 2 for wrong arguments, 3 if a tool is missing. Caches are below build/.

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


def check(root: Path) -> int:
    """@return exit status."""
    missing = [tool for tool, *_ in COMMANDS if importlib.util.find_spec(tool) is None]
    if missing:
        print(f"Python checks: not installed: {', '.join(missing)}; run ./mamori test, which installs the test packages", file=sys.stderr)
        return 3
    failed = []
    for command in COMMANDS:
        done = subprocess.run([sys.executable, "-P", "-m", *command], cwd=root, capture_output=True, text=True, check=False)
        print(f"$ {' '.join(command)}\n{done.stdout}{done.stderr}", end="", flush=True)
        failed += [command[0]] if done.returncode else []
    print(f"Python checks: {'failed: ' + ', '.join(failed) if failed else 'no findings'}")
    return 1 if failed else 0


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="check_python", description="Checks all Python files with ruff and mypy.")
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree (default: the one of this file)")
    return check(parser.parse_args(argv).root.resolve())


if __name__ == "__main__":
    sys.exit(main())
