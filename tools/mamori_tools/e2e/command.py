# SPDX-License-Identifier: Apache-2.0
"""`./mamori e2e`: the residual error of a channel, compared with the limits of the safety integrity levels.

@satisfies SWR-E2E-021, SWR-E2E-025, SWR-E2E-026      Design: docs/design/e2e.md#residual-error
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation

from mamori_tools.e2e import residual, spectra
from mamori_tools.e2e.residual import CRC8_H2F, PROFILES, Profile, Spectrum
from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

SCHEMA = "mamori.e2e_residual/1"
SECONDS_PER_HOUR = 3600
# Per hour: 1 % of the upper limit of each safety integrity level.
BUDGETS = {1: Decimal("1e-7"), 2: Decimal("1e-8"), 3: Decimal("1e-9"), 4: Decimal("1e-10")}
PE_LEAST, PE_MOST = Decimal("1e-30"), Decimal("0.5")
RATE_LEAST, RATE_MOST = Decimal("1e-9"), Decimal("1e9")
DIGITS_MOST = 12  # digits of a count
LIST_LENGTH_MAX = 14  # bytes: in longer messages, profiles 2 and 22 miss some patterns of two flipped bits
EXACT_LENGTH_MAX = 65_535  # bytes: for longer messages there is only a bound
WIDTH_COUNTED = 32  # bits: wider checksums have too many dual words
EXACT, ESTIMATE, BOUND = "exact", "estimate", "bound"
WITHIN, OVER, NOT_SHOWN, REFUSED = "within", "over", "not shown", "refused"


@dataclass(frozen=True)
class Channel:
    """The requested channel. Length in bytes with the header, rate in messages per second."""

    profile: Profile
    length: int
    rate_hz: Decimal
    pe: Decimal
    receivers: int


@dataclass(frozen=True)
class Answer:
    """The calculated figures. Without a number of patterns, the Hamming distance is a lower bound."""

    channel: Channel
    method: str
    how: str
    limits: tuple[str, ...]
    residual: Decimal
    distance: int
    patterns: int | None

    @property
    def rate(self) -> Decimal:
        """Undetected damaged messages [1/h]."""
        return self.residual * self.channel.rate_hz * SECONDS_PER_HOUR * self.channel.receivers

    def judge(self, budget: Decimal) -> str:
        """Whether the limit [1/h] is met. A bound above the limit proves nothing."""
        if self.channel.profile.checksum is CRC8_H2F and self.channel.length > LIST_LENGTH_MAX:
            return REFUSED
        if self.rate > budget:
            return NOT_SHOWN if self.method == BOUND else OVER
        return NOT_SHOWN if self.channel.profile.checksum is CRC8_H2F else WITHIN

    @property
    def status(self) -> int:
        """Exit status: 1 if no limit is met."""
        return EXIT_OK if any(self.judge(budget) == WITHIN for budget in BUDGETS.values()) else EXIT_FAILED


def run(arguments: argparse.Namespace) -> int:
    """@return exit status: 0, 1 (no limit is met). @raise InputError."""
    answer = answer_channel(check(arguments))
    print(make_json(answer) if arguments.json else make_text(answer))
    return answer.status


def check(arguments: argparse.Namespace) -> Channel:
    """@raise InputError with the option, the error and the valid values."""
    number = arguments.profile.strip().lower().removeprefix("p").lstrip("0")
    known = [str(profile) for profile in PROFILES]
    if number not in known:
        raise InputError(f"e2e: argument --profile: there is no profile '{arguments.profile}'; {nearest_names(number, known)}")
    profile = PROFILES[int(number)]
    length = _read_count(arguments.length, "--length")
    if not profile.length_min <= length <= profile.length_max:
        what = "are less than the header" if length < profile.length_min else "are more than a frame may have"
        raise InputError(f"e2e: argument --length: {length} bytes {what}; "
                         f"profile {number} takes {profile.length_min} to {profile.length_max} bytes with its header")  # fmt: skip
    rate = _read_number(arguments.rate, "--rate", "frames per second, from 1e-9 to 1e9")
    if not RATE_LEAST <= rate <= RATE_MOST:
        raise InputError(f"e2e: argument --rate: {arguments.rate} is out of range; give frames per second, from 1e-9 to 1e9")
    pe = _read_number(arguments.pe, "--pe", "a bit error probability from 1e-30 to 0.5")
    if not PE_LEAST <= pe <= PE_MOST:
        raise InputError(f"e2e: argument --pe: {arguments.pe} is out of range; give a bit error probability from 1e-30 to 0.5")
    return Channel(profile, length, rate, pe, _read_count(arguments.receivers, "--receivers"))


def _read_count(text: str, option: str) -> int:
    if not (text.isascii() and text.isdecimal()) or len(text) > DIGITS_MOST or int(text) < 1:
        raise InputError(f"e2e: argument {option}: '{text}' is not an integer of at least 1, with at most {DIGITS_MOST} digits")
    return int(text)


def _read_number(text: str, option: str, wanted: str) -> Decimal:
    """The exact value of the text; infinity and not-a-number are rejected."""
    try:
        number = Decimal(text)
    except InvalidOperation:
        number = Decimal("nan")
    if not number.is_finite():
        raise InputError(f"e2e: argument {option}: '{text}' is no number; give {wanted}")
    return number


def answer_channel(channel: Channel) -> Answer:
    """The best result that is available within about a minute. @raise InputError if a stored file is damaged."""
    checksum, bits = channel.profile.checksum, 8 * channel.length
    limits = _list_limits(channel)
    if checksum.width > WIDTH_COUNTED:
        least = residual.find_least_distance(checksum, bits)
        how = f"2^-{checksum.width}: each wrong remainder taken for as likely as any other"
        estimate = Decimal(1) / (1 << checksum.width)
        return Answer(channel, ESTIMATE, how, ("the estimate is usual, no proved bound", *limits), estimate, least, None)
    if channel.length > EXACT_LENGTH_MAX:
        least = residual.find_least_distance(checksum, bits)
        how = f"every pattern of {least} or more bits is taken to pass"
        left_out = f"frames above {EXACT_LENGTH_MAX} bytes are not calculated exactly"
        return Answer(channel, BOUND, how, (left_out, *limits), residual.bound_residual(bits, least, channel.pe), least, None)
    spectrum, source = _get_spectrum(channel)
    distance = residual.find_distance(spectrum)
    how = f"weights of all 2^{checksum.width} dual words, {source}"
    exact = residual.calc_residual(spectrum, distance, channel.pe)
    return Answer(channel, EXACT, how, limits, exact, distance.bits, distance.patterns)


def _get_spectrum(channel: Channel) -> tuple[Spectrum, str]:
    checksum = channel.profile.checksum
    try:
        stored = spectra.load(checksum, channel.length)
    except ValueError as error:
        raise InputError(f"e2e: {error}") from error
    if stored is not None:
        return stored, "stored"
    is_seen = sys.stderr.isatty() and checksum.width > 16
    calculated = residual.calc_spectrum(checksum, 8 * channel.length, _show_share if is_seen else residual.NO_TELLING)
    if is_seen:
        print("\r\033[K", end="", file=sys.stderr, flush=True)
    return calculated, "calculated now"


def _show_share(share: float) -> None:
    print(f"\rmamori: calculating 2^32 dual words, {share:.0%} ", end="", file=sys.stderr, flush=True)


def _list_limits(channel: Channel) -> tuple[str, ...]:
    """Effects that the figures do not include."""
    limits = ["bits are taken to be turned independently of each other; a stuck line and bursts are other questions",
              "what a receiver compares beside the checksum (length, identifier, counter) is not counted in favour"]  # fmt: skip
    number, checksum = channel.profile.number, channel.profile.checksum
    if checksum is CRC8_H2F:
        limits.append(
            "for a list of equal identifiers; with others a turned bit of the counter picks another one, which can let two turned bits "
            "pass at any length: is_within_budget() calculates the list of a channel"
        )
    if checksum is CRC8_H2F and channel.length > LIST_LENGTH_MAX:
        limits.append(f"above {LIST_LENGTH_MAX} bytes two turned bits pass with any list: refused for every budget")
    if number == 1:
        limits.append(
            "not for the alternating identifiers, where a turned bit of the counter picks the other byte: is_within_budget() "
            "calculates them"
        )
    if number == 8:
        limits.append("profile 8 is provisional: its layout has no second implementation to compare with")
    return tuple(limits)


def make_text(answer: Answer) -> str:
    """Output as text."""
    channel = answer.channel
    patterns = (
        "or more; patterns not counted" if answer.patterns is None else f"bits; {answer.patterns} patterns of so many bits pass"
    )
    sign = {EXACT: "", ESTIMATE: "about ", BOUND: "at most "}[answer.method]
    receivers = "1 receiver" if channel.receivers == 1 else f"{channel.receivers} receivers"
    lines = [
        f"profile {channel.profile.number}, {channel.length} bytes ({8 * channel.length} bits), {channel.profile.checksum.name}",
        f"  residual error    {sign}{answer.residual:.2e} per frame, bit error probability {channel.pe}",
        f"  rate              {sign}{answer.rate:.2e} per hour, {channel.rate_hz} frames per second, {receivers}",
        f"  Hamming distance  {answer.distance} {patterns}",
        f"  method            {answer.method}: {answer.how}",
        "",
        "  level  budget per hour  verdict",
    ]
    for level, budget in BUDGETS.items():
        verdict = answer.judge(budget)
        if verdict == OVER:
            verdict += f", {answer.rate / budget:.2g} times"
        elif verdict == WITHIN and answer.method == ESTIMATE:
            verdict += ", if the estimate holds"
        lines.append(f"  SIL {level}  {f'{budget:.0e}':<15}  {verdict}")
    return "\n".join([*lines, "", *(f"  limit: {limit}" for limit in answer.limits)])


def make_json(answer: Answer) -> str:
    """The same output for programs. Numbers other than counts have 17 digits."""
    channel = answer.channel
    document = {
        "schema": SCHEMA,
        "profile": channel.profile.number,
        "checksum": channel.profile.checksum.name,
        "length_bytes": channel.length,
        "rate_hz": float(channel.rate_hz),
        "bit_error_probability": float(channel.pe),
        "receivers": channel.receivers,
        "residual_error_per_frame": float(answer.residual),
        "residual_error_rate_per_hour": float(answer.rate),
        "hamming_distance": {"bits": answer.distance, "is_least": answer.patterns is None, "patterns": answer.patterns},
        "method": answer.method,
        "how": answer.how,
        "limits": list(answer.limits),
        "budgets": [
            {"sil": level, "budget_per_hour": float(budget), "verdict": answer.judge(budget)} for level, budget in BUDGETS.items()
        ],
    }
    return json.dumps(document, indent=2)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    names = [str(profile) for profile in PROFILES]
    for option, text in (("--profile", f"{', '.join(names[:-1])} or {names[-1]}"), ("--length", "length of the message with its header, in bytes"),
                         ("--rate", "messages per second, from 1e-9 to 1e9"),
                         ("--pe", "bit error probability of the channel, from 1e-30 to 0.5; use 0.01 unless a lower value is justified")):  # fmt: skip
        parser.add_argument(option, required=True, metavar={"--length": "BYTES", "--rate": "HZ"}.get(option, "P"), help=text)
    parser.add_argument("--receivers", default="1", metavar="M",
                        help="number of receivers that depend on the messages (at least 1); default: %(default)s")  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")


COMMAND = Command(
    add_arguments, run, "residual error probability and rate of an E2E-protected channel",
    "Calculates residual error probability, residual error rate per hour and Hamming distance of an E2E-protected channel. Compares the rate with "
    "1 % of the limit of each SIL. Values that are not precomputed take about one minute.",
    {0: "within the budget of a SIL", 1: "above the budget of every SIL"},
    examples=("e2e --profile 4 --length 64 --rate 1000 --pe 0.01",))  # fmt: skip
