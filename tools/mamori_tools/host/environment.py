# SPDX-License-Identifier: Apache-2.0
"""Writes evidence/environment.json: the origin of the evidence (docs/design/trace.md#evidence-files).

@satisfies SWR-CLI-009      Design: docs/design/launcher.md#environment-record
"""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TextIO

from mamori_tools.host.full_run import read_full_run
from mamori_tools.host.process import Tick
from mamori_tools.host.project import Project
from mamori_tools.host.records import collect_inputs
from mamori_tools.host.steps import Context
from mamori_trace.base.git_run import run_git
from mamori_trace.base.text_file import write_text

COMPILERS = ("g++", "clang++-19", "arm-none-eabi-g++")


def write_environment(project: Project, command: Sequence[str]) -> Path:
    """Writes the record for a run of `command` atomically. @return its path."""
    record = collect_environment(project, command)
    project.evidence.mkdir(parents=True, exist_ok=True)
    path = project.evidence / "environment.json"
    write_text(path, json.dumps(record, indent=1) + "\n")
    return path


def renew_environment(context: Context, _tick: Tick, _log: TextIO) -> None:
    """Writes the record of the running command again after a step that changed inputs of results."""
    write_environment(context.project, ["./mamori", *sys.argv[1:]])


def collect_environment(project: Project, command: Sequence[str]) -> dict[str, Any]:
    """The record as a dictionary. Values that the host does not provide are "unknown" or omitted."""
    names = os.environ.get("MAMORI_PACKAGES", "").split()
    compilers = {name: line for name in COMPILERS if (line := _ask([name, "--version"]).partition("\n")[0])}
    return {
        "schema": "mamori.environment/1",
        "commit": _ask_git(project.root, "rev-parse", "HEAD") or "unknown",
        "dirty": bool(_ask_git(project.root, "status", "--porcelain")),
        "date_utc": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "command": " ".join(command),
        "os": _get_os(),
        "cpu": _get_cpu(),
        "cores": os.cpu_count() or 1,
        "compilers": compilers,
        "packages": _get_packages(names),
        "python": platform.python_version(),
        "full_run": read_full_run(project.root),
        "inputs": collect_inputs(project, compilers, platform.python_version()),
    }


def _ask_git(root: Path, *words: str) -> str:
    """git for the project, with a configuration that starts no program."""
    return (run_git(root, words) or b"").decode(errors="replace").strip()


def _ask(argv: list[str], cwd: Path | None = None) -> str:
    """Output of a program; empty if it is missing or fails."""
    try:
        done = subprocess.run(argv, cwd=cwd, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def _get_os() -> str:
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        return platform.platform()


def _get_cpu() -> str:
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()


def _get_packages(names: list[str]) -> dict[str, str]:
    if not names:
        return {}
    lines = _ask(["dpkg-query", "-W", "-f", "${Package} ${Version}\n", *names]).splitlines()
    return dict(line.split(" ", 1) for line in lines)
