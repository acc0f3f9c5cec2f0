# SPDX-License-Identifier: Apache-2.0
# Goal: the table of a campaign shows the worst figure of each scenario and no false pass.
from __future__ import annotations

from typing import Any

import pytest

from mamori_tools.campaign.campaign_table import COLUMNS, summarise_campaign


def make_case(scenario: str, verdict: str, at_s: float | None, reacted_at_s: float | None, travel: float) -> dict[str, Any]:
    physics = {"stop_travel_rad": [0.0, travel], "max_tracking_error_rad": 0.002}
    fault = None if at_s is None else {"at_s": at_s}
    run = {"fault": fault, "reacted_at_s": reacted_at_s, "final_state": "Safe" if fault else "Operational", "physics": physics}
    return {"scenario": scenario, "verdict": verdict, "run": run}


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_worst_case_of_each_scenario_is_shown() -> None:
    cases = [make_case("none", "pass", None, None, 0.0), make_case("freeze", "pass", 1.0, 1.004, 0.01),
             make_case("freeze", "pass", 2.0, 2.007, 0.02)]  # fmt: skip

    columns, rows = summarise_campaign({"cases": cases})

    assert columns == COLUMNS
    assert rows == [("none", "passed", "1/1", "Operational", "-", "-", "0.0020 rad"),
                    ("freeze", "passed", "2/2", "Safe", "7.0 ms", "0.020 rad", "0.0020 rad")]  # fmt: skip


@pytest.mark.verifies("SWR-CLI-006", technique="equivalence_classes")
def test_arm_that_went_on_has_no_stop_travel() -> None:
    _, rows = summarise_campaign({"cases": [make_case("lost_once", "pass", 1.0, None, 0.8)]})

    assert rows[0][4:6] == ("-", "-")


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_failed_and_crashed_cases_fail_their_scenario() -> None:
    cases = [make_case("freeze", "pass", 1.0, 1.004, 0.01), make_case("freeze", "fail", 2.0, None, 0.0)]

    cases.append({"scenario": "freeze", "verdict": "fail", "run": {}})

    _, rows = summarise_campaign({"cases": cases})

    assert rows[0][1:3] == ("failed", "1/3")
