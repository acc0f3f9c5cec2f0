# SPDX-License-Identifier: Apache-2.0
"""A folder with plan, model, motion and a small program that replaces the simulated arm. The program complies with the contract of the arm.
The fault plan can make it crash, hang, run slowly, or write invalid output."""

from __future__ import annotations

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pyarrow.parquet

from mamori_tools.campaign import CampaignResult, Settings, load_plan, run_campaign, select
from mamori_tools.campaign.runner import Progress

PLAN = """\
schema: mamori.fault_plan/1
seed: 7
instants: [0.25, 0.5]
motion_begins_at_s: 0.1
observe_s: 1.0
bounds: {hold_drift_rad: 0.002, hold_observed_s: 0.5, tracking_error_rad: 0.02}
scenarios:
  - name: none
    title: No fault
    fault: {kind: none}
    expected: {state: Operational, reaction: [None], detected_fault: [None]}
    requirements: {SYS-020: nominal, SYS-027: nominal}
  - name: message_late
    title: Late & <quoted>
    fault: {kind: message_late, magnitude: 0.0}
    expected: {state: Safe, reaction: [Sto], detected_fault: [CommandStale], within_s: 0.02}
    requirements: {SYS-023: violation, SYS-026: nominal}
"""

# The magnitude of message_late selects the misbehaviour of the program.
PROGRAM = """\
#!{python}
import json, os, sys, time
arguments = dict(zip(sys.argv[2::2], sys.argv[3::2]))
assert sys.argv[1] == "run" and os.path.exists(arguments["--model"]) and os.path.exists(arguments["--motion"])
pairs = dict(pair.split("=") for pair in arguments["--fault"].split(",")) if "--fault" in arguments else None
mode = int(float(pairs["magnitude"])) if pairs else 0
at = 0.1 + float(pairs["at"]) if pairs else None
out = arguments["--out"]
simulated = int(arguments["--frames"]) / 1000 if "--frames" in arguments else 4.2
run = {{"schema": "mamori.run/1", "commit": os.environ.get("MAMORI_COMMIT", "none"), "seed": int(arguments["--seed"]), "wall_s": time.time(),
       "simulated_s": simulated,
       "latent": None,
       "fault": pairs and {{"kind": pairs["kind"], "joint": None, "channel": None, "at_s": at, "motion_at_s": float(pairs["at"]), "magnitude": mode}},
       "final_state": "Safe" if pairs else "Operational", "operational_at_s": 0.05,
       "detected_fault": "CommandStale" if pairs else None, "detected_at_s": at and at + 0.01,
       "reaction": "Sto" if pairs else None, "reacted_at_s": at and at + 0.01,
       "standstill_at_s": at and at + 0.2, "watchdog_bitten": False,
       "physics": {{"max_speed_rad_s": [0.1], "speed_limit_rad_s": [1.0], "min_position_margin_rad": 0.4,
                   "stop_travel_rad": [0.0], "hold_drift_rad": 0.0, "max_tracking_error_rad": 0.001}}}}
text = json.dumps(run)
if mode == 1:
    sys.stderr.write("first\\nlast words \\x01\\n"); sys.exit(2)
if mode == 2:
    os.kill(os.getpid(), 11)
with open(os.path.join(os.path.dirname(os.path.abspath(sys.argv[0])), "starts.txt"), "a") as starts:
    starts.write(os.path.basename(out) + "\\n")
if mode == 9:
    time.sleep(0.1)
if mode == 10:
    text = text.replace("0.4", repr(time.time()))
if mode == 3:
    open(out + "/pid", "w").write(str(os.getpid())); time.sleep(60)
if mode == 4:
    text = text[:len(text) // 2]
if mode == 5:
    text = text.replace("0.4", "NaN")
if mode == 6:
    text = text.replace('"stop_travel_rad": [0.0]', '"stop_travel_rad": [1e999]')
if mode != 7:
    open(out + "/run.json", "w").write(text)
if mode == 8:
    sys.exit(1)
"""


class Bench:
    """A folder with plan, program and model, and a function that runs a campaign in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.motion = folder / "motion.txt"
        self.motion.write_text("0.0 0.0\n4.0 0.4\n")
        self.evidence = folder / "evidence"
        self.program = folder / "program"
        self.program.write_text(PROGRAM.format(python=sys.executable))
        self.program.chmod(0o755)
        self.model = folder / "model.yaml"
        self.model.write_text("joints: [{name: J1, position_range_rad: [-1, 1], speed_limit_rad_s: 1}]\n")
        self.plan = folder / "faults.yaml"
        self.write_plan(0)

    def write_plan(self, mode: int) -> None:
        self.plan.write_text(PLAN.replace("magnitude: 0.0", f"magnitude: {mode}.0"))

    def write_long_plan(self, cases: int) -> None:
        """One fault-free case, and `cases` cases with a fault, which take a tenth of a second each."""
        self.write_plan(9)
        instants = ", ".join(f"{number / (cases + 1):.5f}" for number in range(1, cases + 1))
        self.plan.write_text(self.plan.read_text().replace("instants: [0.25, 0.5]", f"instants: [{instants}]"))

    def make_command(self, *options: str) -> list[str]:
        return [sys.executable, "-P", "-m", "mamori_tools.command", "campaign", str(self.plan), "--program", str(self.program), "--model",
                str(self.model), "--motion", str(self.motion), "--out", str(self.evidence), *options]  # fmt: skip

    def call(self, *options: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.make_command(*options), capture_output=True, text=True, check=False, timeout=300.0)

    def read_starts(self) -> list[str]:
        """Case ids in the order in which the program was started."""
        path = self.folder / "starts.txt"
        return path.read_text().split() if path.exists() else []

    def read_parquet(self) -> list[dict[str, Any]]:
        return pyarrow.parquet.ParquetFile(self.evidence / "campaign/campaign.parquet").read().to_pylist()

    def list_stored(self) -> dict[str, tuple[int, int]]:
        """Finished cases: id -> inode and time of the part file."""
        return {path.stem: (path.stat().st_ino, path.stat().st_mtime_ns) for path in (self.evidence / "campaign/results").glob("*.parquet")}

    def run(self, progress: Progress | None = None, **options: Any) -> CampaignResult:
        settings: dict[str, Any] = {"program": self.program, "files": {"model": self.model, "motion": self.motion}, "evidence": self.evidence,
                                    "jobs": 2, "environment": {"commit": "abc"}, "restart": True}  # fmt: skip
        return run_campaign(select(load_plan(self.plan)), Settings(**(settings | options)), progress)

    def read_json(self) -> dict[str, Any]:
        return json.loads((self.evidence / "campaign/campaign.json").read_text())

    def read_testcases(self) -> list[ElementTree.Element]:
        return list(ElementTree.parse(self.evidence / "junit/campaign.xml").iter("testcase"))
