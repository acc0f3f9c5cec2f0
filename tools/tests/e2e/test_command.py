# SPDX-License-Identifier: Apache-2.0
# Goal: the command shows rate, distance and verdicts of a channel, states the method, and rejects an invalid channel.
# Method: the command with channels of the published table, both sides of each option limit, and a damaged stored file.
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.command.main import main
from mamori_tools.e2e import command, residual, spectra
from mamori_tools.host.project import ROOT

Capture = pytest.CaptureFixture[str]


def call(profile: str = "4", length: str = "16", rate: str = "1000", pe: str = "1e-2", *more: str) -> int:
    return main(["e2e", "--profile", profile, "--length", length, "--rate", rate, "--pe", pe, *more])


def ask(capsys: Capture, *words: str) -> dict[str, Any]:
    """The result as JSON."""
    call(*words, "--json")
    document: dict[str, Any] = json.loads(capsys.readouterr().out)
    return document


def get_verdicts(document: dict[str, Any]) -> list[str]:
    """Limits of SIL 1 to 4."""
    assert [row["sil"] for row in document["budgets"]] == [1, 2, 3, 4]
    return [row["verdict"] for row in document["budgets"]]


@pytest.mark.verifies("SWR-E2E-021", technique="back_to_back")
@pytest.mark.parametrize(
    ("profile", "length", "pe", "rate"),
    [
        ("1", "8", "1e-2", "4.4e+2"), ("11", "8", "1e-3", "6.8e-1"), ("2", "8", "1e-2", "1.0e+2"), ("22", "8", "1e-3", "1.7e-2"),
        ("5", "16", "1e-2", "6.0e+0"), ("6", "16", "1e-3", "1.8e-3"), ("5", "32", "1e-2", "1.9e+1"), ("6", "32", "1e-3", "1.5e-2"),
        ("4", "16", "1e-2", "9.1e-8"), ("44", "16", "1e-3", "2.7e-15"), ("4", "32", "1e-2", "6.1e-6"), ("44", "32", "1e-3", "5.3e-13"),
        ("4", "64", "1e-2", "3.2e-4"), ("8", "64", "1e-3", "1.5e-8"),
    ],
)  # fmt: skip
def test_rates_at_1_khz_are_the_published_ones(capsys: Capture, profile: str, length: str, pe: str, rate: str) -> None:
    document = ask(capsys, profile, length, "1000", pe)

    assert f"{document['residual_error_rate_per_hour']:.1e}".replace("e-0", "e-").replace("e+0", "e+") == rate
    assert (document["schema"], document["method"]) == ("mamori.e2e_residual/1", "exact")


@pytest.mark.verifies("SWR-E2E-021")
def test_text_tells_all_of_a_channel(capsys: Capture) -> None:
    assert call("P04", "16", "1000", "0.01", "--receivers", "3") == 1

    out, err = capsys.readouterr()
    assert err == ""
    assert "profile 4, 16 bytes (128 bits), CRC-32 P4" in out
    assert "2.54e-14 per frame, bit error probability 0.01" in out
    assert "2.74e-7 per hour, 1000 frames per second, 3 receivers" in out
    assert "8 bits; 836 patterns of so many bits pass" in out
    assert "exact: weights of all 2^32 dual words, stored" in out
    assert "SIL 1  1e-7             over, 2.7 times" in out


@pytest.mark.verifies("SWR-E2E-021", technique="boundary_values")
def test_each_level_has_its_budget(capsys: Capture) -> None:
    document = ask(capsys, "4", "16", "10", "0.01")  # 9.1e-10 per hour

    assert [row["budget_per_hour"] for row in document["budgets"]] == [1e-7, 1e-8, 1e-9, 1e-10]
    assert get_verdicts(document) == ["within", "within", "within", "over"]
    assert document["hamming_distance"] == {"bits": 8, "is_least": False, "patterns": 836}
    assert call("4", "16", "10", "0.01") == 0


@pytest.mark.verifies("SWR-E2E-021", technique="boundary_values", polarity="violation")
def test_channel_within_no_budget_ends_with_status_1(capsys: Capture) -> None:
    assert call("5", "32", "1000", "0.01") == 1
    capsys.readouterr()

    assert get_verdicts(ask(capsys, "5", "32", "1000", "0.01")) == ["over"] * 4
    assert call("5", "32", "1000", "1e-6") == 0


@pytest.mark.verifies("SWR-E2E-021", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("profile", ["2", "22"])
def test_list_profiles_above_14_bytes_are_refused_at_any_rate(capsys: Capture, profile: str) -> None:
    assert get_verdicts(ask(capsys, profile, "15", "1e-9", "1e-30")) == ["refused"] * 4
    assert get_verdicts(ask(capsys, profile, "14", "1e-9", "1e-30")) == ["not shown"] * 4
    assert call(profile, "15", "1e-9", "1e-30") == 1


@pytest.mark.verifies("SWR-E2E-026", technique="equivalence_classes")
def test_estimate_is_called_one(capsys: Capture) -> None:
    document = ask(capsys, "7", "32", "1000", "1e-2")

    assert document["method"] == "estimate"
    assert document["residual_error_per_frame"] == 2.0**-64
    assert document["hamming_distance"] == {"bits": 8, "is_least": True, "patterns": None}
    assert "the estimate is usual, no proved bound" in document["limits"]
    assert call("7", "32", "1000", "1e-2") == 0
    out = capsys.readouterr().out
    assert "about 5.42e-20" in out
    assert "8 or more" in out
    assert "within, if the estimate holds" in out


@pytest.mark.verifies("SWR-E2E-026", technique="equivalence_classes", polarity="violation")
def test_bound_over_a_budget_shows_nothing(capsys: Capture) -> None:
    document = ask(capsys, "8", "65536", "1", "1e-9")

    assert document["method"] == "bound"
    assert document["hamming_distance"] == {"bits": 2, "is_least": True, "patterns": None}
    assert get_verdicts(document) == ["not shown"] * 4
    assert get_verdicts(ask(capsys, "8", "65536", "1", "1e-20"))[0] == "within"


@pytest.mark.verifies("SWR-E2E-026", technique="error_guessing", polarity="violation")
def test_no_verdict_is_given_in_favour_of_a_list_that_is_not_known(capsys: Capture) -> None:
    document = ask(capsys, "2", "14", "1e-3", "1e-6")

    assert get_verdicts(document) == ["not shown"] * 4
    assert any("equal identifiers" in limit for limit in document["limits"])


@pytest.mark.verifies("SWR-E2E-026")
@pytest.mark.parametrize(("profile", "sentence"), [("8", "provisional"), ("1", "alternating"), ("4", "independently")])
def test_limits_of_a_profile_are_told(capsys: Capture, profile: str, sentence: str) -> None:
    assert any(sentence in limit for limit in ask(capsys, profile, "16", "1000", "1e-2")["limits"])


@pytest.mark.verifies("SWR-E2E-026")
def test_progress_is_for_terminals_only(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    stored = spectra.load(residual.CRC32_P4, 16)
    assert stored is not None
    told: list[bool] = []

    def calc(checksum: residual.Checksum, bits: int, tell: Any) -> residual.Spectrum:
        told.append(tell is not residual.NO_TELLING)
        tell(0.25)
        return stored

    monkeypatch.setattr(residual, "calc_spectrum", calc)
    call("4", "17")
    assert capsys.readouterr().err == ""

    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    call("4", "17")
    assert "25%" in capsys.readouterr().err
    assert told == [False, True]


@pytest.mark.verifies("SWR-E2E-025", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("3",), "argument --profile: there is no profile '3'; known: 1, 2, 4, 5, 6, 7, 8, 11, 22, 44"),
        (("444",), "there is no profile '444'; nearest: 44"),
        (("",), "there is no profile ''"),
        (("4", "11"), "argument --length: 11 bytes are less than the header; profile 4 takes 12 to 4096 bytes with its header"),
        (("4", "4097"), "argument --length: 4097 bytes are more than a frame may have"),
        (("1", "31"), "profile 1 takes 2 to 30 bytes"),
        (("7", "19"), "profile 7 takes 20 to 4194304 bytes"),
        (("4", "16.5"), "argument --length: '16.5' is not an integer of at least 1"),
        (("4", "9" * 5000), "is not an integer of at least 1"),
        (("4", "16", "0"), "argument --rate: 0 is out of range; give frames per second, from 1e-9 to 1e9"),
        (("4", "16", "1.1e9"), "argument --rate: 1.1e9 is out of range"),
        (("4", "16", "fast"), "argument --rate: 'fast' is no number; give frames per second"),
        (("4", "16", "inf"), "argument --rate: 'inf' is no number"),
        (("4", "16", "1", "0"), "argument --pe: 0 is out of range; give a bit error probability from 1e-30 to 0.5"),
        (("4", "16", "1", "0.51"), "argument --pe: 0.51 is out of range"),
        (("4", "16", "1", "0.9e-30"), "argument --pe: 0.9e-30 is out of range"),
        (("4", "16", "1", "nan"), "argument --pe: 'nan' is no number"),
        (("4", "16", "1", "1e-999999999999999999999"), "argument --pe: "),
        (("4", "16", "1", "0.1", "--receivers", "0"), "argument --receivers: '0' is not an integer of at least 1"),
        (("4", "16", "1", "0.1", "--receiver", "2"), "e2e has no option '--receiver'; nearest: --receivers"),
    ],
)
def test_wrong_words_end_with_one_line_and_status_2(capsys: Capture, words: tuple[str, ...], complaint: str) -> None:
    assert call(*words) == 2

    out, err = capsys.readouterr()
    assert complaint in err
    assert (err.count("\n"), out) == (1, "")


@pytest.mark.verifies("SWR-E2E-025", technique="boundary_values")
@pytest.mark.parametrize("words", [("4", "12", "1e9", "0.5"), ("04", "4096", "1e-9", "1e-30"), ("p1", "2"), ("7", "4194304")])
def test_ends_of_the_ranges_are_taken(capsys: Capture, words: tuple[str, ...]) -> None:
    assert call(*words) in (0, 1)
    assert capsys.readouterr().err == ""


@pytest.mark.verifies("SWR-E2E-025", polarity="violation")
def test_missing_option_is_named(capsys: Capture) -> None:
    assert main(["e2e", "--profile", "4"]) == 2
    assert "e2e: the following arguments are required: --length, --rate, --pe" in capsys.readouterr().err


@pytest.mark.verifies("SWR-E2E-025", technique="fault_injection", polarity="violation")
def test_damaged_file_is_told_with_status_2(capsys: Capture, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spectra, "FOLDER", tmp_path)
    (tmp_path / "F4ACFB13_0016.json").write_text("{}", encoding="utf-8")

    assert call() == 2
    out, err = capsys.readouterr()
    assert "F4ACFB13_0016.json: damaged" in err
    assert (err.count("\n"), out) == (1, "")


@pytest.mark.verifies("SWR-E2E-024", technique="back_to_back")
def test_budgets_of_the_command_and_of_the_compiler_are_the_same() -> None:
    header = (ROOT / "safety/include/mamori/safety/e2e/channel_budget.hpp").read_text(encoding="utf-8")
    for level, budget in command.BUDGETS.items():
        assert f"kSil{level}ChannelBudget = {str(budget).lower()};" in header
