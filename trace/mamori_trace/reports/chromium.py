# SPDX-License-Identifier: Apache-2.0
"""Controls Debian's Chromium without a window, through its own pipe, without a port, driver program or additional library.

@satisfies SWR-TRC-065      Design: docs/design/trace.md#pdf
"""

from __future__ import annotations

import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from typing import Any

from mamori_trace.base.errors import WorkError

_PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
_OPTIONS = (
    "--headless=new", "--remote-debugging-pipe", "--disable-gpu", "--disable-dev-shm-usage", "--disable-extensions", "--disable-sync",
    "--disable-background-networking", "--disable-component-update", "--disable-default-apps", "--no-first-run", "--mute-audio",
    "--host-resolver-rules=MAP * ~NOTFOUND",  # the report pages name no host, so name resolution is disabled
)  # fmt: skip
# The browser reads from descriptor 3 and writes to 4. A separate process moves them, because both may already be in use.
_PLACE_DESCRIPTORS = "import os, sys; os.dup2(int(sys.argv[1]), 3); os.dup2(int(sys.argv[2]), 4); os.execv(sys.argv[3], sys.argv[3:])"
_CHUNK_BYTES = 1 << 20
_HIGH_DESCRIPTOR = 20


class Chromium:
    """One browser with one empty page, which ends with the `with` block.

    `events` stores unrequested messages of the browser, in order.
    """

    def __init__(self, seconds_max: float = 60.0) -> None:
        self.events: list[dict[str, Any]] = []
        self._seconds_max = seconds_max
        self._last_id = 0
        self._session = ""
        self._buffer = b""

    def __enter__(self) -> Chromium:
        program = find_chromium()
        self._profile = tempfile.TemporaryDirectory(prefix="mamori-chromium-", ignore_cleanup_errors=True)
        to_read, self._writer = os.pipe()
        self._reader, to_write = os.pipe()
        # Duplicates both descriptors to numbers above those that the browser uses, so that moving one to its final number does not
        # overwrite the other.
        high = [fcntl.fcntl(end, fcntl.F_DUPFD, _HIGH_DESCRIPTOR) for end in (to_read, to_write)]
        command = [program, *_OPTIONS, f"--user-data-dir={self._profile.name}", "about:blank"]
        if os.geteuid() == 0:
            command.insert(1, "--no-sandbox")  # required for root
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-I", "-S", "-c", _PLACE_DESCRIPTORS, *map(str, high), *command],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, pass_fds=high, start_new_session=True,
            )  # fmt: skip
        finally:
            for end in (to_read, to_write, *high):
                os.close(end)
        try:
            target = self.call("Target.createTarget", {"url": "about:blank"})["targetId"]
            self._session = self.call("Target.attachToTarget", {"targetId": target, "flatten": True})["sessionId"]
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._writer)  # the browser ends when its pipe closes
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._reader)
        self._profile.cleanup()

    def call(self, method: str, parameters: Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Sends one command and waits for its reply. Raises WorkError."""
        self._last_id += 1
        message: dict[str, Any] = {"id": self._last_id, "method": method, "params": dict(parameters or {})}
        if self._session:
            message["sessionId"] = self._session
        self._send(json.dumps(message).encode() + b"\0")
        end_s = time.monotonic() + self._seconds_max
        while True:
            answer = self._receive(end_s)
            if answer.get("id") == self._last_id:
                if "error" in answer:
                    raise WorkError(f"chromium refused {method}: {answer['error'].get('message')}")
                return answer.get("result", {})
            self.events.append(answer)

    def open(self, url: str) -> None:
        """Opens `url` and waits until it is loaded."""
        self.call("Page.enable")
        seen = len(self.events)
        answer = self.call("Page.navigate", {"url": url})
        if answer.get("errorText"):
            raise WorkError(f"chromium cannot open {url}: {answer['errorText']}")
        self.wait_for("Page.loadEventFired", seen)

    def wait_for(self, name: str, start: int) -> None:
        """Waits for an event `name` in `events`, at or after index `start`."""
        end_s = time.monotonic() + self._seconds_max
        while not any(event.get("method") == name for event in self.events[start:]):
            self.events.append(self._receive(end_s))

    def evaluate(self, expression: str) -> Any:
        """Value of a JavaScript expression in the page; waits for promises. Raises WorkError."""
        answer = self.call("Runtime.evaluate", {"expression": expression, "returnByValue": True, "awaitPromise": True})
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise WorkError(details.get("exception", {}).get("description") or details.get("text"))
        return answer["result"].get("value")

    def _send(self, data: bytes) -> None:
        try:
            while data:
                data = data[os.write(self._writer, data) :]
        except BrokenPipeError as error:
            raise WorkError("chromium ended by itself") from error

    def _receive(self, end_s: float) -> dict[str, Any]:
        parts = [self._buffer]
        while b"\0" not in parts[-1]:
            ready, _, _ = select.select([self._reader], [], [], max(0.0, end_s - time.monotonic()))
            if not ready:
                self._buffer = b"".join(parts)
                raise WorkError(f"chromium did not answer within {self._seconds_max:g} s")
            parts.append(os.read(self._reader, _CHUNK_BYTES))
            if not parts[-1]:
                raise WorkError("chromium ended by itself")
        message, _, self._buffer = b"".join(parts).partition(b"\0")
        return json.loads(message)


def find_chromium() -> str:
    """Path of the browser. Raises WorkError if there is none."""
    for program in _PROGRAMS:
        if path := shutil.which(program):
            return path
    raise WorkError("no chromium here, which prints the page; install the Debian package chromium")
