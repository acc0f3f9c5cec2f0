# SPDX-License-Identifier: Apache-2.0
"""`./mamori demo`: the main job.

@satisfies SWR-CLI-011      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Sequence
from pathlib import Path

from mamori_tools.campaign.campaign_step import CampaignRequest
from mamori_tools.campaign.campaign_table import show_campaign
from mamori_tools.command.own_plans import load_own_plans
from mamori_tools.host import plans
from mamori_tools.host.arguments import Command, add_jobs, at_least_one
from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_tools.host.session import begin, finish
from mamori_tools.host.steps import Context, Tier, run_steps

SHOWN_WIDTH = 110  # maximum characters in a line of names


def demo(jobs: int, motion: Path | None, scenarios: tuple[str, ...], instants: int | None) -> int:
    """The main job. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(motion or project.motion, scenarios, instants)
    notes = request.check(project)
    context = begin(project, jobs, (RELEASE,))
    for note in notes:
        context.screen.say(f"note: {request.motion.name}: {note}")
    plan = plans.demo_plan(request.run)
    outcomes = run_steps(plan, context)
    show_campaign(context)
    show_not_run(plans.find_not_run(plan, load_own_plans().list_test_steps(project, request.run, Tier.GATE)), context)
    return finish(outcomes, context)


def show_not_run(names: Sequence[str], context: Context) -> None:
    """The steps of `./mamori test` that this run omits."""
    context.screen.say()
    context.screen.say("not run (./mamori test runs these as well):")
    for line in textwrap.wrap(", ".join(names), width=SHOWN_WIDTH, break_long_words=False, break_on_hyphens=False):
        context.screen.say(f"  {line}")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--motion", type=Path, metavar="FILE",
                        help="BodyMotion YAML file or table (time and joints) to follow; default: the shipped motion")  # fmt: skip
    parser.add_argument("--scenario", nargs="+", default=[], metavar="NAME", action="extend",
                        help="only these fault scenarios; default: all of none, encoder_freeze, encoder_freeze_shoulder, encoder_freeze_both, "
                             "encoder_bit_flip, encoder_bias, encoder_drift_shoulder, encoder_drift_upper_arm, encoder_drift_wrist, clock_fast, "
                             "clock_slow, controller_hang, torque_runaway_shoulder, torque_runaway_elbow, torque_runaway_wrist, message_lost, "
                             "message_late, message_lost_once, message_damaged, message_damaged_once, controller_drops_arm, controller_swings_arm, "
                             "power_loss, supervisor_hang, brake_stuck_open, brakes_stuck_open, sto_ignored, relay_stuck, start_with_weak_brake, "
                             "start_with_sto_ignored, start_with_relay_stuck, processor_stops, processor_stops_relay_stuck, "
                             "processor_stops_sto_ignored, emergency_stop, emergency_stop_channel_a, emergency_stop_channel_b, "
                             "emergency_stop_reset_stuck, protective_stop, protective_stop_channel_a, protective_stop_channel_b, "
                             "protective_stop_start_stuck, start_with_start_stuck, start_with_creeping_brake, reduced_speed, hold_to_run, "
                             "enabling_released, enabling_released_channel_a, enabling_squeezed, run_released, enabling_released_in_automatic, "
                             "mode_changed")  # fmt: skip
    parser.add_argument("--instants", type=at_least_one, metavar="N",
                        help="inject each fault at the first N instants (at least 1) of the campaign plan; default: all instants")  # fmt: skip
    add_jobs(parser)


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return demo(arguments.jobs, arguments.motion, tuple(arguments.scenario), arguments.instants)


COMMAND = Command(
    add_arguments, run, "build the example arm, inject its faults and write the report; runs no tests",
    "Builds the example arm, lets it follow a motion under injected faults and writes report/index.html. Runs no tests. At the end, it lists the "
    "steps that only ./mamori test runs.",
    examples=("demo --scenario encoder_freeze power_loss --instants 1",))  # fmt: skip
