# SPDX-License-Identifier: Apache-2.0
"""The stored result of the whole run, per file: what the claim of the mutation score rests on between two whole runs.

@satisfies SWR-VER-006      Design: docs/design/test_strength.md#stored-result
"""

from __future__ import annotations

import hashlib
import os
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from mamori.verification.mutation.score import BAR, Counts, add_up
from mamori.verification.mutation.sources import MutationError

STORE = Path(__file__).resolve().with_name("baseline.toml")
HEAD = """\
# SPDX-License-Identifier: Apache-2.0
# Mutation score of the kernel, file by file, as `./mamori mutate --store` found it. Written by that command only.
# `fingerprint` is that of the mutated file: a file that has changed since is reported, and its row stands until the next run.
"""


@dataclass(frozen=True)
class Entry:
    """Result of one file."""

    fingerprint: str
    commit: str
    date: str
    counts: Counts


def fingerprint(source: bytes) -> str:
    return hashlib.sha256(source).hexdigest()[:16]


def read_store(path: Path = STORE) -> dict[str, Entry]:
    """@raise MutationError when the file is no such store."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        return {
            file: Entry(table["fingerprint"], table["commit"], table["date"], Counts(**table["counts"]))
            for file, table in tables.items()
        }
    except (tomllib.TOMLDecodeError, KeyError, TypeError) as error:
        raise MutationError(f"{path} is no stored result ({error}); write it anew: ./mamori mutate --store") from error


def write_store(entries: Mapping[str, Entry], path: Path = STORE) -> None:
    """Writes the whole file or nothing."""
    lines = [HEAD]
    for file in sorted(entries):
        entry = entries[file]
        counts = ", ".join(f"{name} = {value}" for name, value in asdict(entry.counts).items())
        lines.append(f'["{file}"]\nfingerprint = "{entry.fingerprint}"\ncommit = "{entry.commit}"\ndate = "{entry.date}"\n'
                     f"counts = {{{counts}}}\n")  # fmt: skip
    part = path.with_suffix(".part")
    part.write_text("\n".join(lines), encoding="utf-8")
    os.replace(part, path)


def check_store(entries: Mapping[str, Entry], mutated: Mapping[str, bytes]) -> list[str]:
    """@param mutated sources that have mutants. @return what is wrong; nothing when the store meets the bar."""
    findings = [f"{file} was never mutated; run ./mamori mutate --store {file}" for file in mutated if file not in entries]
    findings += [f"{file} is stored but gives no mutants any more; remove its table" for file in entries if file not in mutated]
    total = add_up({file: entry.counts for file, entry in entries.items()})
    if total.score < BAR:
        findings.append(f"the stored mutation score is {total.score:.1%} ({total.killed} of {total.valid}); {BAR:.0%} is the bar")
    return findings


def list_changed(entries: Mapping[str, Entry], mutated: Mapping[str, bytes]) -> list[str]:
    """Files that are not those whose result is stored."""
    return [file for file, source in mutated.items() if file in entries and entries[file].fingerprint != fingerprint(source)]
