# SPDX-License-Identifier: Apache-2.0
"""Stored maximum counts: written on request, and compared with a new count of the same compiler.

@satisfies SWR-TIM-037, SWR-TIM-038      Design: docs/design/cost.md#baseline
"""

from __future__ import annotations

import hashlib
import json
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from mamori_tools.cost.analysis import StepRow
from mamori_tools.cost.classes import InputClass
from mamori_tools.cost.run import Build
from mamori_tools.table.document import Table
from mamori_tools.timing.baseline import make_fingerprint
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text, write_text

SCHEMA = "mamori.cost_baseline/1"
KEYS = ("schema", "system", "table", "classes", "compiler", "flags", "c_library", "step")
HOW_TO_FIX = "write it anew with ./mamori cost SYSTEM --accept FILE"

Key = tuple[str, str, str]
"""Class, component, pass."""


@dataclass(frozen=True)
class Baseline:
    """`maxima` [instructions]. All other fields must be equal in a compared run."""

    path: Path
    system: str
    table: str
    classes: str
    build: Build
    maxima: dict[Key, int]


def make_class_fingerprint(classes: Sequence[InputClass]) -> str:
    """Hash of all declared properties of the input classes."""
    declared = [[one.name, one.cycles, one.first, one.every, list(one.arguments)] for one in classes]
    return hashlib.sha256(json.dumps(declared).encode()).hexdigest()


def load_baseline(path: Path, system: str, classes: Sequence[InputClass]) -> Baseline:
    """@raise InputError for an invalid baseline, or one with another format, system or set of input classes."""
    try:
        data = tomllib.loads(read_text(path, "baseline", 1_000_000).text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"is no TOML: {error}; {HOW_TO_FIX}", path) from error
    if data.get("schema") != SCHEMA:
        raise InputError(f"has the schema '{data.get('schema')}', this command reads '{SCHEMA}'; {HOW_TO_FIX}", path)
    try:
        if unknown := sorted(set(data) - set(KEYS)):
            raise ValueError(f"it has an unknown key '{unknown[0]}'")
        texts = {key: _read_text(data, key) for key in KEYS[1:-1]}
        maxima = {(_read_text(row, "class"), _read_text(row, "component"), _read_text(row, "pass")): _read_max(row) for row in data["step"]}
    except KeyError as error:
        raise InputError(f"invalid baseline: key {error} is missing; {HOW_TO_FIX}", path) from error
    except (TypeError, ValueError, AttributeError) as error:
        raise InputError(f"invalid baseline: {error}; {HOW_TO_FIX}", path) from error
    if texts["system"] != system:
        raise InputError(f"is the baseline of '{texts['system']}', not of '{system}'; name its own, or {HOW_TO_FIX}", path)
    if texts["classes"] != make_class_fingerprint(classes):
        raise InputError(f"was made with other classes of inputs; {HOW_TO_FIX}", path)
    return Baseline(path, system, texts["table"], texts["classes"], Build(texts["compiler"], texts["flags"], texts["c_library"]), maxima)


def _read_text(data: dict[str, Any], key: str) -> str:
    if not isinstance(data[key], str):
        raise ValueError(f"'{key}' is no text")
    return str(data[key])


def _read_max(row: dict[str, Any]) -> int:
    value = row["max"]
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise ValueError(f"max of '{row.get('component')}' is no count")
    return value


def check_origin(baseline: Baseline, table: Table, build: Build) -> None:
    """@raise InputError if the baseline belongs to another table or compiler, because counts are then not comparable."""
    for what, before, now in (("compiler", baseline.build.compiler, build.compiler), ("flags", baseline.build.flags, build.flags),
                              ("C library", baseline.build.c_library, build.c_library)):  # fmt: skip
        if before != now:
            raise InputError(f"was made with the {what} '{before}', this program with '{now}'; compare with those, or {HOW_TO_FIX}",
                             baseline.path)  # fmt: skip
    if baseline.table != make_fingerprint(table):
        raise InputError(f"was made of another table of '{baseline.system}'; {HOW_TO_FIX}", baseline.path)


def judge_growth(baseline: Baseline, rows: Sequence[StepRow], growth_percent: float) -> list[str]:
    """@return one finding per maximum that grew by more than the permitted growth, per new maximum, and per missing maximum."""
    now = {(row.input_class, row.component, row.pass_name): row for row in rows}
    findings = []
    for key, row in now.items():
        before, count = baseline.maxima.get(key), row.instructions
        where = f"component '{row.component}', {row.pass_name}, class '{row.input_class}'"
        if before is None:
            findings.append(f"{where}: is not in the baseline; {HOW_TO_FIX}")
        elif count.max > before * (1.0 + growth_percent / 100.0):
            findings.append(f"{where}: {count.max} instructions in cycle {count.cycle}, {count.max - before} more than the baseline's {before}, "
                            f"{growth_percent:g} % are allowed; make it cheaper, or say in the commit why and {HOW_TO_FIX}")  # fmt: skip
    gone = [key for key in baseline.maxima if key not in now]
    findings += [f"component '{name}', {step}, class '{one}': is in the baseline and did not run; {HOW_TO_FIX}" for one, name, step in gone]
    return findings


def write_baseline(path: Path, system: str, table: Table, classes: Sequence[InputClass], build: Build, rows: Sequence[StepRow]) -> None:
    """Writes the baseline atomically. @raise InputError if that fails."""
    steps = "".join(f"\n[[step]]\nclass = {_quote(row.input_class)}\ncomponent = {_quote(row.component)}\npass = {_quote(row.pass_name)}\n"
                    f"max = {row.instructions.max}\n" for row in rows)  # fmt: skip
    belongs = "".join(f"{key} = {_quote(value)}\n" for key, value in asdict(build).items())
    write_text(path, f"""# SPDX-License-Identifier: Apache-2.0
# Greatest instruction count of each pass of each component, exact, written by `./mamori cost SYSTEM --accept FILE`; --check
# fails when one grew. Counts of another compiler, its flags or another C library do not compare.
schema = "{SCHEMA}"
system = {_quote(system)}
table = "{make_fingerprint(table)}"
classes = "{make_class_fingerprint(classes)}"
{belongs}{steps}""")  # fmt: skip


def _quote(text: str) -> str:
    """A basic string of TOML, equal to that of JSON except for DEL."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
