# SPDX-License-Identifier: Apache-2.0
# Goal: residual errors and Hamming distances equal the published ones, only complete stored weights are accepted, and the figures for the
# compiler follow from them. Method: the published table; exhaustive trials of patterns; exact sums; damaged files.
from __future__ import annotations

import itertools
import json
import math
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest

from mamori_tools.e2e import facts, residual, spectra
from mamori_tools.e2e.residual import CRC8, CRC8_H2F, CRC16, CRC32, CRC32_P4, CRC64, Checksum, Distance, Spectrum

PE = ("1e-2", "1e-3", "1e-5")


def get_spectrum(checksum: Checksum, length: int) -> Spectrum:
    """@param length of the frame [bytes]."""
    return spectra.load(checksum, length) or residual.calc_spectrum(checksum, 8 * length)


@pytest.mark.verifies("SWR-E2E-020", technique="back_to_back")
@pytest.mark.parametrize(
    ("checksum", "length", "published", "distance"),
    [
        (CRC8, 8, ("1.22e-4", "1.89e-7", "1.98e-13"), (3, 198)),
        (CRC8, 30, ("1.70e-3", "7.54e-6", "8.98e-12"), (3, 8995)),
        (CRC8_H2F, 8, ("2.80e-5", "4.77e-9", "5.06e-17"), (4, 5066)),
        (CRC8_H2F, 16, ("4.82e-4", "7.13e-6", "7.99e-10"), (2, 8)),
        (CRC8_H2F, 32, ("2.42e-3", "1.07e-4", "1.37e-8"), (2, 137)),
        (CRC16, 16, ("1.67e-6", "4.97e-10", "5.61e-18"), (4, 562)),
        (CRC16, 32, ("5.31e-6", "4.20e-9", "5.38e-17"), (4, 5393)),
        (CRC16, 64, ("1.25e-5", "5.08e-8", "8.33e-16"), (4, 83713)),
        (CRC32_P4, 16, ("2.54e-14", "7.42e-22", "8.35e-38"), (8, 836)),
        (CRC32_P4, 32, ("1.69e-12", "1.48e-19", "1.89e-35"), (8, 189888)),
        (CRC32_P4, 64, ("8.78e-11", "4.29e-15", "7.04e-27"), (6, 7073)),
        (CRC32, 64, ("2.32e-10", "1.32e-13", "2.11e-23"), (5, 212)),
    ],
)
def test_published_table_comes_out(checksum: Checksum, length: int, published: tuple[str, ...], distance: tuple[int, int]) -> None:
    spectrum = get_spectrum(checksum, length)
    found = residual.find_distance(spectrum)

    assert found == Distance(*distance)
    assert [f"{residual.calc_residual(spectrum, found, Decimal(pe)):.2e}" for pe in PE] == list(published)


@pytest.mark.verifies("SWR-E2E-020", technique="back_to_back")
def test_checksum_of_64_bits_lets_no_pattern_of_up_to_6_bits_pass_in_32_bytes() -> None:
    assert residual.find_least_distance(CRC64, 256) == 8  # 7 is odd, and its polynomial has an even number of terms


@pytest.mark.verifies("SWR-E2E-020", technique="back_to_back")
@pytest.mark.parametrize(("checksum", "length"), [(CRC8, 8), (CRC8_H2F, 14), (CRC16, 6)])
def test_patterns_are_as_many_as_trying_them_finds(checksum: Checksum, length: int) -> None:
    syndromes = residual.calc_syndromes(checksum, 8 * length)
    counts = list(itertools.islice(residual.count_patterns(get_spectrum(checksum, length)), 5))

    for turned in range(1, 5 if length < 10 else 4):
        passing = sum(1 for some in itertools.combinations(syndromes, turned) if _add(some) == 0)
        assert counts[turned] == passing, turned


def _add(syndromes: tuple[int, ...]) -> int:
    total = 0
    for one in syndromes:
        total ^= one
    return total


@pytest.mark.verifies("SWR-E2E-020")
@pytest.mark.parametrize("pe", ["1e-30", "1e-9", "1e-5", "0.01", "0.3", "0.5"])
@pytest.mark.parametrize(("checksum", "length"), [(CRC8, 30), (CRC8_H2F, 32), (CRC16, 3), (CRC16, 64), (CRC32_P4, 12)])
def test_no_digit_is_lost_in_the_difference(checksum: Checksum, length: int, pe: str) -> None:
    spectrum = get_spectrum(checksum, length)

    result = residual.calc_residual(spectrum, residual.find_distance(spectrum), Decimal(pe))

    assert abs(result / residual.sum_patterns(spectrum, Decimal(pe)) - 1) < Decimal("1e-20")


@pytest.mark.verifies("SWR-E2E-020", technique="boundary_values")
def test_whole_range_of_weights_adds_up() -> None:
    spectrum = get_spectrum(CRC16, 5)

    assert sum(residual.count_patterns(spectrum)) == 2 ** (40 - 16)  # of 2^40 patterns, one in 2^16 passes
    assert residual.find_distance(get_spectrum(CRC8, 2)) == Distance(4, 3)
    with pytest.raises(ValueError, match="nothing passes"):
        residual.find_distance(residual.calc_spectrum(CRC8, 8))


@pytest.mark.verifies("SWR-E2E-020")
def test_bounds_hold() -> None:
    spectrum = get_spectrum(CRC16, 64)
    for pe in map(Decimal, PE):
        assert residual.calc_residual(spectrum, Distance(4, 83713), pe) <= residual.bound_residual(512, 4, pe) <= 1

    assert residual.find_least_distance(CRC64, 4096) == 6
    assert residual.find_least_distance(CRC64, 524_288) == 4
    assert residual.find_least_distance(CRC32_P4, 65_536) == 2  # its period is 65534 bits
    assert residual.find_least_distance(CRC32_P4, 4_194_304 * 8) == 2
    assert residual.find_least_distance(CRC32, 256) == 6  # exact, not only a lower bound: some patterns of six bits pass


@pytest.mark.verifies("SWR-E2E-020", technique="back_to_back")
def test_blocks_of_a_32_bit_checksum_are_the_weights_of_its_dual_words() -> None:
    """The first of the 65536 parts of the work, word by word."""
    bits = 96
    syndromes = residual.calc_syndromes(CRC32_P4, bits)
    share, values = next(residual.make_blocks(CRC32_P4, bits))

    assert share == residual.BATCH / 2**16
    for upper, lower in ((0, 0), (0, 1), (1, 0), (3, 40_000), (15, 65_535)):
        word = upper << 16 | lower
        ones = sum((word & one).bit_count() % 2 for one in syndromes)
        assert bits - 2 * ones == values[lower, upper]


@pytest.mark.verifies("SWR-E2E-020", technique="back_to_back")
@pytest.mark.parametrize(("length", "size"), [(12, 4), (16, 4), (48, 3)])
def test_least_patterns_of_a_32_bit_checksum_are_as_many_as_trying_them_finds(length: int, size: int) -> None:
    """Two equal sums of `size` bits are a pattern of the minimum weight, once for each division into two halves."""
    syndromes = np.array(residual.calc_syndromes(CRC32_P4, 8 * length), dtype=np.uint64)
    _, times = np.unique(residual._add_all(syndromes, size), return_counts=True)
    pairs = int((times * (times - 1) // 2).sum())

    halves = math.comb(2 * size, size) // 2
    assert residual.find_distance(get_spectrum(CRC32_P4, length)) == Distance(2 * size, pairs // halves)
    assert pairs % halves == 0


@pytest.mark.verifies("SWR-E2E-027", technique="requirements_based")
@pytest.mark.parametrize(("checksum", "length"), spectra.STORED)
def test_stored_weights_are_those_of_a_dual_code(checksum: Checksum, length: int) -> None:
    spectrum = spectra.load(checksum, length)

    assert spectrum is not None
    assert spectrum.bits == 8 * length


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of stored files that contains one file."""
    spectrum = get_spectrum(CRC32_P4, 16)
    monkeypatch.setattr(spectra, "FOLDER", tmp_path / "spectra")
    (tmp_path / "spectra").mkdir()
    spectra.store(spectrum)
    return tmp_path / "spectra"


@pytest.mark.verifies("SWR-E2E-027", technique="fault_injection", polarity="violation")
def test_damaged_file_is_refused(folder: Path) -> None:
    path = spectra.locate(CRC32_P4, 16)
    document = json.loads(path.read_text(encoding="utf-8"))
    counts = document["counts"]
    some = sorted(counts)[3]

    for damage in (
        json.dumps(document | {"counts": counts | {some: counts[some] + 1}}),
        json.dumps(document | {"bytes": 17}),
        json.dumps(document | {"counts": [1]}),
        json.dumps({"counts": counts}),
        path.read_text(encoding="utf-8")[:-20],
        "[]",
        "",
    ):
        path.write_text(damage, encoding="utf-8")
        with pytest.raises(ValueError, match=r"F4ACFB13_0016.json: damaged \(.*remove it and make it again"):
            spectra.load(CRC32_P4, 16)


@pytest.mark.verifies("SWR-E2E-027", technique="error_guessing", polarity="violation")
def test_wrong_counts_with_a_right_checksum_are_refused(folder: Path) -> None:
    good = spectra.load(CRC32_P4, 16)
    assert good is not None
    first, second = sorted(good.counts)[2:4]
    moved = good.counts | {first: good.counts[first] + 1, second: good.counts[second] - 1}

    for counts, complaint in ((moved, "no number of patterns"), (good.counts | {0: 2}, "there are not 2")):
        spectra.store(Spectrum(CRC32_P4, 128, counts))
        with pytest.raises(ValueError, match=complaint):
            spectra.load(CRC32_P4, 16)


@pytest.mark.verifies("SWR-E2E-027")
def test_only_missing_files_are_made(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    made: list[int] = []

    def calc(checksum: Checksum, bits: int) -> Spectrum:
        made.append(bits // 8)
        return Spectrum(checksum, bits, {0: 1})

    monkeypatch.setattr(spectra, "calc_spectrum", calc)
    monkeypatch.setattr(spectra, "STORED", ((CRC32_P4, 16), (CRC32_P4, 24)))

    assert spectra.load(CRC32_P4, 24) is None
    assert spectra.load(CRC32_P4, 20) is None
    assert spectra.main([]) == 0
    assert made == [24]
    assert spectra.main(["--again"]) == 0
    assert made == [24, 16, 24]
    assert sorted(path.name for path in folder.iterdir()) == ["F4ACFB13_0016.json", "F4ACFB13_0024.json"]
    assert "F4ACFB13_0024.json" in capsys.readouterr().out


@pytest.mark.verifies("SWR-E2E-023", technique="back_to_back")
def test_compiler_is_told_what_follows_from_the_weights() -> None:
    assert facts.HEADER.read_text(encoding="utf-8") == facts.make_header()


@pytest.mark.verifies("SWR-E2E-023", technique="back_to_back")
def test_no_weight_has_a_greater_share_than_the_compiler_is_told() -> None:
    for checksum, length in ((CRC16, 16), (CRC16, 32), (CRC32_P4, 16), (CRC32_P4, 64)):
        spectrum = get_spectrum(checksum, length)
        fact = facts.make_fact(spectrum)
        bits = spectrum.bits
        shares = [
            count * 2**checksum.width / math.comb(bits, turned) for turned, count in enumerate(residual.count_patterns(spectrum))
        ]

        assert fact.share - 2 < 100 * max(shares[fact.distance.bits + 1 :]) <= fact.share


@pytest.mark.verifies("SWR-E2E-023", technique="fault_injection", polarity="violation")
def test_facts_are_not_written_without_all_stored_files(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert facts.main(tmp_path / "facts.hpp") == 1
    assert "make the files first" in capsys.readouterr().err
    assert not (tmp_path / "facts.hpp").exists()
