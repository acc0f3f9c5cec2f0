# SPDX-License-Identifier: Apache-2.0
"""Fault-injection campaign: runs a program once per planned fault and evaluates each run by its physics.

    plan = load_plan(Path("faults.yaml"))
    selection = select(plan, names=["encoder_freeze"], instants=1)      # all scenarios, all instants: select(plan)
    result = run_campaign(selection, Settings(program=.., files={"model": .., "motion": ..}, evidence=..))
    result.passed                                                       # campaign.json and campaign.xml are written

@satisfies SWR-CMP-001, SWR-CMP-002
Design: docs/design/simulation.md#campaign-plan
"""

from mamori_tools.campaign.case import Case, Check, Evaluation, Plan, Scenario, Selection, Verdict, conclude, select
from mamori_tools.campaign.result import CampaignResult, CaseResult
from mamori_tools.campaign.runner import Settings, replay_case, run_campaign
from mamori_tools.campaign.subject import Expansion, Subject, load_plan, load_subject

__all__ = ["CampaignResult", "Case", "CaseResult", "Check", "Evaluation", "Expansion", "Plan", "Scenario", "Selection", "Settings", "Subject",
           "Verdict", "conclude", "load_plan", "load_subject", "replay_case", "run_campaign", "select"]  # fmt: skip
