# SPDX-License-Identifier: Apache-2.0
# Goal: the parser accepts exactly the notation, and an accepted text keeps its meaning in canonical form and in C++.
# Method: a table of texts; random constraints and random texts with a fixed seed; the C++ compiler compares each accepted row.
from __future__ import annotations

import random
import shutil
import struct
import subprocess
import tomllib
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from mamori_tools.profiles.constraint import Constraint, Range
from mamori_tools.profiles.constraint_parser import ConstraintError, Rule, parse_constraint
from mamori_tools.profiles.scalar_type import BOOL, DOUBLE, FLOAT, TYPES, ScalarType, Value, make_enumeration

MODE = make_enumeration("Mode", ("off", "slow", "fast"))
KNOWN = {**TYPES, "Mode": MODE}
ROWS = [tuple(row) for row in tomllib.loads((Path(__file__).parent / "constraint_cases.toml").read_text("utf-8"))["cases"]]
ACCEPTED = [(KNOWN[kind], count, text, result) for kind, count, text, verdict, result in ROWS if verdict == "ok"]
REJECTED = [(KNOWN[kind], count, text, Rule[verdict.upper()], place) for kind, count, text, verdict, place in ROWS if verdict != "ok"]
COMPILER = shutil.which("g++") or shutil.which("clang++-19")


def find_rejection(text: str, type_: ScalarType, count: int) -> ConstraintError | None:
    try:
        parse_constraint(text, type_, count)
    except ConstraintError as error:
        return error
    return None


@pytest.mark.verifies("SWR-PAR-001", technique="equivalence_classes")
@pytest.mark.parametrize(("type_", "count", "text", "canonical"), ACCEPTED)
def test_accepted_text_has_its_canonical_form_which_means_the_same(type_: ScalarType, count: int, text: str, canonical: str) -> None:
    constraint = parse_constraint(text, type_, count)

    assert constraint.format_canonical() == canonical
    assert parse_constraint(canonical, type_, count).format_canonical() == canonical
    assert parse_constraint(f" {text}\t", type_, count) == constraint


@pytest.mark.verifies("SWR-PAR-001", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("type_", "count", "text", "rule", "place"), REJECTED)
def test_rejected_text_names_the_rule_and_the_first_wrong_character(type_: ScalarType, count: int, text: str, rule: Rule, place: int) -> None:
    error = find_rejection(text, type_, count)

    assert error is not None
    assert (error.rule, error.position) == (rule, place)
    assert str(error) == f"{rule.value} (column {place + 1})"


@pytest.mark.verifies("SWR-PAR-001", technique="interface", polarity="violation")
def test_every_rule_has_a_case() -> None:
    assert {rule for _, _, _, rule, _ in REJECTED} == set(Rule)


def make_value(source: random.Random, type_: ScalarType) -> Value:
    if not type_.is_real:
        return source.choice([source.randint(type_.lowest, type_.maximum), type_.lowest, type_.maximum])
    while True:
        text = f"{source.choice(['', '-'])}{source.randrange(10 ** source.randint(1, 20))}e{source.randint(-60, 30)}"
        value = type_.read(text)
        if value is not None:
            return value


def make_item(source: random.Random, type_: ScalarType) -> tuple[Range, ...]:
    kind = source.randrange(4)
    if kind == 0:
        return (Range(),)
    if kind == 1:
        values = dict.fromkeys(make_value(source, type_) for _ in range(source.randint(1, 4)))
        return tuple(Range(value, value) for value in values)
    lower, upper = sorted((make_value(source, type_), make_value(source, type_)))
    if kind == 2:
        return (source.choice([Range(lower), Range(None, lower)]),)
    return (Range(lower, upper, False, lower != upper and source.random() < 0.5),)


@pytest.mark.verifies("SWR-PAR-001", technique="back_to_back")
def test_random_constraint_is_restored_from_its_canonical_form() -> None:
    source = random.Random(20240229)
    for _ in range(3000):
        type_ = source.choice(list(KNOWN.values()))
        count = source.randint(1, 4)
        items = tuple(make_item(source, type_) for _ in range(source.choice([1, count])))
        constraint = Constraint(type_, items)
        text = constraint.format_canonical()
        assert parse_constraint(text, type_, count) == constraint, (type_.name, text)


@pytest.mark.verifies("SWR-PAR-001", technique="error_guessing", polarity="violation")
def test_random_text_is_rejected_inside_the_text_or_means_its_canonical_form() -> None:
    source = random.Random(20240301)
    accepted = 0
    texts = [text for _, _, text, *_ in ROWS]
    for _ in range(20000):
        type_, count = source.choice(list(KNOWN.values())), source.randint(1, 4)
        letters = list(source.choice(texts))
        for _ in range(source.randint(0, 3)):
            letters.insert(source.randint(0, len(letters)), source.choice("x<>=(){}:,.-+eE019 \ttrue"))
        if letters and source.random() < 0.5:
            del letters[source.randrange(len(letters))]
        text = "".join(letters)
        error = find_rejection(text, type_, count)
        padded = find_rejection(f" {text} ", type_, count)
        assert (error and error.rule) == (padded and padded.rule), text
        if error is not None:
            assert 0 <= error.position <= len(text), text
            continue
        accepted += 1
        canonical = parse_constraint(text, type_, count).format_canonical()
        assert parse_constraint(canonical, type_, count).format_canonical() == canonical, text
    assert accepted > 1000


@pytest.mark.verifies("SWR-PAR-001", technique="back_to_back")
def test_single_precision_value_is_the_nearest_one() -> None:
    source = random.Random(20240302)
    for _ in range(1500):
        nearest = struct.unpack("<f", struct.pack("<I", source.randrange(1, 0x7F7FFFFF)))[0]
        next_up = struct.unpack("<f", struct.pack("<I", struct.unpack("<I", struct.pack("<f", nearest))[0] + 1))[0]
        middle = (Fraction(nearest) + Fraction(next_up)) / 2
        exact = Decimal(middle.numerator)  # the denominator is a power of two
        for _ in range(middle.denominator.bit_length() - 1):
            exact = _divide_exactly(exact)
        digits = f"{exact:e}"
        is_even = struct.unpack("<I", struct.pack("<f", nearest))[0] % 2 == 0
        assert FLOAT.read(digits) == (nearest if is_even else next_up), digits
        mantissa, exponent = digits.split("e")
        above = f"{mantissa}{'' if '.' in mantissa else '.'}0001e{exponent}"
        assert FLOAT.read(above) == next_up, above


def _divide_exactly(number: Decimal) -> Decimal:
    sign, digits, exponent = number.as_tuple()
    assert isinstance(exponent, int)
    half = int("".join(map(str, digits))) * 5
    return Decimal((sign, tuple(map(int, str(half))), exponent - 1))


def make_comparison(constraint: Constraint, count: int, index: int) -> str:
    """C++ that compares the ranges of the typed constraint with those of the text."""
    name, type_ = constraint.type.name, constraint.type
    ranges = [(element if len(constraint.items) > 1 else None, only)
              for element, item in enumerate(constraint.items) for only in item]  # fmt: skip
    lines = [f"constexpr auto kC{index} = mamori::make_constraint<{name}, {len(ranges)}U, {count}U>({constraint.format_cpp()});",
             f"static_assert(kC{index}.get_ranges().size() == {len(ranges)}U);"]  # fmt: skip
    for place, (element, only) in enumerate(ranges):
        lower, upper = (_make_number(type_, value) for value in (only.lower, only.upper))
        limits = [f"r.lower == {lower or f'mamori::Range<{name}>::kLowest'}", f"r.upper == {upper or f'mamori::Range<{name}>::kMax'}",
                  f"r.is_lower_open == {str(only.is_lower_open).lower()}", f"r.is_upper_open == {str(only.is_upper_open).lower()}",
                  f"r.element == {f'mamori::Range<{name}>::kEachElement' if element is None else element}"]  # fmt: skip
        lines.append(f"static_assert([](const auto& r) {{ return {' && '.join(limits)}; }}(kC{index}.get_ranges()[{place}]));")
    return "\n".join(lines)


def _make_number(type_: ScalarType, value: Value | None) -> str:
    """The value in C++, independent of the decimal number in the constraint: real values are hexadecimal."""
    if value is None:
        return ""
    if type_.is_real:
        return f"{type_.name}({float(value).hex()})"
    sign = "-1 - " if value < 0 else ""
    return f"static_cast<{type_.name}>({sign}{-1 - int(value) if value < 0 else int(value)}{'' if value < 2**63 else 'ULL'})"


@pytest.mark.skipif(COMPILER is None, reason="needs a C++ compiler")
@pytest.mark.verifies("SWR-PAR-010", technique="back_to_back")
def test_compiler_reads_the_typed_constraint_as_the_same_ranges(tmp_path: Path) -> None:
    assert COMPILER is not None
    comparisons = [make_comparison(parse_constraint(text, type_, count), count, index)
                   for index, (type_, count, text, _) in enumerate(ACCEPTED)]  # fmt: skip
    source = tmp_path / "constraints.cpp"
    source.write_text('#include "mamori/kernel/parameter/constraint.hpp"\nenum class Mode : unsigned char { kOff, kSlow, kFast };\n'
                      + "\n".join(comparisons), encoding="utf-8")  # fmt: skip
    words = [COMPILER, "-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", f"-I{ROOT / 'kernel/include'}", str(source)]
    result = subprocess.run(words, capture_output=True, text=True, check=False)

    assert result.returncode == 0, result.stderr


@pytest.mark.verifies("SWR-PAR-010", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("type_", "count", "text", "cpp"),
    [(DOUBLE, 1, "0.1<=x<=3.0", "mamori::between(0.1, 3.0)"), (FLOAT, 1, "x>=0.1", "mamori::at_least(0.1F)"), (DOUBLE, 1, "x<2", "mamori::below(2.0)"),
     (DOUBLE, 1, "0<x<=2", "mamori::between(mamori::above(0.0), mamori::at_most(2.0))"), (BOOL, 1, "1", "mamori::one_of(true)"),
     (DOUBLE, 1, "", "mamori::any_value()"), (MODE, 2, "(slow,fast),x<=1", "mamori::one_of(Mode::kSlow, Mode::kFast), mamori::at_most(Mode::kSlow)"),
     (TYPES["std::int64_t"], 1, "x>-9223372036854775808", "mamori::above((-9223372036854775807LL - 1))"),
     (TYPES["std::uint64_t"], 1, "18446744073709551615", "mamori::one_of(18446744073709551615ULL)"),
     (make_enumeration("a::B", ("very_slow", "x1")), 1, "(very_slow)", "mamori::one_of(a::B::kVerySlow)")])  # fmt: skip
def test_typed_constraint_is_written_as_in_a_declaration(type_: ScalarType, count: int, text: str, cpp: str) -> None:
    assert parse_constraint(text, type_, count).format_cpp() == cpp
