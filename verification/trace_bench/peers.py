# SPDX-License-Identifier: Apache-2.0
"""Installs the reference implementations: OpenFastTrace by Maven, StrictDoc by pip into a separate environment, in one cache folder.

If one is unavailable, a sentence states cause and remedy; the measurement continues without it and shows the sentence.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

OPENFASTTRACE = "4.9.0"
STRICTDOC = "0.30.4"

_LIMIT_S = 600
_NAME = "org.itsallcode.openfasttrace:openfasttrace"
_MAIN = "org.itsallcode.openfasttrace.core.cli.CliStarter"


@dataclass(frozen=True, slots=True)
class Peer:
    """`command` is the beginning of its command line. If empty, it is not installed, and `reason` states why."""

    title: str
    command: tuple[str, ...] = ()
    reason: str = ""


def get_openfasttrace(cache: Path) -> Peer:
    title = f"OpenFastTrace {OPENFASTTRACE}"
    absent = [program for program in ("java", "mvn") if shutil.which(program) is None]
    if absent:
        return Peer(title, reason=f"{' and '.join(absent)} not found; install default-jre-headless and maven")
    repository = cache / "maven"
    jar = repository.joinpath(*_NAME.replace(":", ".").split(".")[:3], "openfasttrace", OPENFASTTRACE, f"openfasttrace-{OPENFASTTRACE}.jar")
    if not jar.is_file():
        # The jar contains all its parts. Its declared dependencies are the same parts, which the registry may lack.
        reason = _run(["mvn", "-q", "-B", "dependency:get", f"-Dartifact={_NAME}:{OPENFASTTRACE}", "-Dtransitive=false",
                       f"-Dmaven.repo.local={repository}"])  # fmt: skip
        if reason or not jar.is_file():
            return Peer(title, reason=f"Maven did not bring it: {reason or 'no jar came'}")
    return Peer(title, ("java", "-cp", str(jar), _MAIN))


def get_strictdoc(cache: Path) -> Peer:
    title = f"StrictDoc {STRICTDOC}"
    environment = cache / f"strictdoc_{STRICTDOC}"
    program = environment / "bin" / "strictdoc"
    done = environment / "whole"  # written last, so that a stopped installation is repeated
    if not done.is_file():
        shutil.rmtree(environment, ignore_errors=True)
        pip = [str(environment / "bin" / "python"), "-m", "pip", "--disable-pip-version-check", "-q", "install", f"strictdoc=={STRICTDOC}"]
        reason = _run([sys.executable, "-m", "venv", str(environment)]) or _run(pip)
        if reason:
            return Peer(title, reason=f"pip did not install it: {reason}")
        done.touch()
    return Peer(title, (str(program),))


def _run(command: list[str]) -> str:
    """@return an empty text, or the error in one line."""
    try:
        answer = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=_LIMIT_S, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error).partition("\n")[0]
    if answer.returncode == 0:
        return ""
    lines = (answer.stderr + answer.stdout).strip().splitlines()
    return next((line for line in lines if "ERROR" in line), lines[-1] if lines else f"status {answer.returncode}")
