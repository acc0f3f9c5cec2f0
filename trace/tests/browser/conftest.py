# SPDX-License-Identifier: Apache-2.0
"""Pages in Chromium: of a small project and of one with 10,000 items. Without Chromium, every test here fails."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from large_project import make_large_project
from sample_records import COST, TIMING
from trace_sample import make_sample

from mamori_trace.checks import list_rule_ids
from mamori_trace.readers.project import read_project
from mamori_trace.reports.chromium import Chromium
from mamori_trace.reports.html import write_report

_COMPLAINTS = ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")


class Page:
    """One page in the browser: user actions, and the messages of the browser."""

    def __init__(self, browser: Chromium) -> None:
        self._browser = browser
        self._start = 0
        for domain in ("Page", "Runtime", "Log", "Network"):
            browser.call(f"{domain}.enable")

    def open(self, file: Path, fragment: str = "", width: int = 1280, scheme: str = "light") -> None:
        """Opens the file again."""
        self._browser.call("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        self._browser.call("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self._browser.open("about:blank")
        self._start = len(self._browser.events)
        self._browser.open(file.as_uri() + fragment)

    def allow_scripts(self, is_allowed: bool) -> None:
        """Takes effect for pages that are opened later."""
        self._browser.call("Emulation.setScriptExecutionDisabled", {"value": not is_allowed})

    def ask(self, expression: str) -> Any:
        """Value of a JavaScript expression."""
        return self._browser.evaluate(expression)

    def go(self, fragment: str) -> None:
        """Follows a link inside the page."""
        self.ask(f"new Promise(done => {{ addEventListener('hashchange', () => setTimeout(done), {{once: true}}); location.hash = {json.dumps(fragment)} }})")

    def press(self, key: str, modifiers: int = 0) -> None:
        """One key press."""
        text = {"Enter": "\r"}.get(key, key if len(key) == 1 else "")
        codes = {"Tab": 9, "Enter": 13, "Escape": 27, "ArrowUp": 38, "ArrowDown": 40}
        event = {"key": key, "modifiers": modifiers, "windowsVirtualKeyCode": codes.get(key, ord(key[0]))}
        self._browser.call("Input.dispatchKeyEvent", {"type": "keyDown", "text": text, **event})
        self._browser.call("Input.dispatchKeyEvent", {"type": "keyUp", **event})
        self.ask("new Promise(done => setTimeout(done))")

    def type(self, text: str) -> None:
        """Enters text into the focused field."""
        self._browser.call("Input.insertText", {"text": text})

    def list_complaints(self) -> list[str]:
        """Console messages since the page was opened."""
        return [json.dumps(event["params"])[:500] for event in self._browser.events[self._start :] if event.get("method") in _COMPLAINTS]

    def list_requests(self) -> list[str]:
        """Addresses requested since then, without data addresses."""
        events = (event for event in self._browser.events[self._start :] if event.get("method") == "Network.requestWillBeSent")
        return [url for event in events if not (url := event["params"]["request"]["url"]).startswith("data:")]


@pytest.fixture(scope="session")
def browser() -> Iterator[Chromium]:
    with Chromium() as running:
        yield running


@pytest.fixture
def page(browser: Chromium) -> Iterator[Page]:
    """A page; each test checks at its end that there were no console messages, requests and errors."""
    fresh = Page(browser)
    yield fresh
    fresh.allow_scripts(True)
    assert fresh.list_complaints() == []


@pytest.fixture(scope="session")
def small_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the sample project, with hostile texts, a draft and a failed test."""
    sample = make_sample(tmp_path_factory.mktemp("small") / "project")
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", "## SYS-003 <img src=x onerror=alert(1)></script>")
    sample.replace("build/host-release/evidence/junit/tools.xml", 'name="test_no_connection[b]" time="0.001">',
                   'name="test_no_connection[b]" time="0.001"><failure message="&lt;b&gt;no&lt;/b&gt;"/>')  # fmt: skip
    out = sample.root / "report" / "index.html"
    write_report(read_project(sample.root, None, list_rule_ids()), out)
    return out


@pytest.fixture(scope="session")
def full_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the sample project with a measured and a counted system, without declared worst cases."""
    sample = make_sample(tmp_path_factory.mktemp("full") / "project")
    for name, record in (("timing", TIMING), ("cost", COST)):
        path = sample.evidence / name / "safe_arm" / f"{name}.json"
        path.parent.mkdir(parents=True)
        path.write_text(json.dumps(record), encoding="utf-8")
    out = sample.root / "report" / "index.html"
    write_report(read_project(sample.root, None, list_rule_ids()), out)
    return out


@pytest.fixture(scope="session")
def large_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of 10,000 items and 6,000 results."""
    out = tmp_path_factory.mktemp("large") / "index.html"
    write_report(make_large_project(out.parent), out)
    return out
