# SPDX-License-Identifier: Apache-2.0
"""Signs and verifies with `ssh-keygen -Y`: engineers already have such keys, and the project needs no own cryptography.

@satisfies SWR-TRC-077      Design: docs/design/trace.md#signature
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError

NAMESPACE = "mamori-evidence"
_TIMEOUT_S = 120
_SIGNER_WORDS_MIN = 3


@dataclass(frozen=True, slots=True)
class Opinion:
    """Result of verifying a signature. `signer` is empty if unknown; `fault` states what is wrong."""

    signer: str = ""
    fault: str = ""


def demand_key(key: Path) -> None:
    """Raises InputError if signing with `key` is impossible; called before any work."""
    _demand_tool()
    if not key.is_file():
        raise InputError(f"{key}: no such key; make one with `ssh-keygen -t ed25519 -f FILE`")


def sign(data: bytes, key: Path) -> bytes:
    """Signature of `data` in the format of SSH. Raises InputError."""
    answer = _ask(["-Y", "sign", "-q", "-f", str(key), "-n", NAMESPACE], data)
    if answer.returncode != 0:
        raise InputError(f"{key}: ssh-keygen could not sign: {_get_words(answer)}")
    return answer.stdout


def check_signature(data: bytes, signature: bytes, signers: Path | None) -> Opinion:
    """Checks that `signature` belongs to `data` and, with the file `signers`, to which signer. Raises InputError."""
    _demand_tool()
    if signers is not None:
        _check_signers(signers)
    with tempfile.TemporaryDirectory(prefix="mamori-verify-") as folder:
        path = Path(folder, "signature")
        path.write_bytes(signature)
        options = ["-n", NAMESPACE, "-s", str(path)]
        if signers is None:
            answer = _ask(["-Y", "check-novalidate", *options], data)
            if answer.returncode == 0:
                return Opinion()
            return Opinion(fault=f"the signature does not belong to the manifest: {_get_words(answer)}")
        names = _ask(["-Y", "find-principals", "-s", str(path), "-f", str(signers)], b"")
        for name in names.stdout.decode(errors="replace").splitlines():
            answer = _ask(["-Y", "verify", *options, "-f", str(signers), "-I", name], data)
            if answer.returncode == 0:
                return Opinion(signer=name)
            return Opinion(fault=f"the signature of {name} is not valid: {_get_words(answer)}")
    return Opinion(fault=f"nobody of {signers} made the signature")


def _check_signers(signers: Path) -> None:
    """Raises InputError for an unreadable file, because ssh-keygen treats it as a file without signers."""
    form = "write lines of the form `NAME ssh-ed25519 KEY`"
    if not signers.is_file():
        raise InputError(f"{signers}: no such file of allowed signers")
    try:
        lines = signers.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        raise InputError(f"{signers}: is no text in UTF-8; {form}") from None
    for number, line in enumerate(lines, 1):
        if line.strip() and not line.startswith("#") and len(line.split()) < _SIGNER_WORDS_MIN:
            raise InputError(f"{signers}:{number}: names no signer with a key; {form}")


def _demand_tool() -> None:
    if shutil.which("ssh-keygen") is None:
        raise InputError("ssh-keygen is missing; install the package openssh-client")


def _ask(arguments: list[str], data: bytes) -> subprocess.CompletedProcess[bytes]:
    _demand_tool()
    try:
        return subprocess.run(["ssh-keygen", *arguments], input=data, capture_output=True, timeout=_TIMEOUT_S, check=False)
    except subprocess.TimeoutExpired:
        raise InputError(f"ssh-keygen gave no answer in {_TIMEOUT_S} s; is the key waiting for its passphrase?") from None


def _get_words(answer: subprocess.CompletedProcess[bytes]) -> str:
    return " ".join((answer.stderr or answer.stdout).decode(errors="replace").split()) or f"status {answer.returncode}"
