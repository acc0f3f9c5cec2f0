# SPDX-License-Identifier: Apache-2.0
"""`./mamori prove safe-state`: builds the programs that print the relations, runs the provers, prints and stores models and results.

@satisfies SWR-FSM-025      Design: docs/design/safe_state.md#command-prove
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.host.arguments import Command, add_jobs
from mamori_tools.host.console import Screen
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.process import run_logged
from mamori_tools.host.project import ROOT, Project
from mamori_tools.timing.command import check_folder
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.nearest_names import nearest_names
from mamori_trace.base.text_file import write_text
from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.defects import BRAKE_DEFECTS
from verification.safe_state.brakes.relation import read_brakes
from verification.safe_state.brakes.sequence import make_cycles
from verification.safe_state.brakes.subject import BrakeSubject
from verification.safe_state.brakes.torque import read_torque
from verification.safe_state.defects import DEFECTS, Defect
from verification.safe_state.machine import Machine, merge
from verification.safe_state.machine_subject import MachineSubject
from verification.safe_state.prove import Result, Subject, make_record, prove
from verification.safe_state.relation import read_relation, run_program

TARGET = "mamori_safe_state_relation"
BRAKE_TARGET = "mamori_brake_sequence_relation"
CYCLE_TARGET = "mamori_safety_cycle_relation"
TOOLS = {"z3": "z3", "spin": "spin", "gcc": "gcc"}
"""Programs, and the Debian packages that contain them."""
AnyDefect = Defect[Machine] | Defect[Pair]


@dataclass(frozen=True)
class Request:
    """The request of the user. `defect`: the property whose seeded defect is tried."""

    json: bool = False
    out: Path | None = None
    defect: str | None = None
    jobs: int = 1


@dataclass(frozen=True)
class Proof:
    """What was proved of one part, additional facts for its record, and the files to store."""

    results: Sequence[Result]
    facts: Mapping[str, Any]
    files: Mapping[str, str]


def prove_safe_state(request: Request, project: Project = Project(ROOT)) -> int:
    """@return exit status; 1 if a property is not proved, or if no proof was possible (message on standard error). @raise InputError for an
    unknown defect, or a folder that is not writable."""
    defect = choose_defect(request.defect)
    try:
        check_tools()
        if request.out is not None:
            check_folder(request.out, "prove")
        _build(project, request.jobs)
        programs = project.build / "verification" / "safe_state"
        try:
            proofs = _prove(lambda name: run_program(programs / name), defect)
        except InputError as error:  # the project provides the programs: the error is not a wrong input of the user
            raise WorkError(str(error)) from error
        record = _keep(proofs, defect, request.out or _get_folder(project, defect))
    except WorkError as error:
        print(f"mamori: prove: {error}", file=sys.stderr)
        return EXIT_FAILED
    results = [result for proof in proofs for result in proof.results]
    if request.json:
        print(record)
    else:
        show(results, defect, Screen())
    return EXIT_OK if all(result.is_proved for result in results) else EXIT_FAILED


def choose_defect(name: str | None) -> AnyDefect | None:
    """@raise InputError if there is no property of that name."""
    if name is None:
        return None
    defects: tuple[AnyDefect, ...] = (*DEFECTS, *BRAKE_DEFECTS)
    known = {defect.breaks: defect for defect in defects}
    if name not in known:
        raise InputError(f"prove: there is no defect '{name}'; {nearest_names(name, known)}")
    return known[name]


def check_tools() -> None:
    """@raise WorkError with the missing programs, before the build."""
    missing = [name for name in TOOLS if shutil.which(name) is None]
    if missing:
        packages = " ".join(TOOLS[name] for name in missing)
        raise WorkError(f"{', '.join(missing)} not found in PATH; install the package(s) {packages} (as root: apt-get install {packages})")


def _build(project: Project, jobs: int) -> None:
    """@raise WorkError if a program cannot be built."""
    log = project.logs / "build-prove.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text("", encoding="utf-8")
    commands = (("cmake", "-S", str(project.root), "--preset", project.preset),
                ("cmake", "--build", str(project.build), "--target", TARGET, BRAKE_TARGET, CYCLE_TARGET, "--parallel", str(jobs)))  # fmt: skip
    for command in commands:
        if run_logged(command, log, project.root, lambda _: None) != 0:
            raise WorkError(f"{TARGET}, {BRAKE_TARGET} and {CYCLE_TARGET} could not be built; the compiler's words are in {log}")


def _get_folder(project: Project, defect: AnyDefect | None) -> Path:
    """The folder of the files. The behaviour of a defect is not evidence for the machine."""
    folder = project.evidence / "safe_state"
    return folder / "defects" / defect.breaks if defect else folder


def _prove(run_target: Callable[[str], str], defect: AnyDefect | None) -> list[Proof]:
    """For each seeded defect, the command checks the properties of the part that contains the defect."""
    text = run_target(TARGET)
    relation = read_relation(text, Path(TARGET))
    machine = merge(relation)
    own = next((one for one in DEFECTS if one is defect), None)
    of_brakes = next((one for one in BRAKE_DEFECTS if one is defect), None)
    proofs = []
    with tempfile.TemporaryDirectory(prefix="mamori-prove-") as scratch:
        if not of_brakes:
            facts = {"situations": len(relation.labels), "merged_situations": len(machine.labels), "steps": relation.steps,
                     "corrupted_objects": relation.corrupted_objects}  # fmt: skip
            subject = MachineSubject(own.seed(machine) if own else machine)
            proofs.append(_prove_part(subject, facts, {"relation.json": text}, Path(scratch)))
        if not own:
            texts = {"brakes.json": run_target(BRAKE_TARGET), "torque.json": run_target(CYCLE_TARGET)}
            relation_of_brakes = read_brakes(texts["brakes.json"], Path(BRAKE_TARGET))
            pair = Pair(machine, make_cycles(relation_of_brakes), read_torque(texts["torque.json"], machine.states, Path(CYCLE_TARGET)))
            facts = {"brake_situations": len(relation_of_brakes.fitted), "merged_brake_situations": len(pair.brakes.fitted),
                     "brake_calls": relation_of_brakes.calls, "cycle_situations": pair.torque.situations,
                     "cycles": pair.torque.cycles}  # fmt: skip
            proofs.append(_prove_part(BrakeSubject(of_brakes.seed(pair) if of_brakes else pair), facts, texts, Path(scratch)))
    return proofs


def _prove_part(subject: Subject, facts: Mapping[str, Any], files: Mapping[str, str], folder: Path) -> Proof:
    results = prove(subject, folder)
    models = (f"{subject.name}.smt2", f"{subject.name}.pml")
    return Proof(results, facts, {**files, **{name: (folder / name).read_text(encoding="utf-8") for name in models}})


def _keep(proofs: Sequence[Proof], defect: AnyDefect | None, folder: Path) -> str:
    """Writes all files to `folder` once all results are known. @return the record as JSON."""
    facts = {name: value for proof in proofs for name, value in proof.facts.items()}
    results = [result for proof in proofs for result in proof.results]
    record = json.dumps(make_record(results, {**facts, "defect": defect.breaks if defect else None}), indent=1)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be made: {error.strerror}; name another folder with --out", folder) from error
    for proof in proofs:
        for name, text in proof.files.items():
            write_text(folder / name, text)
    write_text(folder / "proof.json", record + "\n")
    return record


def show(results: Sequence[Result], defect: AnyDefect | None, screen: Screen) -> None:
    """A line per property, the steps of violated ones, and a closing line."""
    if defect is not None:
        screen.say(f"seeded defect: {defect.sentence}")
    rows: list[tuple[str, ...]] = [(result.property.name, result.property.requirement, result.verdicts.get("z3", "-"), result.verdicts.get("spin", "-"))
            for result in results]  # fmt: skip
    screen.print_table(("property", "requirement", "z3", "spin"), rows)
    for result in results:
        if not result.is_proved:
            screen.say()
            screen.say(f"{result.property.name} does not hold: {result.property.sentence}", style="bold red")
            for number, line in enumerate(result.steps, start=1):
                screen.say(f"  {number:2} {line}")
    proved = sum(result.is_proved for result in results)
    screen.say(f"{len(results)} properties: {proved} proved, {len(results) - proved} refuted")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("machine", choices=("safe-state",), metavar="safe-state", help="the safe-state machine and its brake sequence in the safety cycle")
    parser.add_argument("--json", action="store_true", help="print the result as JSON instead of a table")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the files; default: build/host-release/evidence/safe_state")
    parser.add_argument("--defect", metavar="NAME",
                        help="first seed the stored defect of the property NAME, of the machine or of the brakes, and check only that part: shows "
                             "that the provers find the defect")  # fmt: skip
    add_jobs(parser, "of the build")


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return prove_safe_state(Request(arguments.json, arguments.out, arguments.defect, arguments.jobs))


COMMAND = Command(
    add_arguments, run, "prove properties of the compiled safe-state machine and brake sequence with z3 and spin",
    "Calls the compiled step of the safe-state machine, the compiled functions of the brake sequence and the compiled safety cycle for every "
    "situation and every combination of inputs. Makes models for z3 and spin from the results and proves the properties with them. A violated "
    "property is shown as steps from power-up. Writes relation.json, machine.smt2, machine.pml, brakes.json, brakes.smt2, brakes.pml, "
    "torque.json and proof.json.",
    {0: "all properties are proved", 1: "a property is not proved, or a prover failed"})  # fmt: skip
