# SPDX-License-Identifier: Apache-2.0
"""The steps of the tests of Mamori itself. `verification` registers them, so that the tools import no higher package."""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import Protocol

from mamori_tools.host.project import Project
from mamori_tools.host.steps import Action, Step, Tier


class OwnPlans(Protocol):
    """The object that is registered as entry point `own` of the group `mamori.plans`."""

    def list_test_steps(self, project: Project, campaign: Action, tier: Tier) -> tuple[Step, ...]:
        """`./mamori test`."""

    def list_verify_steps(self, campaign: Action) -> tuple[Step, ...]:
        """`./mamori verify` without a project."""


def load_own_plans() -> OwnPlans:
    [point] = entry_points(group="mamori.plans", name="own")
    own: OwnPlans = point.load()
    return own
