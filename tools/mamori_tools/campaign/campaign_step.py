# SPDX-License-Identifier: Apache-2.0
"""The campaign as a step, and the checks of its input before any long work.

Campaign and motion reader are imported on use, because they load large libraries, which `build` does not need.

@satisfies SWR-CLI-005      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mamori_tools.host.process import Tick
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context
from mamori_trace.base.errors import WorkError

if TYPE_CHECKING:
    from mamori_tools.campaign import Selection


@dataclass(frozen=True)
class CampaignRequest:
    """The request of the user. Without values: the complete plan."""

    motion: Path
    scenarios: tuple[str, ...] = ()
    instants: int | None = None

    def check(self, project: Project) -> tuple[str, ...]:
        """@return the unused parts of the motion, in words. @raise InputError for a motion that cannot be followed, or for scenarios and
        instants that the motion or the plan lacks."""
        from mamori_tools.campaign import load_subject

        selection = self._select(project)
        return load_subject(selection.plan.subject).expand(selection, self._list_files(project)).notes

    def run(self, context: Context, tick: Tick, log: TextIO) -> None:
        """Runs the campaign as a step, with one line per case in `log`. @raise WorkError if a case failed."""
        from mamori_tools.campaign import CaseResult, Settings, run_campaign
        from mamori_trace.base.errors import InputError

        def show(result: CaseResult, done: int, count: int) -> None:
            line = f"{result.case.id}: {'pass' if result.passed else f'FAIL: {result.failure}; {result.reproduction}'}"
            print(f"[{done}/{count}] {line}", file=log, flush=True)
            tick(f"{done} of {count} cases")

        project = context.project
        try:
            settings = Settings(project.safe_arm, self._list_files(project), project.evidence, context.jobs, restart=True)
            result = run_campaign(self._select(project), settings, show)
        except InputError as error:
            raise WorkError(str(error)) from error
        if not result.passed:
            names = ", ".join(each.case.id for each in result.failed_cases)
            raise WorkError(f"{len(result.failed_cases)} of {len(result.cases)} cases failed: {names}")

    def _select(self, project: Project) -> Selection:
        from mamori_tools.campaign import load_plan, select

        return select(load_plan(project.campaign_plan), self.scenarios, self.instants)

    def _list_files(self, project: Project) -> dict[str, Path]:
        return {"model": project.model, "motion": self.motion}
