# SPDX-License-Identifier: Apache-2.0
"""A Dask scheduler and workers as processes of this host, which a test may end by `kill -9`."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

START_S = 300.0


class Cluster:
    """Use as a context manager. `folder` receives the files of the cluster."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir()
        self._folder = folder
        self._processes: list[subprocess.Popen[bytes]] = []
        self.address = ""
        self.start_scheduler()

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._processes:
            process.kill()
            process.wait()

    def start_scheduler(self) -> None:
        file = self._folder / "scheduler.json"
        file.unlink(missing_ok=True)
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))
        deadline = time.monotonic() + START_S
        while not self.address and time.monotonic() < deadline:
            time.sleep(0.05)
            if file.exists() and file.read_text():
                self.address = json.loads(file.read_text())["address"]

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Starts a worker without a nanny: a killed worker is not restarted. Returns when the scheduler knows the worker."""
        from distributed import Client

        name = f"worker{len(self._processes)}"
        worker = self._start("worker", self.address, "--nthreads", "1", "--nworkers", "1", "--no-nanny", "--name", name,
                             "--local-directory", str(self._folder))  # fmt: skip
        deadline = time.monotonic() + START_S
        with Client(self.address) as client:
            while time.monotonic() < deadline:
                if name in (each["name"] for each in client.scheduler_info(n_workers=-1)["workers"].values()):
                    return worker
                time.sleep(0.05)
        raise TimeoutError(f"{name} did not start within {START_S:g} s")

    def kill(self, process: subprocess.Popen[bytes]) -> None:
        process.send_signal(signal.SIGKILL)
        process.wait()

    def _start(self, part: str, *options: str) -> subprocess.Popen[bytes]:
        words = [sys.executable, "-P", "-m", f"distributed.cli.dask_{part}", *options, "--no-dashboard"]
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._processes.append(process)
        return process
