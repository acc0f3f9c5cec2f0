# SPDX-License-Identifier: Apache-2.0
"""Proves the properties of a part with z3 and spin: of the machine, or of the brakes.

@satisfies SWR-FSM-023      Design: docs/design/safe_state.md#proofs
"""

from __future__ import annotations

import builtins
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import WorkError
from verification.safe_state import promela, smt
from verification.safe_state.properties import Property
from verification.safe_state.smt import Query

SCHEMA = "mamori.safe_state_proof/1"
PROVED, REFUTED = "proved", "refuted"


class Subject(ABC):
    """A part to prove. `name`: of its model files. `constants`: names in its SMT model that describe a counterexample."""

    name: str
    properties: Sequence[Property]
    constants: Sequence[str]

    @abstractmethod
    def write_smt(self) -> str:
        """The definitions for z3."""

    @abstractmethod
    def list_history_queries(self) -> list[str]:
        """Queries that must be unsatisfiable if the pasts of the model are closed under its steps."""

    @abstractmethod
    def list_queries(self, wanted: Property) -> list[str]:
        """Queries that must be unsatisfiable if the property holds."""

    @abstractmethod
    def describe_values(self, query: Query, values: Mapping[str, int]) -> list[str]:
        """The counterexample of z3 in words: a shortest path from power-up, and the step that violates the property."""

    @abstractmethod
    def write_promela(self, properties: Sequence[Property]) -> str:
        """The model for spin with the formulas of `properties`."""

    @abstractmethod
    def describe_run(self, run: promela.Run) -> list[str]:
        """The run of spin in words. @raise WorkError if the part does not step like the run."""


@dataclass(frozen=True)
class Result:
    """One property. `verdicts`: by prover. `steps`: the counterexample in words; empty if all provers have proved the property."""

    property: Property
    verdicts: Mapping[str, str]
    steps: tuple[str, ...]

    @builtins.property
    def is_proved(self) -> bool:
        return all(verdict == PROVED for verdict in self.verdicts.values())


def prove(subject: Subject, folder: Path) -> list[Result]:
    """Runs both provers and stores their models and working files in `folder`. @raise WorkError if a prover is missing or fails."""
    told: dict[str, dict[str, list[str]]] = {one.name: {} for one in subject.properties}
    _run_z3(subject, folder, told)
    _run_spin(subject, folder, told)
    results = []
    for one in subject.properties:
        verdicts = {prover: REFUTED if prover in told[one.name] else PROVED for prover in one.provers}
        # A run from power-up is more informative than a single step, whose start z3 may choose freely.
        words = told[one.name].get("spin") or told[one.name].get("z3") or []
        results.append(Result(one, verdicts, tuple(words)))
    return results


def _run_z3(subject: Subject, folder: Path, told: dict[str, dict[str, list[str]]]) -> None:
    queries = [Query("", text) for text in subject.list_history_queries()]
    queries += [Query(one.name, text) for one in subject.properties for text in subject.list_queries(one)]
    model = subject.write_smt()
    for query, is_impossible in zip(queries, smt.ask_all(model, queries, folder / f"{subject.name}.smt2"), strict=True):
        if is_impossible:
            continue
        if not query.owner:
            raise WorkError(f"z3 does not find the past of the {subject.name} closed under its steps; the model is not that of the {subject.name}")
        if "z3" not in told[query.owner]:
            values = smt.ask_values(model, query, subject.constants, folder / "counterexample.smt2")
            told[query.owner]["z3"] = subject.describe_values(query, values)


def _run_spin(subject: Subject, folder: Path, told: dict[str, dict[str, list[str]]]) -> None:
    text = subject.write_promela(subject.properties)
    runs = promela.check_all(text, subject.properties, folder, f"{subject.name}.pml")
    for one in subject.properties:
        word = one.name.replace("-", "_")
        if one.always and (run := runs[word]).moves is not None:
            told[one.name]["spin"] = subject.describe_run(run)
        missed = [condition for number, condition in enumerate(one.possible) if runs[f"{word}_{number}"].moves is None]
        if missed:
            told[one.name]["spin"] = [f"no run from power-up has: {condition}" for condition in missed]


def make_record(results: Sequence[Result], facts: Mapping[str, Any]) -> dict[str, Any]:
    """The output of `--json`, which is also the stored evidence."""
    rows = [
        {"name": result.property.name, "requirement": result.property.requirement, "sentence": result.property.sentence,
         "provers": dict(result.verdicts), "proved": result.is_proved, "steps": list(result.steps)}
        for result in results
    ]  # fmt: skip
    return {"schema": SCHEMA, **facts, "properties": rows}
