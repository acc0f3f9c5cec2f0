# SPDX-License-Identifier: Apache-2.0
"""One seeded defect for each property of the brakes: a sequence that violates only that property.

@satisfies SWR-FSM-024      Design: docs/design/safe_state.md#properties-of-the-brakes
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from verification.safe_state.brakes.coupling import Pair
from verification.safe_state.brakes.relation import AT_BOUND, BEYOND, WITHIN
from verification.safe_state.brakes.sequence import HOLD, LOCKED_OUT, SS1, Brakes
from verification.safe_state.brakes.torque import BRAKES_FIRST, OTHER, fill
from verification.safe_state.defects import Defect


@dataclass(frozen=True)
class Kind:
    """A situation with and without contacts, after a cycle in which apply() was given `last` and returned `torque`."""

    last: str
    torque: bool

    def find(self, brakes: Brakes, is_fitted: bool) -> int:
        """@raise StopIteration if there is no such situation."""
        return next(number for number, memory in brakes.roads
                    if (memory.last, memory.torque, brakes.fitted[number]) == (self.last, self.torque, is_fitted))  # fmt: skip


OPEN = Kind("Operational", torque=True)
TOLD = Kind("Safe", torque=False)
HELD = Kind(HOLD, torque=True)
HANDING_OVER = Kind("Standby", torque=True)
ANY: Sequence[int] = (0, 1)


@dataclass(frozen=True)
class Where:
    """The cycles that a defect changes. None: all."""

    kinds: Sequence[Kind]
    after: str
    before: str | None = None
    standing: Sequence[int] = ANY
    contacts: Sequence[int] = ANY
    times: Sequence[int] = range(4)


def of_brakes(seed: Callable[[Brakes], Brakes]) -> Callable[[Pair], Pair]:
    return lambda pair: replace(pair, brakes=seed(pair.brakes), torque=fill(pair.torque))


def bend(where: Where, answers: Mapping[str, int], leads_to: Kind | None = None) -> Callable[[Pair], Pair]:
    """Brakes whose sequence returns `answers` in these cycles and then enters the situation of `leads_to`."""

    def seed(brakes: Brakes) -> Brakes:
        cycle = {name: array.copy() for name, array in brakes.cycle.items()}
        before = range(len(brakes.states)) if where.before is None else [brakes.states.index(where.before)]
        after = [brakes.states.index(where.after)]
        for kind in where.kinds:
            for is_fitted in (True, False):
                place = np.ix_([kind.find(brakes, is_fitted)], before, where.standing, where.contacts, after, where.times)
                for name, value in answers.items():
                    cycle[name][place] = value
                if leads_to is not None:
                    cycle["next"][place] = leads_to.find(brakes, is_fitted)
        return replace(brakes, cycle=cycle)

    return of_brakes(seed)


def keep_torque(is_kept: bool, state: str, *digits: Sequence[int]) -> Callable[[Pair], Pair]:
    """A safety cycle that keeps torque, or not, after a cycle in `state` with these digits of the letter (torque.py)."""

    def seed(pair: Pair) -> Pair:
        after = pair.torque.after.copy()
        after[np.ix_([pair.torque.states.index(state)], *digits)] = int(is_kept)
        return replace(pair, torque=replace(pair.torque, after=after))

    return seed


def close_in_safe(level: int, contacts: int, is_told_now: bool, times: Sequence[int]) -> Callable[[Pair], Pair]:
    """A sequence whose brakes count as closing, or not, after these cycles in the safe state."""

    def seed(brakes: Brakes) -> Brakes:
        closing = brakes.cycle["closing"].copy()
        for time in times:
            place = (..., contacts, brakes.states.index("Safe"), time)
            closing[place] = np.where(brakes.cycle["told_now"][place] == is_told_now, level, closing[place])
        return replace(brakes, cycle={**brakes.cycle, "closing": closing})

    return of_brakes(seed)


def confirm_nothing(brakes: Brakes) -> Brakes:
    confirmed = brakes.confirmed.copy()
    confirmed[:, brakes.states.index(SS1)] = 0
    return replace(brakes, confirmed=confirmed)


def notice_nothing_late(brakes: Brakes) -> Brakes:
    overdue = brakes.cycle["overdue"].copy()
    overdue[..., BEYOND] = 0
    return replace(brakes, cycle={**brakes.cycle, "overdue": overdue})


def list_open(brakes: Brakes) -> set[int]:
    """The situations that a cycle with open brakes can precede: a confirmation of an SS1 there is in the cycle of the command."""
    return {number for number, memory in brakes.roads if not memory.closed}


def trust_stuck_contacts(brakes: Brakes) -> Brakes:
    confirmed = brakes.confirmed.copy()
    numbers = sorted(number for number in list_open(brakes) if brakes.fitted[number])
    confirmed[np.ix_(numbers, [brakes.states.index(SS1)], [1], [1])] = 1
    return replace(brakes, confirmed=confirmed)


def ignore_contacts(brakes: Brakes) -> Brakes:
    confirmed = brakes.confirmed.copy()
    numbers = [number for number, fitted in enumerate(brakes.fitted) if fitted and number not in list_open(brakes)]
    confirmed[np.ix_(numbers, [brakes.states.index(SS1)], [1], [0])] = 1
    return replace(brakes, confirmed=confirmed)


BRAKE_DEFECTS: tuple[Defect[Pair], ...] = (
    Defect("brakes-closed-without-torque", "A moving machine that is locked out keeps its brakes open.",
                bend(Where((OPEN,), LOCKED_OUT), {"open": 1, "told_now": 0, "overdue": 0}, OPEN)),
    Defect("brakes-close-under-torque-in-ss1-only", "An SS1 closes its brakes while the machine still moves.",
                bend(Where((OPEN, HELD), SS1), {"open": 0, "told_now": 1}, TOLD)),
    Defect("ss1-holds-while-its-brakes-close", "An SS1 takes torque away once its brakes were told to close.",
                bend(Where((TOLD,), SS1), {"torque": 0})),
    Defect("ss1-confirmed-by-its-brakes", "Standstill alone confirms an SS1 after the command, with any report of the contacts.", of_brakes(ignore_contacts)),
    Defect("contacts-confirm-after-the-command-only", "A contact stuck at closed confirms an SS1 in the cycle of the command.",
                of_brakes(trust_stuck_contacts)),
    Defect("torque-outlives-the-hold-only", "A standby gets torque also after a self test.",
                bend(Where((TOLD,), "Standby", before="SelfTest", times=(WITHIN,)), {"torque": 1}, HANDING_OVER)),
    Defect("torque-outlives-the-hold-within-the-closing-time", "Torque outlives the hold up to and including the closing time.",
                bend(Where((HANDING_OVER,), "Standby", contacts=(0,), times=(AT_BOUND,)), {"torque": 1}, HANDING_OVER)),
    Defect("hold-is-handed-over-to-the-brakes", "Torque goes in the cycle in which the hold is left.",
                bend(Where((HELD,), "Standby"), {"torque": 0}, TOLD)),
    Defect("sto-waits-for-no-brakes", "An SS1 that ends in STO keeps torque for its brakes.",
                bend(Where((TOLD,), "Safe", before=SS1, contacts=(0,), times=(WITHIN,)), {"torque": 1})),
    Defect("brakes-open-by-a-start-only", "The brakes of an SS1 open again when the machine is pushed.",
                bend(Where((TOLD,), SS1, before=SS1, standing=(0,)), {"open": 1, "told_now": 0, "overdue": 0}, OPEN)),
    Defect("silent-brakes-are-overdue", "Only a clock that runs backwards makes brakes overdue.", of_brakes(notice_nothing_late)),
    Defect("brakes-end-stops", "No SS1 is ever confirmed.", of_brakes(confirm_nothing)),
    Defect("brakes-first-waits-for-the-brakes", "Torque ends in the cycle after that of the command.",
                close_in_safe(0, 0, is_told_now=False, times=(WITHIN,))),
    Defect("brakes-first-waits-for-stuck-contacts", "A contact stuck at closed ends the torque at once.",
                close_in_safe(0, 1, is_told_now=True, times=range(4))),
    Defect("brakes-first-ends-with-the-closing-time", "Torque is kept up to and including the closing time.",
                close_in_safe(1, 0, is_told_now=False, times=(AT_BOUND,))),
    Defect("another-sto-ends-torque-at-once", "A drive that is not trusted keeps its torque while the brakes close.",
                keep_torque(True, "Safe", (0,), (1,), (1,), (1,), (OTHER,))),
    Defect("cycle-keeps-torque-only", "Torque that was off is given while the brakes close.",
                keep_torque(True, "Safe", (0,), (1,), (0,), (1,), (BRAKES_FIRST,))),
)  # fmt: skip
