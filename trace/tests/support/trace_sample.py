# SPDX-License-Identifier: Apache-2.0
"""Creates projects for checks: a small clean one that tests change, and a campaign of realistic size.

`python trace/tests/support/trace_sample.py DIR` writes to DIR the evidence of a campaign of 30 cases with 9.8 s of motion each.
"""

from __future__ import annotations

import json
import math
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.actions.records import make_rows, read_rows, write_rows
from mamori_trace.actions.review import review_links
from mamori_trace.readers.evidence_records import NAME, list_recorded
from mamori_trace.readers.lock import write_lock
from mamori_trace.readers.project import read_requirements

COMMIT = "0123456789abcdef0123456789abcdef01234567"
SCHEMA = Path(__file__).parents[3] / "requirements" / "schema" / "items.toml"
ENVIRONMENT = {
    "schema": "mamori.environment/1",
    "commit": COMMIT,
    "dirty": False,
    "date_utc": "2026-11-21T10:00:00+00:00",
    "command": "./mamori demo",
    "os": "Debian GNU/Linux 12 (bookworm)",
    "cpu": "Sample CPU, 2 cores",
    "cores": 2,
    "compilers": {"g++": "g++ (Debian 12.2.0) 12.2.0", "clang++-19": "Debian clang version 19.1.7"},
    "packages": {"libsimbody-dev": "3.6.1+dfsg-7+b1", "liborocos-kdl-dev": "1.5.1-4"},
    "python": "3.11.7",
}

# (scenario, title, detected fault, reaction, requirement)
SCENARIOS = (
    ("no_fault", "Fault-free motion", None, None, "SYS-027"),
    ("encoder_freeze", "Encoder channel A of joint 2 freezes", "EncoderDiscrepancy", "Ss1", "SYS-020"),
    ("encoder_bit_flip", "A bit flips in encoder channel B of joint 4", "EncoderDiscrepancy", "Ss1", "SYS-020"),
    ("controller_hang", "The controller hangs", "ControllerSilent", "Ss1", "SYS-021"),
    ("torque_runaway", "Drive of joint 1 delivers torque by itself", "Overspeed", "Sto", "SYS-022"),
    ("message_lost", "Controller messages are lost", "CommandStale", "Ss1", "SYS-023"),
    ("message_late", "Controller messages come late", "CommandStale", "Ss1", "SYS-023"),
    ("power_loss", "The drive supply is lost", "PowerLost", "Sto", "SYS-024"),
    ("brake_slip", "Brake of joint 2 slips", "BrakeSlip", "Sto", "SYS-026"),
    ("software_hang", "The safety software hangs", None, None, "SYS-028"),
)
SPEED_LIMIT_RAD_S = (1.0, 1.0, 2.0, 2.0, 6.28, 6.28, 6.28)


def format_item(item_id: str, title: str, statement: str, **attributes: str) -> str:
    """One item block; missing attributes get the values of a plain approved item."""
    rows = {"Rationale": "It is needed.", "Parents": "-", "SIL": "2", "Verify": "test", "Polarity": "nominal",
            "Design": "-", "Status": "approved"}  # fmt: skip
    rows.update(attributes)
    lines = "\n".join(f"- {name}: {value}" for name, value in rows.items())
    return f"## {item_id} {title}\n\n{statement}\n\n{lines}\n\n"


def format_record(child: str, parent: str, carrier: str) -> str:
    """A decomposition file with one record."""
    texts = {"child": child, "parent": parent, "reason": "It is so.", "independence": "They share nothing.", "by": "Sample Reviewer"}
    rows = "".join(f'{key} = "{value}"\n' for key, value in texts.items())
    return f'schema = "mamori.decomposition/1"\n\n[[record]]\n{rows}carried_by = ["{carrier}"]\n'


def format_waiver(rule: str, **columns: str) -> str:
    """A file of waivers with one row; reason and name are added unless they are among `columns`."""
    texts = {"rule": rule, "reason": "It is so.", "by": "Sample Reviewer", **columns}
    rows = "".join(f'{key} = "{value}"\n' for key, value in texts.items())
    return f'schema = "mamori.waivers/1"\n\n[[waiver]]\n{rows}'


def format_review(item: str, fingerprint: str, **columns: str) -> str:
    """A file of reviews with one row: an analysis by a person other than the author."""
    texts = {"item": item, "method": "analysis", "fingerprint": fingerprint, "looked_at": "docs/design/arm.md#hazards",
             "author": "Somebody Else", "by": "Sample Reviewer", "date": "2026-11-21", **columns}  # fmt: skip
    rows = "".join(f'{key} = "{value}"\n' for key, value in texts.items())
    return f'schema = "mamori.reviews/1"\n\n[[review]]\n{rows}'


def format_technique(**lists: list[str]) -> str:
    """A file of techniques with one row."""
    rows = "".join(f"{key} = {json.dumps(value)}\n" for key, value in lists.items())
    head = 'name = "Looking twice"\nclause = "Annex Z; needs the bought text"\nphase = "design"\n'
    return f'schema = "mamori.techniques/1"\n\n[[technique]]\n{head}{rows}'


@dataclass
class Outcome:
    """Result of one run of the command."""

    status: int
    out: str
    err: str

    @property
    def content(self) -> dict[str, Any]:
        return json.loads(self.out)

    @property
    def rules(self) -> set[str]:
        return {finding["rule"] for finding in self.content["findings"]}

    def get_verdict(self, item: str) -> str:
        return next(row["verdict"] for row in self.content["items"] if row["id"] == item)


@dataclass
class Sample:
    """A project in `root`. Tests change its files directly; `review` then renews the lock."""

    root: Path

    @property
    def evidence(self) -> Path:
        return self.root / "build" / "host-release" / "evidence"

    def replace(self, file: str, old: str, new: str) -> int:
        """Replaces the only occurrence of `old`. @return its line."""
        path = self.root / file
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{old!r} occurs {text.count(old)} times in {file}"
        path.write_text(text.replace(old, new), encoding="utf-8")
        return text[: text.index(old)].count("\n") + 1

    def append(self, file: str, text: str) -> int:
        """Appends `text`. @return the line at which it begins."""
        path = self.root / file
        old = path.read_text(encoding="utf-8")
        path.write_text(old + text, encoding="utf-8")
        return old.count("\n") + 1

    def write(self, file: str, text: str) -> int:
        """Writes a new file. @return the line of its first row."""
        (self.root / file).write_text(text, encoding="utf-8")
        return text[: text.index("[[")].count("\n") + 1

    def review(self) -> None:
        project = read_requirements(self.root)
        review_links(project, set(project.items), "2026-11-21", "Sample Reviewer")
        assert project.lock is not None  # the lock stores the reviews
        write_lock(self.root, project.lock)


def make_sample(root: Path) -> Sample:
    """A clean project: two needs, a hazard, three system and three software requirements, with all required parts."""
    needs = format_item("STK-001", "Reports", "Engineers need reports.", SIL="QM", Verify="review")
    hazards = format_item("HAZ-001", "Speed", "The arm strikes a person.", Verify="review", Design="docs/design/arm.md#hazards")
    system = (
        format_item("SYS-001", "Supervision", "The kernel shall supervise time.", Parents="STK-001, HAZ-001",
                    Polarity="nominal, violation", Design="docs/design/arm.md#supervision-who-watches")
        + format_item("SYS-002", "Freeze", "The arm shall stop when an encoder freezes.", Parents="HAZ-001",
                      Verify="campaign", Polarity="nominal, violation")
        + format_item("SYS-003", "Tool", "The tool shall run offline.", Parents="STK-001", SIL="QM")
    )  # fmt: skip
    software = (
        format_item("SWR-SUP-001", "Silent", "The supervision shall report a silent entity.", Parents="SYS-001, HAZ-001",
                    Polarity="nominal, violation", Design="docs/design/arm.md#hazards")
        + format_item("SWR-SUP-002", "Late", "The supervision shall report a late entity.", Parents="SYS-001",
                      Design="docs/design/arm.md#hazards")
        + format_item("SWR-TLS-001", "Offline", "The tool shall open no connection.", Parents="SYS-003", SIL="QM")
    )  # fmt: skip
    files = {
        "requirements/README.md": "# Format\n\n## Not an item\n",
        "requirements/stakeholder/needs.md": "# Needs\n\n" + needs,
        "requirements/safety/hazards.md": "# Hazards\n\n" + hazards,
        "requirements/system/system.md": "# System\n\n" + system,
        "requirements/software/software.md": "# Software\n\n" + software,
        "docs/design/arm.md": "# Arm\n\n## Hazards\n\n## Supervision: who watches?\n",
        "safety/include/alive.hpp": _HEADER,
        "safety/tests/alive_test.cpp": _CPP_TEST,
        "tools/offline.py": '"""Works offline.\n\n@satisfies SWR-TLS-001\n"""\n',
        "tools/tests/test_offline.py": _PYTHON_TEST,
        "build/host-release/evidence/junit/safety.xml": _GTEST_XML,
        "build/host-release/evidence/junit/tools.xml": _PYTEST_XML,
        "build/host-release/evidence/environment.json": json.dumps(ENVIRONMENT, indent=1),
    }
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    (root / "requirements" / "schema").mkdir()
    shutil.copy(SCHEMA, root / "requirements" / "schema")
    sample = Sample(root)
    cases = [_make_case(SCENARIOS[0], 1, 3.0, 4.0, ["SYS-002"]), _make_case(SCENARIOS[1], 1, 2.0, 4.0, ["SYS-002"])]
    write_campaign(sample.evidence / "campaign", cases, 4.0)
    record(sample.evidence)
    sample.review()
    return sample


SAMPLE_INPUTS = {"sources": "", "tool_chain": "", "configuration": "sample"}


def record(folder: Path, files: list[Path] | None = None) -> None:
    """Records the current evidence folder, or `files` in it. Records that the test itself wrote stay unchanged."""
    if any(row.get("configuration") != "sample" for row in read_rows(folder).values()) or ((folder / NAME).exists() and not read_rows(folder)):
        return
    write_rows(folder, make_rows(folder, list_recorded(folder) if files is None else files, SAMPLE_INPUTS, lambda _: None))


def write_campaign(folder: Path, cases: list[dict[str, Any]], end_s: float) -> None:
    """campaign.json and one folder with series.csv per case."""
    folder.mkdir(parents=True, exist_ok=True)
    content = {"schema": "mamori.campaign/1", "environment": ENVIRONMENT, "cases": cases}
    (folder / "campaign.json").write_text(json.dumps(content, indent=1), encoding="utf-8")
    for case in cases:
        (folder / case["folder"]).mkdir(exist_ok=True)
        (folder / case["folder"] / "series.csv").write_text(_format_series(case["run"], end_s), encoding="utf-8")


def write_large_campaign(folder: Path, instants: int = 3) -> None:
    """Every scenario at several instants, 9.8 s of motion each."""
    cases = []
    for scenario in SCENARIOS:
        for number in range(1, instants + 1):
            requirements = [scenario[4], "SYS-025", "SYS-026"] if scenario[2] else [scenario[4], "SYS-020", "SYS-025", "SYS-026"]
            cases.append(_make_case(scenario, number, 1.5 + 2.3 * number, 9.8, requirements))
    write_campaign(folder / "campaign", cases, 9.8)
    (folder / "environment.json").write_text(json.dumps(ENVIRONMENT, indent=1), encoding="utf-8")
    record(folder)


def _make_case(scenario: tuple, number: int, at_s: float, end_s: float, requirements: list[str]) -> dict[str, Any]:
    name, title, fault, reaction, _ = scenario
    faulty = name != "no_fault"
    bitten = faulty and fault is None
    reacted_s = at_s + (0.004 + 0.006 * number) if fault else None
    final = "Operational" if not faulty else "Safe"
    checks = [{"name": "final state", "wanted": final, "measured": final, "passed": True}]
    if faulty:
        checks.append({"name": "hold drift", "wanted": "<= 0.001 rad", "measured": "1e-05 rad", "passed": True})
    run = {
        "schema": "mamori.run/1", "commit": COMMIT, "compiler": "g++ 12.2", "seed": number,
        "frames": round(end_s * 1000), "period_s": 0.001, "motion": "reach.yaml", "model": "pa10_like.yaml",
        "fault": {"kind": name, "joint": 2, "channel": "a", "at_s": at_s, "duration_s": None, "magnitude": 0.0} if faulty else None,
        "trace_hash": f"{0x9E3779B97F4A7C15 * number % 2**64:016x}", "simulated_s": end_s, "wall_s": 0.41,
        "initial_state": "SelfTest", "final_state": final, "operational_at_s": 0.05,
        "detected_fault": fault, "detected_at_s": reacted_s, "reaction": reaction, "reacted_at_s": reacted_s,
        "standstill_at_s": at_s + 0.31 if faulty else None, "watchdog_bitten": bitten,
        "physics": {
            "max_speed_rad_s": [0.8 * limit for limit in SPEED_LIMIT_RAD_S], "speed_limit_rad_s": list(SPEED_LIMIT_RAD_S),
            "min_position_margin_rad": 0.4, "stop_travel_rad": [0.01 * (joint + number) if faulty else 0.0 for joint in range(7)],
            "hold_drift_rad": 1e-5 if faulty else 0.0, "max_tracking_error_rad": 0.0031,
        },
    }  # fmt: skip
    expected = {"state": final, "reaction": [reaction] if reaction else [], "detected_fault": [fault] if fault else [],
                "within_s": 0.05 if faulty else None}  # fmt: skip
    return {"id": f"{name}-{number}", "scenario": name, "title": title, "requirements": requirements,
            "polarity": "violation" if faulty else "nominal", "expected": expected, "run": run,
            "folder": f"{name}-{number}", "checks": checks, "verdict": "pass"}  # fmt: skip


def _format_series(run: dict[str, Any], end_s: float) -> str:
    """Sine motions that brake within 0.3 s after the fault; 10 ms steps, 1 ms around the injection."""
    names = [f"{name}{joint + 1}" for name in ("q", "qd", "qref", "tau") for joint in range(7)]
    rows = [",".join(["t_s", *names, "state", "torque_enable", "brake_release"])]
    fault_s = run["fault"]["at_s"] if run["fault"] else math.inf
    angles = [0.3 * joint - 0.8 for joint in range(7)]
    previous_s = 0.0
    for milli in range(round(end_s * 1000) + 1):
        time_s = milli / 1000.0
        if milli % 10 and not -0.05 <= time_s - fault_s <= 0.4:
            continue
        since_s = time_s - fault_s
        factor = 1.0 if since_s < 0.02 else max(0.0, 1.0 - (since_s - 0.02) / 0.29)
        speeds = [0.45 * SPEED_LIMIT_RAD_S[j] * math.sin(time_s * (0.6 + 0.15 * j) + j) * factor for j in range(7)]
        angles = [angle + speed * (time_s - previous_s) for angle, speed in zip(angles, speeds, strict=True)]
        previous_s = time_s
        state = "SelfTest" if time_s < 0.05 else "Operational" if since_s < 0.02 else "ProtectiveStopSs1" if since_s < 0.31 else "Safe"
        torques = [12.0 * speed for speed in speeds]
        values = [time_s, *angles, *speeds, *angles, *torques]
        enabled = int(since_s < 0.31)
        rows.append(",".join([*(f"{value:.6g}" for value in values), state, str(enabled), str(enabled)]))
    return "\n".join(rows) + "\n"


_HEADER = """// SPDX-License-Identifier: Apache-2.0
/// @file
/// Alive supervision.
///
/// @satisfies SWR-SUP-001      Design: docs/design/arm.md

namespace mamori {

/// Reports late entities.
/// @satisfies SWR-SUP-002
class LateReporter final {
  public:
    void step();
};

}  // namespace mamori
"""

_CPP_TEST = """// SPDX-License-Identifier: Apache-2.0
// verifies("SWR-OLD-001") in a comment is no test.
TEST_F(AliveTest, SilenceIsReported) {
    verifies("SWR-SUP-001", Technique::kBoundaryValues);
    EXPECT_TRUE(sut_.step());
}

TEST_F(AliveTest, SilenceIsNotHealedByOneReport) {
    verifies("SWR-SUP-001", Technique::kFaultInjection,
             Polarity::kViolation);
    EXPECT_FALSE(sut_.may_service_watchdog());
}

TEST_P(LateTest, LatenessIsReported) {
    verifies("SWR-SUP-002");
    EXPECT_TRUE(sut_.late());
}
"""

_PYTHON_TEST = '''# SPDX-License-Identifier: Apache-2.0
import pytest

TEXT = """
@pytest.mark.verifies("SWR-OLD-002")
"""


@pytest.mark.verifies("SWR-TLS-001", technique="interface")
@pytest.mark.parametrize("name", ["a", "b"])
def test_no_connection(name):
    assert name
'''


def format_gtest_case(suite: str, name: str, requirement: str, polarity: str = "nominal", inner: str = "", **more: str) -> str:
    """One test case in the form of GoogleTest."""
    attributes = {"name": name, "status": "run", "result": "completed", "time": "0.001", "classname": suite, **more}
    head = " ".join(f'{key}="{value}"' for key, value in attributes.items())
    rows = (("requirement", requirement), ("technique", "requirements_based"), ("polarity", polarity))
    properties = "\n".join(f'        <property name="{key}" value="{value}"/>' for key, value in rows)
    return f"    <testcase {head}>\n{inner}      <properties>\n{properties}\n      </properties>\n    </testcase>\n"


_GTEST_XML = (
    '<?xml version="1.0" encoding="UTF-8"?>\n<testsuites name="AllTests">\n  <testsuite name="AliveTest">\n'
    + format_gtest_case("AliveTest", "SilenceIsReported", "SWR-SUP-001")
    + format_gtest_case("AliveTest", "SilenceIsNotHealedByOneReport", "SWR-SUP-001", "violation")
    + format_gtest_case("Limits/LateTest", "LatenessIsReported/0", "SWR-SUP-002")
    + "  </testsuite>\n</testsuites>\n"
)

_PYTEST_XML = """<?xml version="1.0" encoding="utf-8"?>
<testsuites><testsuite name="pytest" tests="2">
<testcase classname="tools.tests.test_offline" name="test_no_connection[a]" time="0.001"><properties>
<property name="requirement" value="SWR-TLS-001"/><property name="technique" value="interface"/>
<property name="polarity" value="nominal"/></properties></testcase>
<testcase classname="tools.tests.test_offline" name="test_no_connection[b]" time="0.001"><properties>
<property name="requirement" value="SWR-TLS-001"/><property name="technique" value="interface"/>
<property name="polarity" value="nominal"/></properties></testcase>
</testsuite></testsuites>
"""

if __name__ == "__main__":
    write_large_campaign(Path(sys.argv[1]))
