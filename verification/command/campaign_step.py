# SPDX-License-Identifier: Apache-2.0
"""The campaign as a step, and the checks of its input that come before any long work.

Campaign and motion reader are imported where they are used: they pull in large libraries, and `build` needs neither.

@satisfies SWR-CLI-005      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mamori.verification.command.errors import StepError, UsageError
from mamori.verification.command.process import Tick
from mamori.verification.command.project import Project
from mamori.verification.command.steps import Context

if TYPE_CHECKING:
    from mamori.profiles.motion import Motion
    from mamori.verification.campaign import Selection


@dataclass(frozen=True)
class CampaignRequest:
    """What the user asked of a campaign. Nothing given: all that the plan says."""

    motion: Path
    scenarios: tuple[str, ...] = ()
    instants: int | None = None

    def check(self, project: Project) -> tuple[str, ...]:
        """@return what the motion has that is not used, in words. @raise UsageError for a motion that cannot be followed, or scenarios
        and instants that it or the plan lacks."""
        from mamori.profiles.input_error import InputError
        from mamori.verification.campaign import resolve

        try:
            motion = self._read_motion(project)
            resolve(self._select(project), motion)
            return motion.notes
        except InputError as error:
            raise UsageError(str(error)) from error

    def run(self, context: Context, tick: Tick, log: TextIO) -> None:
        """Runs the campaign as a step, with a line per case in `log`. @raise StepError when a case failed."""
        from mamori.profiles.input_error import InputError
        from mamori.verification.campaign import CaseResult, run_campaign

        def show(result: CaseResult, done: int, count: int) -> None:
            line = f"{result.case.id}: {'pass' if result.passed else f'FAIL: {result.failure}; {result.reproduction}'}"
            print(f"[{done}/{count}] {line}", file=log, flush=True)
            tick(f"{done} of {count} cases")

        project = context.project
        try:
            result = run_campaign(self._select(project), program=project.safe_arm, model=project.model,
                                  motion=self._read_motion(project), evidence=project.evidence, jobs=context.jobs,
                                  progress=show)  # fmt: skip
        except InputError as error:
            raise StepError(str(error)) from error
        if not result.passed:
            names = ", ".join(each.case.id for each in result.failed_cases)
            raise StepError(f"{len(result.failed_cases)} of {len(result.cases)} cases failed: {names}")

    def _select(self, project: Project) -> Selection:
        from mamori.verification.campaign import load_plan, select

        return select(load_plan(project.campaign_plan), self.scenarios, self.instants)

    def _read_motion(self, project: Project) -> Motion:
        from mamori.profiles.motion import load_limits, read_motion

        return read_motion(self.motion, load_limits(project.model))
