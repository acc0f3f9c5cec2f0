# SPDX-License-Identifier: Apache-2.0
"""The arm for the campaign engine: `safe_arm run` once per fault and instant, evaluated by the physics in its run.json.

@satisfies SWR-CMP-003, SWR-CMP-004      Design: docs/design/simulation.md#campaign-verdict
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from mamori_tools.campaign.arm.fault import KINDS
from mamori_tools.campaign.arm.judge import describe_faults, judge
from mamori_tools.campaign.arm.plan import SUBJECT_NAME, ArmPlan, read_plan
from mamori_tools.campaign.arm.run_record import load_run
from mamori_tools.campaign.arm.selection import ArmCase, resolve
from mamori_tools.campaign.case import Case, Evaluation, Selection, conclude
from mamori_tools.campaign.subject import Expansion
from mamori_tools.host.project import Project
from mamori_tools.motion import canonical_text, load_limits, read_motion
from mamori_trace.base.errors import WorkError
from mamori_trace.base.marked_yaml import Node
from mamori_trace.base.text_file import read_text

MODEL = "model.yaml"
MOTION = "motion.txt"


class Arm:
    """See mamori_tools.campaign.subject.Subject."""

    name = SUBJECT_NAME
    kinds: Collection[str] = tuple(KINDS)
    jobs_max = None

    def get_program(self, project: Project) -> Path:
        return project.safe_arm

    def get_files(self, project: Project) -> Mapping[str, Path]:
        return {"model": project.model, "motion": project.motion}

    def read_plan(self, root: Node, path: Path) -> ArmPlan:
        return read_plan(root, path)

    def expand(self, selection: Selection, files: Mapping[str, Path]) -> Expansion:
        motion = read_motion(files["motion"], load_limits(files["model"]))
        model = read_text(files["model"], "model file").text
        inputs = {MODEL: model.encode("utf-8"), MOTION: canonical_text(motion).encode("utf-8")}
        return Expansion(resolve(selection, motion), inputs, motion.notes)

    def command(self, case: Case, program: Path, inputs: Path, folder: Path) -> tuple[str, ...]:
        assert isinstance(case, ArmCase)
        command = [str(program), "run", "--model", str(inputs / MODEL), "--motion", str(inputs / MOTION)]
        if case.fault is not None or case.latent:
            command += ["--fault", describe_faults(case)]
        command += ["--seed", str(case.seed)]
        if case.frames is not None:
            command += ["--frames", str(case.frames)]
        return (*command, "--out", str(folder))

    def evaluate(self, case: Case, folder: Path, problem: str) -> Evaluation:
        assert isinstance(case, ArmCase)
        run: dict[str, Any] = {}
        try:
            run = load_run(folder / "run.json")
        except WorkError as error:
            problem = problem or str(error)
        checks = tuple(judge(case, run, problem))
        return Evaluation(run, checks, conclude(checks))

    def describe(self, case: Case) -> dict[str, Any]:
        assert isinstance(case, ArmCase)
        expected = case.expected
        return {
            "polarity": "violation" if case.fault is not None or case.latent else "nominal",
            "expected": {"state": expected.state, "reaction": list(expected.reactions),
                         "detected_fault": list(expected.detected_faults), "within_s": expected.within_s},
        }  # fmt: skip


SUBJECT = Arm()
