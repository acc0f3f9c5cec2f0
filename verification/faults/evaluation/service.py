# SPDX-License-Identifier: Apache-2.0
"""Lost watchdog service: the outputs must close in time after each loss, and stay open while the watchdog is serviced in time.

Design: docs/design/posix_rt.md#lost-watchdog-service
"""

from __future__ import annotations

from typing import NamedTuple

from verification.faults.evaluation.course import Course
from verification.faults.evaluation.evaluator import Evaluation, Outcome, Result, Unexpected
from verification.faults.evaluation.host_causes import Spans
from verification.faults.evaluation.run_verdict import assess_run

LONG_STALL_NS = 500_000
"""A stall of at least this length can keep a service from its window. For a shorter stall, the closing is only suspected to be a host
effect."""


class Trial(NamedTuple):
    """A watchdog from its first service on, and at most one loss [ns]. The watchdog time starts during the last service."""

    loss: int
    is_injected: int
    injected_ns: int
    service_begin_ns: int
    service_end_ns: int
    is_closed: int
    closed_ns: int
    cause: int
    end_ns: int


def evaluate(course: Course) -> Result:
    """@raise WorkError if the course is not complete."""
    losses = course.get_names("losses")
    trials = course.get_rows("trials", Trial)
    evaluation = evaluate_trials(trials, losses, course.get_spans("stalls"), course.get_number("timeout_ns"), course.get_number("frame_ns"))
    requested = sum(losses[trial.loss] != "none" for trial in trials)
    finding = assess_run(evaluation.make_evidence(course.get_host(), course.get_number("frames"), requested))
    facts = {"requested": requested, **evaluation.to_json()}
    return Result(finding, facts, course.get_flag("has_priority"), {"outputs": finding})


def evaluate_trials(trials: list[Trial], losses: list[str], stalls: Spans, timeout_ns: int, frame_ns: int) -> Evaluation:
    evaluation = Evaluation()
    for trial in trials:
        kind = losses[trial.loss]
        if trial.is_closed and (not trial.is_injected or trial.closed_ns < trial.injected_ns):
            reason = _explain_closing(trial, stalls)
            evaluation.unexpected[reason] += 1
            is_explained = reason != Unexpected.FALSE
        elif trial.is_injected:
            # A service that comes too early is an immediate error. Otherwise this is the latest end of the watchdog time.
            due_ns = trial.injected_ns if kind == "runaway" else trial.service_end_ns + timeout_ns
            outcome = _find_outcome(trial, due_ns, kind == "runaway", stalls, timeout_ns, frame_ns)
            evaluation.add_outcome(kind, outcome)
            if trial.is_closed:
                evaluation.add_time("reaction", max(trial.closed_ns - due_ns, 0))
            is_explained = outcome not in (Outcome.NOT_DETECTED, Outcome.LATE)
        else:
            is_explained = True
        if not is_explained:
            evaluation.deviations.append({**trial._asdict(), "loss": kind})
    return evaluation


def _explain_closing(trial: Trial, stalls: Spans) -> Unexpected:
    """Outputs that closed without a loss."""
    if stalls.calc_longest_loss(trial.service_begin_ns, trial.closed_ns) >= LONG_STALL_NS:
        return Unexpected.BY_HOST
    return Unexpected.SUSPECTED if stalls.overlaps(trial.service_begin_ns, trial.closed_ns) else Unexpected.FALSE


def _find_outcome(trial: Trial, due_ns: int, is_at_once: bool, stalls: Spans, timeout_ns: int, frame_ns: int) -> Outcome:
    if not trial.is_closed:
        return Outcome.ENDED_BY_HOST if trial.end_ns - due_ns <= frame_ns else Outcome.NOT_DETECTED
    late_ns = trial.closed_ns - due_ns
    if not is_at_once and trial.closed_ns - trial.service_begin_ns <= timeout_ns:
        return Outcome.EARLY
    if late_ns <= frame_ns:
        return Outcome.IN_TIME
    if late_ns - stalls.calc_longest_loss(due_ns, trial.closed_ns) <= frame_ns:
        return Outcome.LATE_BY_HOST
    return Outcome.LATE_SUSPECTED if stalls.overlaps(due_ns, trial.closed_ns) else Outcome.LATE
