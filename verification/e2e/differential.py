# SPDX-License-Identifier: Apache-2.0
"""Compares end-to-end protection with the package `autosar-e2e`, an independent implementation, on random messages.

    python -P -m verification.e2e.differential PROGRAM [--frames N] [--seed N]

PROGRAM is the built `mamori_e2e_pipe`. Both implementations protect each message and then read it. Half of the messages are damaged in
between. Prints the number of messages per profile and the first differences. Exit status 1 with differences, 2 for wrong arguments.

@satisfies SWR-E2E-003      Design: docs/design/e2e.md#comparison
"""

from __future__ import annotations

import argparse
import random
import struct
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from e2e import p01, p02, p04, p05, p06, p07, p11

BATCH = 2000  # messages per run of the program, because its replies wait in a pipe of limited size
GOOD = 0  # FrameCause::kGood
DIFFERENCES_SHOWN = 10
HEADER_SIZES = {1: 2, 2: 2, 4: 12, 5: 3, 6: 5, 7: 20, 11: 2}
COUNTER_MAX = {1: 14, 2: 15, 4: 0xFFFF, 5: 0xFF, 6: 0xFF, 7: 0xFFFFFFFF, 11: 14}
BOTH, ALTERNATING, LOW, NIBBLE = range(4)  # DataIdMode
P01_MODES = {BOTH: p01.E2E_P01_DATAID_BOTH, ALTERNATING: p01.E2E_P01_DATAID_ALT, LOW: p01.E2E_P01_DATAID_LOW,
             NIBBLE: p01.E2E_P01_DATAID_NIBBLE}  # fmt: skip
P11_MODES = {BOTH: p11.E2E_P11_DATAID_BOTH, NIBBLE: p11.E2E_P11_DATAID_NIBBLE}


@dataclass(frozen=True)
class Case:
    """A channel, a counter, and the content of the message before protection."""

    profile: int
    mode: int
    offset: int
    data_id: int
    counter: int
    data_ids: bytes
    payload: bytes

    def make_request(self, operation: int, frame: bytes) -> bytes:
        """Request for the program; see pipe.cpp."""
        return struct.pack("<BBBBHHII16s", self.profile, self.mode, operation, 0, self.offset, len(frame), self.data_id,
                           self.counter, self.data_ids) + frame  # fmt: skip


def make_case(chance: random.Random) -> Case:
    """Any channel that the profile permits, with any counter and payload."""
    profile = chance.choice(sorted(HEADER_SIZES))
    mode, data_id = BOTH, chance.getrandbits(32 if profile in (4, 7) else 16)
    if profile in (1, 11):
        mode = chance.choice(sorted(P01_MODES if profile == 1 else P11_MODES))
        data_id &= {LOW: 0xFF, NIBBLE: 0xFFF}.get(mode, 0xFFFF)
    most = {1: 30, 2: 256, 11: 30}.get(profile, chance.choice((64, 64, 64, 4096)))
    length = chance.randint(HEADER_SIZES[profile], most)
    offset = 0 if profile == 2 else chance.choice((0, chance.randint(0, length - HEADER_SIZES[profile])))
    counter = chance.choice((0, COUNTER_MAX[profile], chance.randint(0, COUNTER_MAX[profile])))
    return Case(profile, mode, offset, data_id, counter, chance.randbytes(16), chance.randbytes(length))


def protect(case: Case) -> bytes:
    """The message, protected by the package. Its counter is written first, because the package reads it from the message."""
    frame = bytearray(case.payload)
    at = case.offset
    match case.profile:
        case 1 | 11:
            frame[at + 1] = frame[at + 1] & 0xF0 | case.counter
            if case.profile == 1:
                p01.e2e_p01_protect(frame, case.data_id, data_id_mode=P01_MODES[case.mode], length=len(frame), offset=at,
                                    increment_counter=False)  # fmt: skip
            else:
                p11.e2e_p11_protect(frame, case.data_id, data_id_mode=P11_MODES[case.mode], length=len(frame), offset=at,
                                    increment_counter=False)  # fmt: skip
        case 2:
            frame[1] = frame[1] & 0xF0 | case.counter
            p02.e2e_p02_protect(frame, case.data_ids, length=len(frame), increment_counter=False)
        case 4:
            frame[at + 2 : at + 4] = case.counter.to_bytes(2, "big")
            p04.e2e_p04_protect(frame, case.data_id, length=len(frame), offset=at, increment_counter=False)
        case 5:
            frame[at + 2] = case.counter
            p05.e2e_p05_protect(frame, case.data_id, length=len(frame), offset=at, increment_counter=False)
        case 6:
            frame[at + 4] = case.counter
            p06.e2e_p06_protect(frame, case.data_id, length=len(frame), offset=at, increment_counter=False)
        case 7:
            frame[at + 12 : at + 16] = case.counter.to_bytes(4, "big")
            p07.e2e_p07_protect(frame, case.data_id, length=len(frame), offset=at, increment_counter=False)
    return bytes(frame)


def check(case: Case, received: bytes) -> bool:
    """The verdict of the package."""
    frame = bytearray(received)  # the package needs a writable buffer
    size, at = len(frame), case.offset
    match case.profile:
        case 1:
            return p01.e2e_p01_check(frame, case.data_id, data_id_mode=P01_MODES[case.mode], length=size, offset=at)
        case 2:
            return p02.e2e_p02_check(frame, case.data_ids, length=size)
        case 4:
            return p04.e2e_p04_check(frame, case.data_id, length=size, offset=at)
        case 5:
            return p05.e2e_p05_check(frame, case.data_id, length=size, offset=at)
        case 6:
            return p06.e2e_p06_check(frame, case.data_id, length=size, offset=at)
        case 7:
            return p07.e2e_p07_check(frame, case.data_id, length=size, offset=at)
        case _:
            return p11.e2e_p11_check(frame, case.data_id, data_id_mode=P11_MODES[case.mode], length=size, offset=at)


def damage(frame: bytes, chance: random.Random) -> bytes:
    """Up to four flipped bits; none in half of the messages."""
    damaged = bytearray(frame)
    for _ in range(chance.choice((0, 0, 0, 0, 1, 2, 3, 4))):
        bit = chance.randrange(len(damaged) * 8)
        damaged[bit // 8] ^= 1 << bit % 8
    return bytes(damaged)


def ask(program: Path, requests: Sequence[bytes]) -> bytes:
    """The replies of the program."""
    return subprocess.run((program,), input=b"".join(requests), capture_output=True, check=True).stdout


def compare(program: Path, cases: Sequence[Case], chance: random.Random) -> Iterator[str]:
    """One line per difference between the package and the program."""
    frames = [protect(case) for case in cases]
    answers = ask(program, [case.make_request(0, case.payload) for case in cases])
    damaged = [damage(frame, chance) for frame in frames]
    verdicts = ask(program, [case.make_request(1, frame) for case, frame in zip(cases, damaged, strict=True)])
    at = 0
    for number, (case, frame) in enumerate(zip(cases, frames, strict=True)):
        cause, ours = answers[at], answers[at + 5 : at + 5 + len(frame)]
        at += 5 + len(frame)
        if cause == 255:  # a stuck line would match this identifier, which is therefore rejected: no comparison is possible
            continue
        if ours != frame:
            yield f"protect {case}: {ours.hex()}, the package says {frame.hex()}"
        is_good = verdicts[5 * number] == GOOD
        expected = check(case, damaged[number])
        if expected and case.profile in (1, 11) and damaged[number][case.offset + 1] & 15 == 15:
            expected = False  # the package does not check the counter, which is never 15
        if is_good != expected:
            yield f"check {case}, {damaged[number].hex()}: {is_good}, the package says {expected}"


def run(program: Path, frames: int, seed: int) -> tuple[Counter[int], list[str]]:
    """@return messages per profile, and the differences."""
    chance = random.Random(seed)
    counts: Counter[int] = Counter()
    differences: list[str] = []
    while counts.total() < frames:
        cases = [make_case(chance) for _ in range(min(BATCH, frames - counts.total()))]
        counts.update(case.profile for case in cases)
        differences += compare(program, cases, chance)
    return counts, differences


def main(argv: list[str] | None = None) -> int:
    """@return the exit status."""
    parser = argparse.ArgumentParser(prog="verification.e2e.differential", allow_abbrev=False,
                                     description="End-to-end protection beside the package autosar-e2e.")  # fmt: skip
    parser.add_argument("program", type=Path, help="the built mamori_e2e_pipe")
    parser.add_argument("--frames", type=int, default=10_000_000, metavar="N", help="frames over all profiles (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the random frames (default: %(default)s)")
    arguments = parser.parse_args(argv)
    if arguments.frames < 1:
        parser.error(f"--frames {arguments.frames}: give a number from 1 on")
    if not arguments.program.is_file():
        parser.error(f"{arguments.program} is missing; build the target mamori_e2e_pipe")
    begin = time.monotonic()
    counts, differences = run(arguments.program, arguments.frames, arguments.seed)
    for profile, count in sorted(counts.items()):
        print(f"profile {profile}: {count} frames")
    print(f"{counts.total()} frames, seed {arguments.seed}, {len(differences)} differences, {time.monotonic() - begin:.1f} s")
    for difference in differences[:DIFFERENCES_SHOWN]:
        print(difference, file=sys.stderr)
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
