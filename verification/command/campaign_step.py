# SPDX-License-Identifier: Apache-2.0
"""The campaign as a step, and the checks of its input that come before any long work.

Campaign and motion reader are imported where they are used: they pull in large libraries, and `build` needs neither.

@satisfies SWR-CLI-005      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mamori.verification.command.errors import StepError, UsageError
from mamori.verification.command.process import Tick
from mamori.verification.command.project import Project
from mamori.verification.command.steps import Context


@dataclass(frozen=True)
class CampaignRequest:
    """What the user asked of a campaign. Nothing given: all that the plan says."""

    motion: Path
    scenarios: tuple[str, ...] = ()
    instants: int | None = None

    def check(self, project: Project) -> None:
        """@raise UsageError for a motion that cannot be followed or a scenario that the plan does not have."""
        from mamori.profiles.input_error import InputError
        from mamori.profiles.motion import load_limits, read_motion
        from mamori.verification.campaign import load_plan

        try:
            read_motion(self.motion, load_limits(project.model))
            load_plan(project.campaign_plan).select(self.scenarios)
        except InputError as error:
            raise UsageError(str(error)) from error


@dataclass(frozen=True)
class CampaignStep:
    """Writes the motion as a table and runs the campaign on it."""

    request: CampaignRequest

    def __call__(self, context: Context, tick: Tick) -> None:
        from mamori.profiles.input_error import InputError
        from mamori.profiles.motion import load_limits, read_motion, write_canonical
        from mamori.verification.campaign import run_campaign
