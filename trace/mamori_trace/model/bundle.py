# SPDX-License-Identifier: Apache-2.0
"""The manifest of an evidence bundle, and the comparison of a bundle with it.

@satisfies SWR-TRC-074, SWR-TRC-075      Design: docs/design/trace.md#bundle
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from typing import Any

from mamori_trace.base.errors import FormatError

SCHEMA = "mamori.bundle/1"
MANIFEST = "manifest.json"
SIGNATURE = "manifest.json.sig"
_SHA256 = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, slots=True)
class Entry:
    """One file: size in bytes and SHA-256 in hexadecimal digits."""

    size: int
    sha256: str


@dataclass(slots=True)
class Manifest:
    """Content and origin of a bundle. `faults` are entries that a bundle must not have."""

    commit: str = ""
    worktree: str = "unknown"
    version: str = ""
    evidence_commit: str = ""
    files: dict[str, Entry] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Content:
    """The found files. `irregular` names entries that are not regular files; `manifest` and `signature` are bytes, or None."""

    files: dict[str, Entry] = field(default_factory=dict)
    irregular: dict[str, str] = field(default_factory=dict)
    manifest: bytes | None = None
    signature: bytes | None = None


def format_manifest(manifest: Manifest) -> str:
    """Sorted, so that equal files give equal bytes."""
    content = {
        "schema": SCHEMA,
        "tool": "mamori",
        "version": manifest.version,
        "commit": manifest.commit,
        "worktree": manifest.worktree,
        "evidence_commit": manifest.evidence_commit,
        "files": [{"path": path, "size": entry.size, "sha256": entry.sha256} for path, entry in sorted(manifest.files.items())],
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def parse_manifest(data: bytes) -> Manifest:
    """Raises FormatError if `text` is not a manifest; single invalid entries are added to the faults."""
    try:
        table = json.loads(data.decode("utf-8"), object_pairs_hook=_refuse_repeated)
    except (ValueError, RecursionError) as error:
        raise FormatError(f"is no JSON text: {error}") from None
    if not isinstance(table, dict) or table.get("schema") != SCHEMA or not isinstance(table.get("files"), list):
        raise FormatError(f"is no manifest of schema {SCHEMA}")
    commit, worktree, version, evidence_commit = (str(table.get(name, "")) for name in ("commit", "worktree", "version", "evidence_commit"))
    manifest = Manifest(commit, worktree, version, evidence_commit)
    for index, row in enumerate(table["files"]):
        _take_row(manifest, index, row)
    return manifest


def _refuse_repeated(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) != len(pairs):
        raise ValueError("a key is given twice")
    return table


def _take_row(manifest: Manifest, index: int, row: object) -> None:
    if not isinstance(row, dict) or not isinstance(row.get("path"), str):
        manifest.faults.append(f"entry {index} of the manifest names no path")
        return
    path, size, digest = row["path"], row.get("size"), row.get("sha256")
    fault = describe_path(path)
    if fault:
        manifest.faults.append(f"{path!r} {fault}")
    elif path in manifest.files:
        manifest.faults.append(f"{path!r} is listed twice")
    elif type(size) is not int or size < 0 or not isinstance(digest, str) or not _SHA256.fullmatch(digest):
        manifest.faults.append(f"{path!r} has no proper size and SHA-256")
    else:
        manifest.files[path] = Entry(size, digest)


def describe_path(path: str) -> str:
    """The reason why a path is not allowed in a bundle, or an empty text."""
    if path.startswith("/") or "\\" in path or re.match(r"[A-Za-z]:", path):
        return "is no relative path"
    parts = path.split("/")
    if ".." in parts:
        return "leaves the bundle"
    if "" in parts or "." in parts or any(ord(letter) < 32 for letter in path):
        return "is no plain path"
    if path in (MANIFEST, SIGNATURE):
        return "cannot list itself"
    return ""


def compare(manifest: Manifest, content: Content) -> list[str]:
    """Every difference, sorted by path."""
    rows = [(path, f"{path} {why}") for path, why in content.irregular.items()]
    for path in manifest.files.keys() | content.files.keys():
        listed, found = manifest.files.get(path), content.files.get(path)
        if found is None and path not in content.irregular:
            rows.append((path, f"{path} is missing"))
        elif listed is None:
            rows.append((path, f"{path} is additional: the manifest does not list it"))
        elif found is not None and listed.size != found.size:
            rows.append((path, f"{path} is altered: {found.size} bytes instead of {listed.size}"))
        elif found is not None and listed.sha256 != found.sha256:
            rows.append((path, f"{path} is altered: its SHA-256 is not the listed one"))
    return manifest.faults + [text for _, text in sorted(rows)]
