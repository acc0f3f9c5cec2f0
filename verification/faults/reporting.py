# SPDX-License-Identifier: Apache-2.0
"""Reports the finding of a run as the result of a pytest test. An inconclusive run is skipped with the properties `verdict` and `figure`.

@satisfies SWR-VER-023      Design: docs/design/test_strength.md#real-time-verdicts
"""

from __future__ import annotations

import json

import pytest

from verification.faults.evaluation.evaluator import Result


def record_finding(properties: list[tuple[str, object]], result: Result, part: str, is_timed: bool = True) -> None:
    """@param[out] properties of the test in its JUnit file.
    @param is_timed False for a build with sanitizers, whose first window instances exceed their budgets: a failed verdict then proves
    nothing."""
    finding = result.parts[part]
    if not result.has_priority:
        pytest.skip("verdict=no-privilege: without a fixed priority any thread of the host delays the windows")
    is_shown = is_timed or finding.verdict != "failed"
    properties.append(("verdict", finding.verdict if is_shown else "not-shown"))
    if finding.verdict != "passed":
        properties.append(("figure", finding.reason))
    if not is_shown:
        pytest.skip(f"verdict=not-shown: sanitizers change execution times; {finding.reason}")
    assert finding.verdict != "failed", f"{finding.reason}\n{json.dumps(result.to_json(), indent=1)}"
    if finding.verdict == "inconclusive":
        pytest.skip(f"verdict=inconclusive: {finding.reason}")
