# SPDX-License-Identifier: Apache-2.0
# ruff: noqa
# mypy: ignore-errors
"""A motion controller of the user: PD control along the motion table. docs/manual/hil.md shows how to run it."""
import bisect, os, struct, lcm
from safe_arm.ControllerInput_e2e import ControllerInput_e2e
from safe_arm.TorqueCommand_e2e import TorqueCommand_e2e

KP = (20000.0, 20000.0, 8000.0, 8000.0, 400.0, 400.0, 20.0)  # N m/rad
KD = (400.0, 400.0, 150.0, 150.0, 6.0, 6.0, 0.4)  # N m s/rad
MOTION = [[float(word) for word in line.split()] for line in open(os.environ["MAMORI_HIL_MOTION"]) if line[0] != "#"]
TABLE = list(range(256))  # CRC-32 of E2E profile 4, reflected polynomial
for _ in range(8):
    TABLE = [crc >> 1 ^ 0xC8DF352F * (crc & 1) for crc in TABLE]

def protect(message, counter):
    """Writes the E2E header behind the fingerprint of 8 octets: length, counter, identifier of the link, checksum."""
    header, crc = struct.pack(">HHI", len(message) - 8, counter & 0xFFFF, 0x48494C04), 0xFFFFFFFF
    for octet in header + message[20:]:
        crc = crc >> 8 ^ TABLE[(crc ^ octet) & 0xFF]
    return message[:8] + header + struct.pack(">I", crc ^ 0xFFFFFFFF) + message[20:]

def reply(_channel, data):
    global hold, start_ns
    arm, command = ControllerInput_e2e.decode(data), TorqueCommand_e2e()
    if not arm.torque_enable:
        hold, start_ns = arm.position_rad, max(arm.sent_at_ns, 500_000_000)
    time_s = (arm.sent_at_ns - start_ns) / 1e9 * (0.025 if arm.is_reduced else 1.0)
    place = min(max(bisect.bisect_right(MOTION, [time_s]), 1), len(MOTION) - 1)
    (t0, *q0), (t1, *q1) = MOTION[place - 1 : place + 1]
    share = min(max((time_s - t0) / (t1 - t0), 0.0), 1.0)
    wanted = [a + share * (b - a) for a, b in zip(q0, q1)] if time_s > 0.0 else hold
    command.e2e, command.sequence, command.sent_at_ns, command.setpoint_rad = bytes(12), arm.sent_at_ns // 1_000_000, arm.sent_at_ns, wanted
    command.torque_nm = [kp * (w - q) - kd * v for kp, kd, w, q, v in zip(KP, KD, wanted, arm.position_rad, arm.velocity_rad_s)]
    network.publish("ARM_COMMAND", protect(command.encode(), command.sequence))

hold, start_ns, network = (0.0,) * 7, 0, lcm.LCM()
network.subscribe("ARM_STATE", reply)
while True:
    network.handle()
