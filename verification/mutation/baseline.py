# SPDX-License-Identifier: Apache-2.0
"""The stored result of complete runs, per file: evidence for the mutation score between two complete runs.

@satisfies SWR-VER-006, SWR-VER-009      Design: docs/design/test_strength.md#stored-result
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError
from mamori_trace.base.text_file import write_text
from verification.mutation.operators import iterate_words
from verification.mutation.renamed import read_renamed, restore_names
from verification.mutation.score import Counts, add_up_layers
from verification.mutation.sources import LAYERS, Layer, get_layer

STORE = Path(__file__).resolve().with_name("baseline.toml")
HEAD = """\
# SPDX-License-Identifier: Apache-2.0
# Mutation score of kernel, safety and ports, file by file, as `./mamori mutate --store` found it. Written by that command only.
# `fingerprint` is that of the code in the mutated file, without comments and includes, with the former names of renamed.toml. The row of a
# file whose code has changed since is invalid until the next run of its mutants.

"""


@dataclass(frozen=True)
class Entry:
    """Result of one file."""

    fingerprint: str
    commit: str
    date: str
    counts: Counts


@dataclass(frozen=True)
class Mutated:
    """The current state of a file."""

    fingerprint: str
    mutants: int


@dataclass(frozen=True)
class Standing:
    """The stored result compared with the current layers: `measured` files, and files that are new or changed since their last complete run
    (`open_mutants`)."""

    measured: Mapping[str, Counts]
    open_mutants: Mapping[str, int]
    gone: tuple[str, ...]

    @property
    def layers(self) -> dict[Layer, Counts]:
        return add_up_layers(dict(self.measured))

    @property
    def findings(self) -> list[str]:
        """Findings; empty if the measured files of each layer together reach its limit."""
        found = [f"{file} is stored but gives no mutants any more; remove its row" for file in self.gone]
        return found + [
            f"the stored mutation score of {layer.name} is {counts.score:.1%} ({counts.killed} of {counts.valid}); {layer.bar:.0%} is the bar"
            for layer, counts in self.layers.items()
            if counts.score < layer.bar
        ]

    def describe(self) -> list[str]:
        """Readable lines: the sum of each layer, then each file that was not measured."""
        lines: list[str] = []
        for layer in LAYERS:
            counts = self.layers.get(layer, Counts())
            measured = sum(get_layer(file) == layer for file in self.measured)
            left = [mutants for file, mutants in self.open_mutants.items() if get_layer(file) == layer]
            if measured == 0 and not left:
                continue
            score = f"{counts.score:.1%}" if counts.valid else "-"
            lines += [f"{layer.name}, stored whole runs: {score} ({counts.killed} of {counts.valid} killed; {measured} files,"
                      f" {counts.tried} mutants)",
                      f"{layer.name}, not measured as a whole: {len(left)} files, {sum(left)} mutants"]  # fmt: skip
        return lines + [f"not measured: {file} ({count} mutants)" for file, count in self.open_mutants.items()]

    def to_json(self) -> dict[str, object]:
        """The same data for programs."""
        return {
            "measured": {file: asdict(counts) for file, counts in self.measured.items()},
            "layers": {layer.name: {**asdict(counts), "score": counts.score} for layer, counts in self.layers.items()},
            "not_measured": {"files": dict(self.open_mutants), "mutants": sum(self.open_mutants.values())},
        }


def fingerprint(source: bytes, former: Mapping[bytes, bytes] | None = None) -> str:
    """Hash of the tokens of the code in order, without comments, spaces and includes.

    @param former names of renamed identifiers; None: the names in renamed.toml."""
    words = restore_names(iterate_words(source), read_renamed() if former is None else former)
    return hashlib.sha256(b"\0".join(words)).hexdigest()[:16]


def read_store(path: Path = STORE) -> dict[str, Entry]:
    """@raise WorkError if the file is not a valid store."""
    try:
        rows = tomllib.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        return {
            file: Entry(row.pop("fingerprint"), row.pop("commit"), row.pop("date"), Counts(**row))
            for file, row in rows.items()
        }
    except (tomllib.TOMLDecodeError, AttributeError, KeyError, TypeError) as error:
        raise WorkError(f"{path} is no stored result ({error}); write it anew: ./mamori mutate --store") from error


def write_store(entries: Mapping[str, Entry], path: Path = STORE) -> None:
    """Writes the file atomically."""
    rows = [HEAD]
    for file, entry in sorted(entries.items()):
        counts = ", ".join(f"{name} = {value}" for name, value in asdict(entry.counts).items())
        rows.append(f'"{file}" = {{fingerprint = "{entry.fingerprint}", commit = "{entry.commit}", date = "{entry.date}", {counts}}}\n')
    write_text(path, "".join(rows))


def judge_store(entries: Mapping[str, Entry], mutated: Mapping[str, Mutated]) -> Standing:
    """A row counts if its fingerprint and its number of mutants agree with the current file.

    @param mutated files that have mutants."""
    measured = {
        file: entries[file].counts
        for file, now in mutated.items()
        if file in entries and (entries[file].fingerprint, entries[file].counts.tried) == (now.fingerprint, now.mutants)
    }
    left = {file: now.mutants for file, now in mutated.items() if file not in measured}
    return Standing(measured, left, tuple(file for file in entries if file not in mutated))
