# SPDX-License-Identifier: Apache-2.0
"""The results of a run, kept in a file as they arrive, so that the same command continues a stopped run.

A line has a result, and the fingerprint of its file. A mutant that was killed, does not compile or has the same code is not tried again
while its file is unchanged. Survivors are, because tests may have been added.

@satisfies SWR-VER-033      Design: docs/design/test_strength.md#example-arm
"""

from __future__ import annotations

import json
from pathlib import Path

from mamori_trace.base.errors import InputError
from verification.mutation.baseline import fingerprint
from verification.mutation.run import Plan
from verification.mutation.score import LISTED
from verification.mutation.trial import SURVIVED, Result


class Journal:
    """The file of a plan."""

    def __init__(self, path: Path, plan: Plan) -> None:
        self._path = path
        self._mutants = {(mutant.file, mutant.start, mutant.end, mutant.replacement): mutant for mutant in plan.mutants}
        self._prints = {file: fingerprint(source) for file, source in plan.sources.items()}

    def read(self) -> list[Result]:
        """The results that are still valid. @raise InputError for a file of another kind."""
        results = []
        try:
            for line in self._path.read_text(encoding="utf-8").splitlines() if self._path.exists() else ():
                row = json.loads(line)
                mutant = self._mutants.get((row["file"], row["start"], row["end"], row["replacement"]))
                if mutant is not None and row["fingerprint"] == self._prints[mutant.file] and row["verdict"] not in (SURVIVED, LISTED):
                    results.append(Result(mutant, row["verdict"], row["killer"]))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(f"mutate: --results: not written by this command ({error}); name another file", self._path) from error
        return list({result.mutant: result for result in results}.values())

    def add(self, result: Result) -> None:
        mutant = result.mutant
        row = {"file": mutant.file, "start": mutant.start, "end": mutant.end, "replacement": mutant.replacement,
               "fingerprint": self._prints[mutant.file], "verdict": result.verdict, "killer": result.killer}  # fmt: skip
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
