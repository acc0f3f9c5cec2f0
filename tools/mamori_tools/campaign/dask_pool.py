# SPDX-License-Identifier: Apache-2.0
"""Runs the cases on the workers of a Dask cluster. Only the client stores results.

A worker needs these tools and the program under test, at the same path and with the same content. Input files are sent to the worker with
the case. The result contains the files of the run, so no shared folder is needed.

@satisfies SWR-CMP-010, SWR-CMP-011      Design: docs/design/simulation.md#campaign-on-dask
"""

from __future__ import annotations

import contextlib
import logging
import signal
import socket
import tempfile
import time
import uuid
from collections.abc import Generator, Mapping, Sequence
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any

from mamori_tools.campaign.work import Outcome, Work, check_program, run_local
from mamori_trace.base.errors import InputError, MissingError, WorkError

LOCAL = "local"
CONNECT_S = 10.0
"""Time limit for the reply of a scheduler [s]."""

NO_WORKER_S = 30.0
"""Time without any worker after which the campaign ends [s]; a killed worker is restarted within seconds."""

FILE_BYTES_MAX = 64_000_000
"""Maximum size of all returned files of one case [bytes]; a case of the example arm has about 1,000,000."""

_POLL_S = 0.5
_TASKS_PER_WORKER = 2  # one running and one waiting task

Files = Mapping[str, bytes]
"""Path relative to the folder of a case -> content."""


def run_on_dask(works: Sequence[Work], inputs: Files, root: Path, address: str, workers: int, at_once_max: int | None) -> Generator[Outcome]:
    """Yields each run once its files are in `root / work.folder`. `workers` applies to the address `local`.

    Raises MissingError without the package, InputError if the scheduler does not reply, WorkError if a worker cannot run the program or the
    cluster is lost.
    """
    try:
        import distributed
    except ImportError:
        raise MissingError("--dask needs the package dask[distributed]; install it by: .venv/bin/python -m pip install 'mamori[dask]'") from None
    with contextlib.ExitStack() as stack:
        # Logging is off, because each failure is reported in one line of this command.
        stack.callback(logging.disable, logging.root.manager.disable)
        logging.disable(logging.CRITICAL)
        client = _connect(distributed, stack, address, workers)
        slots = sum(worker["nthreads"] for worker in _list_workers(client))
        if not slots:
            raise InputError(f"--dask {address}: the scheduler has no worker; start one by: dask worker {address}")
        waiting = list(works)[::-1]
        running: dict[Any, Work] = {}
        at_once = min(at_once_max or len(works), _TASKS_PER_WORKER * slots)
        while waiting or running:
            while waiting and len(running) < at_once:
                work = waiting.pop()
                # A unique key: the scheduler must not return the result of an earlier campaign.
                running[client.submit(run_on_worker, work, dict(inputs), key=f"{work.case}-{uuid.uuid4().hex}", pure=False)] = work
            for future in _take_finished(distributed, client, list(running), address):
                outcome, files = _get_result(future, address)
                work = running.pop(future)
                future.release()
                _write_files(root / work.folder, files)
                yield outcome


def run_on_worker(work: Work, inputs: Files) -> tuple[Outcome, Files]:
    """Runs one case in a temporary folder of the worker. Raises WorkError with the name of the worker."""
    try:
        with tempfile.TemporaryDirectory(prefix="mamori-") as name:
            root = Path(name)
            for file, content in inputs.items():
                (root / file).write_bytes(content)
            check_program(work.program)
            [outcome] = run_local([work], root, 1)
            return outcome, _read_files(root / work.folder, work.case)
    except (InputError, WorkError, OSError) as error:
        raise WorkError(f"worker {_get_worker_name()}: {error}") from None


def _read_files(folder: Path, case: str) -> dict[str, bytes]:
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file() and not path.is_symlink()]
    size = sum(path.stat().st_size for path in paths)
    if size > FILE_BYTES_MAX:
        raise WorkError(f"{case}: the program wrote {size} bytes, at most {FILE_BYTES_MAX} are sent back; run the campaign without --dask")
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def _write_files(folder: Path, files: Files) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def _get_worker_name() -> str:
    from distributed import get_worker

    with contextlib.suppress(ValueError):  # not on a worker
        return f"{get_worker().address} on {socket.gethostname()}"
    return socket.gethostname()


def _connect(distributed: Any, stack: contextlib.ExitStack, address: str, workers: int) -> Any:
    if address == LOCAL:
        resource_tracker.ensure_running()  # started here, because its start would unblock the signal in the thread that starts the workers
        # The threads of the cluster and its workers inherit the mask, so Ctrl-C reaches only the main thread of this process.
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0",
                                               silence_logs=logging.CRITICAL)  # fmt: skip
            stack.enter_context(cluster)
            return stack.enter_context(distributed.Client(cluster))
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    try:
        return stack.enter_context(distributed.Client(address, timeout=CONNECT_S))
    except Exception as error:  # another server may send any reply
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(f"--dask {address}: no Dask scheduler answers within {CONNECT_S:g} s ({reason}); "
                         "check the address and start it by: dask scheduler") from error  # fmt: skip


def _list_workers(client: Any) -> list[Any]:
    return list(client.scheduler_info(n_workers=-1)["workers"].values())


def _take_finished(distributed: Any, client: Any, futures: Sequence[Any], address: str) -> list[Any]:
    """Waits until at least one future is done. Raises WorkError if the scheduler or the last worker is lost."""
    seen_s = time.monotonic()
    while True:
        try:
            distributed.wait(futures, timeout=_POLL_S, return_when="FIRST_COMPLETED")
        except (distributed.TimeoutError, TimeoutError):
            pass
        except distributed.client.FuturesCancelledError as error:
            raise _lost(address) from error
        if client.status != "running":
            raise _lost(address)
        if done := [future for future in futures if future.done()]:
            return done
        if _list_workers(client):
            seen_s = time.monotonic()
        elif time.monotonic() - seen_s > NO_WORKER_S:
            raise WorkError(f"--dask {address}: no worker for {NO_WORKER_S:g} s; start one by: dask worker {address}, "
                            "the same command continues the campaign")  # fmt: skip


def _get_result(future: Any, address: str) -> tuple[Outcome, Files]:
    try:
        outcome, files = future.result(timeout=CONNECT_S)
    except WorkError:
        raise
    except Exception as error:
        if future.cancelled():
            raise _lost(address) from error
        reason = " ".join(str(error).split())[:300]
        raise WorkError(f"--dask {address}: a case could not be run on a worker: {type(error).__name__}: {reason}") from error
    return outcome, files


def _lost(address: str) -> WorkError:
    return WorkError(f"--dask {address}: the connection to the scheduler was lost; start it again, the same command continues the campaign")
