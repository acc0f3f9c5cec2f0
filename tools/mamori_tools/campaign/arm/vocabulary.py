# SPDX-License-Identifier: Apache-2.0
"""The names that the program under test writes to run.json. A plan may use no other names."""

from __future__ import annotations

STATES = ("SelfTest", "Standby", "Operational", "Degraded", "ProtectiveStopSs2", "ProtectiveStopSs1", "StandstillHold", "Safe",
          "LockedOut", "LockedHold")  # fmt: skip

NOTHING = "None"
"""Spelling of "no reaction" and "no fault detected" in plans and verdicts; run.json contains null."""

REACTIONS = (NOTHING, "Degrade", "Ss2", "Ss1", "Sto")
STOPS = frozenset({"Ss2", "Ss1", "Sto"})

DETECTED_FAULTS = (NOTHING, "EncoderImplausible", "EncoderDiscrepancy", "EncoderStuck", "FollowingError", "Overspeed",
                   "PositionLimit", "TorqueDeviation", "ControllerSilent", "CommandStale", "PowerLost", "BrakeFault",
                   "SelfTestFailed", "MeasurementStale", "ReactionLate", "BrakeTestOld", "StopNotFollowed",
                   "EmergencyStop", "SwitchDiscrepancy", "ProtectiveStop", "MovementAtRest", "EnableLost", "EnablingSqueezed", "ModeSelector",
                   "ClockDeviation", "PositionDoubtful", "RunReleased",
                   "SupervisorSilent", "WatchdogExpired")  # fmt: skip
