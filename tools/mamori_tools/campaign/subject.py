# SPDX-License-Identifier: Apache-2.0
"""The interface between the campaign engine and its subjects, the systems that receive faults.

A subject is an object registered under the entry points `mamori.subjects` of pyproject.toml. The engine starts programs, limits their time,
stores results and writes evidence. The subject reads its plan, forms the command of a case and determines the verdict.

@satisfies SWR-CMP-008      Design: docs/design/simulation.md#campaign-plan
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, Protocol

from mamori_tools.campaign.case import Case, Evaluation, Plan, Selection
from mamori_tools.host.project import Project
from mamori_trace.base.marked_yaml import Node, load
from mamori_trace.base.nearest_names import nearest_names

GROUP = "mamori.subjects"
SCHEMA = "mamori.fault_plan/1"
DEFAULT_SUBJECT = "arm"
"""Subject of a plan without the key `subject`."""


@dataclass(frozen=True)
class Expansion:
    """The cases of one campaign, and the input files of each run: file name -> content. `notes` are shown to the user."""

    cases: tuple[Case, ...]
    inputs: Mapping[str, bytes] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


class Subject(Protocol):
    """One system under test. An object without state: calls may occur in any order.

    A call receives only plans, scenarios and cases of this subject.
    """

    @property
    def name(self) -> str:
        """Value of the key `subject` of a plan."""

    @property
    def kinds(self) -> Collection[str]:
        """Kinds of fault that a plan may name."""

    @property
    def jobs_max(self) -> int | None:
        """Maximum number of parallel cases; 1 if a case needs the host alone, None for any number."""

    def get_program(self, project: Project) -> Path:
        """Default of `--program`: the program under test in the build folder of the checkout."""

    def get_files(self, project: Project) -> Mapping[str, Path]:
        """Defaults of the options `--model` and `--motion`; its only keys are `model` and `motion`, if the subject uses them."""

    def read_plan(self, root: Node, path: Path) -> Plan:
        """Reads all keys of a plan, including the common keys `schema` and `subject`. Raises InputError with file and line."""

    def expand(self, selection: Selection, files: Mapping[str, Path]) -> Expansion:
        """Cases in the order of the plan. `files` has the keys of `get_files`. Raises InputError for an unusable file or plan."""

    def command(self, case: Case, program: Path, inputs: Path, folder: Path) -> tuple[str, ...]:
        """The command line of a case. The files of the expansion are in `inputs`; the program may write only to `folder`.

        Standard output and standard error of the program go to `folder/program.log`. Status 0 means that the record is complete.
        """

    def evaluate(self, case: Case, folder: Path, problem: str) -> Evaluation:
        """Determines the verdict from the files in `folder`. `problem` is empty, or states why the run does not count (time-out, exit
        status).

        A missing or malformed record gives a failed check, not an exception.
        """

    def describe(self, case: Case) -> dict[str, Any]:
        """The entries of a case in campaign.json besides id, scenario, title, requirements and result: at least `polarity` and
        `expected`."""


def list_subjects() -> list[str]:
    """Names of the registered subjects, sorted."""
    return sorted(point.name for point in entry_points(group=GROUP))


def load_subject(name: str) -> Subject:
    """@param name one of `list_subjects`."""
    [point] = entry_points(group=GROUP, name=name)
    subject: Subject = point.load()
    return subject


def load_plan(path: Path | str) -> Plan:
    """Reads a plan by the subject that it names. Raises InputError with one line, including file and line number, for the first error."""
    root = load(path, "fault plan")
    entries = root.as_mapping()
    schema = root.get("schema")
    if schema.as_text() != SCHEMA:
        raise schema.error(f"'{schema.as_text()}', this tool reads {SCHEMA}")
    name = entries["subject"].as_text() if "subject" in entries else DEFAULT_SUBJECT
    if name not in list_subjects():
        raise entries["subject"].error(f"unknown subject '{name}'; {nearest_names(name, list_subjects())}")
    return load_subject(name).read_plan(root, Path(path))
