# SPDX-License-Identifier: Apache-2.0
"""Fault-injection campaign: runs a program once per planned fault and judges each run by its physics.

    plan = load_plan(Path("faults.yaml"))
    selection = select(plan, names=["encoder_freeze"], instants=1)      # all scenarios, all instants: select(plan)
    result = run_campaign(selection, program=.., model=.., motion=.., evidence=..)
    result.passed                                                       # campaign.json and campaign.xml are written

@satisfies SWR-CMP-001, SWR-CMP-002, SWR-CMP-003, SWR-CMP-004, SWR-CMP-005, SWR-CMP-006, SWR-CMP-007
Design: docs/design/simulation.md#campaign-plan
"""

from mamori_tools.campaign.judge import Check, judge
from mamori_tools.campaign.plan import Plan, Scenario, load_plan
from mamori_tools.campaign.result import CampaignResult, CaseResult
from mamori_tools.campaign.runner import run_campaign
from mamori_tools.campaign.selection import Case, Selection, resolve, select

__all__ = ["CampaignResult", "Case", "CaseResult", "Check", "Plan", "Scenario", "Selection", "judge", "load_plan", "resolve",
           "run_campaign", "select"]  # fmt: skip
