# SPDX-License-Identifier: Apache-2.0
"""`./mamori test`.

@satisfies SWR-CLI-006      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import argparse

from mamori_tools.campaign.campaign_step import CampaignRequest
from mamori_tools.host.arguments import Command, add_jobs, at_least_one
from mamori_tools.host.full_run import FILE, record_full_run
from mamori_tools.host.project import RELEASE, ROOT, SANITIZED, Project
from mamori_tools.host.session import begin, finish, show_steps
from mamori_tools.host.steps import Tier, run_steps
from verification.plan.gate import list_test_steps

QUICK_HELP = ("only build, C++ tests, static checks and fault campaign, for use during programming; missing results are tolerated")
ALL_HELP = ("for a release: also what takes hours, such as long campaigns, all mutation rows and long fuzzing. Date and commit are stored in "
            "verification/full_run.json and shown in each report")  # fmt: skip


def test(jobs: int, tier: Tier, mutation_minutes: int | None) -> int:
    """The steps of `tier`. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(project.motion)
    request.check(project)
    context = begin(project, jobs, (RELEASE, SANITIZED))
    outcomes = run_steps(list_test_steps(project, request.run, tier, mutation_minutes), context)
    show_steps(outcomes, context)
    if tier == Tier.ALL:
        record_full_run(project, outcomes)
        context.screen.say(f"recorded in {FILE}: add it to the commit")
    return finish(outcomes, context)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    tier = parser.add_mutually_exclusive_group()
    for option, steps, text in (("--quick", Tier.QUICK, QUICK_HELP), ("--all", Tier.ALL, ALL_HELP)):
        tier.add_argument(option, action="store_const", dest="tier", const=steps, default=Tier.GATE, help=text)
    parser.add_argument("--mutation-minutes", type=at_least_one, metavar="M",
                        help="with --all: stop trying mutants after M minutes (at least 1); the step is then inconclusive. Default: no limit")  # fmt: skip
    add_jobs(parser)


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return test(arguments.jobs, arguments.tier, arguments.mutation_minutes)


COMMAND = Command(
    add_arguments, run, "everything that CI runs: all tests, sanitizers, static checks, proofs, campaign, report",
    "Runs everything that CI runs. Ends with a table of all steps and the line `N passed, N failed, N skipped`. docs/manual/test_tiers.md "
    "describes the purpose and run time of each step.")  # fmt: skip
