# SPDX-License-Identifier: Apache-2.0
# Goal: the examples and lists of the manual page are those of the command.
from __future__ import annotations

import re
from pathlib import Path

import pytest
from profile_samples import RTC_03, RTS_02

from mamori_tools.command.main import main
from mamori_tools.profiles.deviation import DEVIATIONS, NOTES
from mamori_tools.profiles.packages import KEYS

PAGE = (Path(__file__).resolve().parents[3] / "docs/manual/profiles.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```text\n\./mamori profile ([^\n]*)\n(.*?)```", PAGE, re.DOTALL)
FILES = {
    "motor/RTC.xml": RTC_03, "camera.xml": RTC_03.replace('"Provided"', '"PROVIDED"').replace("Motor", "Camera"), "RTS.xml": RTS_02,
    "sensor/RTC.xml": RTC_03.replace("Motor", "Sensor").replace("RTC::TimedDouble", "RTC::TimedLong").replace("C++", "Python"),
    "new/RTC.xml": RTC_03.replace('category="test" rtc:version="1.0.0"', 'category="test" rtc:version="1.1.0"').replace('rtc:unit="1" ', ""),
}  # fmt: skip


@pytest.mark.verifies("SWR-PFL-003")
@pytest.mark.parametrize(("words", "output"), EXAMPLES)
def test_an_example_of_the_manual_has_this_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: str, output: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        if not words.startswith("find") or name not in ("new/RTC.xml", "camera.xml"):
            Path(name).parent.mkdir(exist_ok=True)
            Path(name).write_text(text, encoding="utf-8")

    main(["profile", *words.split()])

    shown = capsys.readouterr()
    assert shown.out + shown.err == output


@pytest.mark.verifies("SWR-PFL-005")
def test_the_manual_names_each_deviation_note_and_key() -> None:
    assert re.findall(r"D\d\d(?=[, |].*\|)", PAGE) == list(DEVIATIONS)
    assert re.findall(r"^\| (N\d\d) \|", PAGE, re.MULTILINE) == list(NOTES)
    assert [f"`{key}`" in PAGE for key in KEYS] == [True] * len(KEYS)
    assert len(EXAMPLES) == 8
