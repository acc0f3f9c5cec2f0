# SPDX-License-Identifier: Apache-2.0
"""Results of a campaign as Parquet: one complete part file per finished case.

    campaign/results/key.json               which campaign the parts belong to
    campaign/results/<case id>.parquet      a finished case
    campaign/campaign.parquet               all cases, after the last one

A case has one file name, so it cannot be stored twice. The key file is removed first and written first: parts without it are discarded.

@satisfies SWR-CMP-009      Design: docs/design/simulation.md#campaign-results
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from mamori_tools.campaign.case import Case, Check, Evaluation
from mamori_tools.campaign.result import CaseResult
from mamori_trace.base.errors import InputError, MissingError
from mamori_trace.base.whole_file import remove_parts, whole_file

if TYPE_CHECKING:
    import pyarrow

SCHEMA = "mamori.case_result/1"
KEY_SCHEMA = "mamori.campaign_key/1"

WALL_TIME = "wall_s"
"""Entry of a run record that the result hash excludes."""

SELECTION = "selection"
"""Part of the key: the selected cases."""

Key = Mapping[str, str]
"""The inputs that determine the results of a campaign: part -> value or SHA-256."""


class Store:
    """The stored results of one campaign folder. Locks the folder until `close`. Thread safety: none."""

    def __init__(self, folder: Path) -> None:
        """Raises InputError if the folder is not writable, MissingError if another campaign writes to it."""
        self._folder = folder
        self._results = folder / "results"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        except OSError as error:
            raise _refuse_folder(folder, error) from error
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(self._lock)
            raise MissingError(f"{folder}: another campaign writes there; wait for its end or choose another folder by --out") from None

    def close(self) -> None:
        os.close(self._lock)

    def begin(self, key: Key, restart: bool) -> None:
        """Prepares the folder for the campaign `key`: keeps its finished cases, or discards all if `restart`.

        Raises InputError if the folder contains results of another campaign.
        """
        path = self._results / "key.json"
        found = None if restart else _read_key(path)
        if found is not None and found != key:
            parts = ", ".join(sorted(name for name in {*found, *key} if found.get(name) != key.get(name)))
            raise InputError(f"has results of a campaign with another value of: {parts}; add --restart to discard them, "
                             "or choose another folder by --out", self._results)  # fmt: skip
        try:
            if found is None:
                path.unlink(missing_ok=True)
                if self._results.exists():
                    shutil.rmtree(self._results)
                self._results.mkdir()
                write_durably(path, (json.dumps({"schema": KEY_SCHEMA, **key}, indent=1) + "\n").encode("utf-8"))
            remove_parts(self._results)
        except OSError as error:
            raise _refuse_folder(self._results, error) from error

    def read_results(self) -> dict[str, tuple[Evaluation, float]]:
        """Finished cases: id -> evaluation and wall time [s]. Raises InputError if a part is damaged."""
        return {path.stem: _read_part(path) for path in sorted(self._results.glob("*.parquet"))}

    def find_result(self, key: Key, case: str) -> Evaluation | None:
        """The stored result of a case of the campaign `key`, with any selection of cases; None if there is none."""
        path = self._results / f"{case}.parquet"
        found = _read_key(self._results / "key.json")
        is_same = found is not None and {**found, SELECTION: ""} == {**key, SELECTION: ""}
        return _read_part(path)[0] if is_same and path.exists() else None

    def add(self, result: CaseResult) -> None:
        """Stores a finished case, which is then retained if this process ends."""
        path = self._results / f"{result.case.id}.parquet"
        assert not path.exists(), f"{result.case.id} is stored twice"
        try:
            write_durably(path, _encode(_to_table([result])))
        except OSError as error:
            raise _refuse_folder(path, error) from error

    def merge(self, results: Sequence[CaseResult]) -> None:
        """Writes campaign.parquet with all cases."""
        path = self._folder / "campaign.parquet"
        try:
            write_durably(path, _encode(_to_table(results)))
        except OSError as error:
            raise _refuse_folder(path, error) from error


def calc_result_hash(results: Sequence[tuple[Case, Evaluation]]) -> str:
    """SHA-256 of all data that do not depend on host and time of the runs: case ids, verdicts, checks and run records, in the given
    order."""
    content = [
        [case.id, evaluation.verdict, [asdict(check) for check in evaluation.checks],
         {name: value for name, value in evaluation.run.items() if name != WALL_TIME}]
        for case, evaluation in results
    ]  # fmt: skip
    return hashlib.sha256(json.dumps(content, sort_keys=True, allow_nan=False).encode("utf-8")).hexdigest()


def _refuse_folder(path: Path, error: OSError) -> InputError:
    return InputError(f"evidence cannot be written: {error.strerror}; check the folder", path)


def _read_key(path: Path) -> dict[str, str] | None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise InputError("cannot be read; add --restart to discard the results", path) from error
    if not isinstance(content, dict) or content.pop("schema", None) != KEY_SCHEMA:
        raise InputError(f"is no {KEY_SCHEMA}; add --restart to discard the results", path)
    return content


def _to_table(results: Sequence[CaseResult]) -> pyarrow.Table:
    import pyarrow

    check = pyarrow.struct([("name", pyarrow.string()), ("wanted", pyarrow.string()), ("measured", pyarrow.string()), ("passed", pyarrow.bool_())])
    schema = pyarrow.schema([
        ("id", pyarrow.string()), ("scenario", pyarrow.string()), ("title", pyarrow.string()), ("verdict", pyarrow.string()),
        ("checks", pyarrow.list_(check)), ("run", pyarrow.string()), ("wall_s", pyarrow.float64()),
    ], metadata={"schema": SCHEMA})  # fmt: skip
    rows = [{"id": each.case.id, "scenario": each.case.scenario, "title": each.case.title, "verdict": each.verdict,
             "checks": [asdict(check) for check in each.checks], "run": json.dumps(each.run, allow_nan=False), "wall_s": each.wall_s}
            for each in results]  # fmt: skip
    return pyarrow.Table.from_pylist(rows, schema)


def _encode(table: pyarrow.Table) -> memoryview:
    import pyarrow
    import pyarrow.parquet

    buffer = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(table, buffer, write_page_checksum=True)
    return memoryview(buffer.getvalue())


def _read_part(path: Path) -> tuple[Evaluation, float]:
    import pyarrow
    import pyarrow.parquet

    try:
        with pyarrow.parquet.ParquetFile(path, page_checksum_verification=True) as file:
            [row] = file.read().to_pylist()
        evaluation = Evaluation(json.loads(row["run"]), tuple(Check(**check) for check in row["checks"]), row["verdict"])
    except (OSError, ValueError, TypeError, KeyError, pyarrow.ArrowException) as error:
        raise InputError("is no complete result of a case; remove the file to run the case again, or add --restart", path) from error
    return evaluation, row["wall_s"]


def write_durably(path: Path, content: bytes | memoryview) -> None:
    """Raises OSError. On return, file and name are on the disk."""
    with whole_file(path) as part, part.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)

