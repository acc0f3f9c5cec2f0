# SPDX-License-Identifier: Apache-2.0
"""A simulated host in a folder, for the tests of the launcher script. PATH contains only its `bin`, with links to system programs and
stand-ins for the package manager, sudo and Python, which record their calls. Installing a package copies its folder from `store`, so that
its commands and headers appear, and the real preprocessor finds the headers."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.command.help_texts import FOLDER
from mamori_tools.host.project import ROOT

PACKAGES_OF_BUILD = ("python3 python3-venv g++ cmake ninja-build libsimbody-dev liborocos-kdl-dev libeigen3-dev "
                     "libyaml-cpp-dev libgtest-dev relacy-dev libcli11-dev nlohmann-json3-dev").split()  # fmt: skip
APT_INSTALL = "apt-get -q -y --no-remove --no-install-recommends install"
SYSTEM_PROGRAMS = "bash cat cp cut date dirname env flock grep head mkdir paste readlink rm sed sha256sum sleep sort tail tr true".split()

TOOLS = {
    "id": 'echo "${FAKE_UID:-0}"',
    "dpkg": 'echo "dpkg $*" >>"$BOX/calls"; exit 1',
    "dpkg-query": 'echo "dpkg-query $*" >>"$BOX/calls"; exit 1',
    "apt-get": 'echo "apt-get $*" >>"$BOX/calls"\n'
    'if [ "$2" = "${FAKE_APT_FAILS:-}" ]; then echo "E: the mirror is down"; exit 100; fi\n'
    'if [ -n "${FAKE_APT_HANGS:-}" ]; then echo $$ >"$BOX/apt.pid"; exec sleep 60; fi\n'
    'for p in "$@"; do if [ -d "$BOX/store/$p" ]; then cp -r "$BOX/store/$p/." "$BOX/"; fi; done',
    "sudo": 'echo "sudo $*" >>"$BOX/calls"; [ -n "${FAKE_SUDO:-}" ] || exit 1; shift; exec "$@"',
}

PYTHON = ('case "$*" in *ensurepip*) test -e "$BOX/share/python3-venv"; exit;; -c*) exit "${FAKE_OLD_PYTHON:-0}";; esac\n'
          'mkdir -p "$3/bin"; cp "$BOX/share/venv-python" "$3/bin/python"; echo venv >>"$BOX/calls"')  # fmt: skip

VENV_PYTHON = ('if [ "$1" = --version ]; then echo Python 3.11.2; exit 0; fi\necho "python $*" >>"$BOX/calls"\n'
               'case "$*" in *pip*) exit "${FAKE_PIP:-0}";; '
               '*) echo "packages: $MAMORI_PACKAGES" >>"$BOX/calls"; printf %s "${FAKE_OUTPUT:-}";; esac')  # fmt: skip

# The files of each Debian package that the launcher may search for. A script if its content matters, otherwise only a name.
STORE: dict[str, dict[str, str]] = {
    "python3": {"bin/python3": PYTHON},
    "python3-venv": {"share/python3-venv": ""},
    "g++": {"bin/c++": f'exec {shutil.which("g++")} -nostdinc -isystem "$BOX/include" "$@"', "bin/g++": 'exec c++ "$@"'},
    "clang-19": {"bin/clang++-19": 'echo "$BOX/share/libclang-rt-19-dev"'},
    "gcc-arm-none-eabi": {"bin/arm-none-eabi-g++": 'cat >/dev/null; test -e "$BOX/share/libstdc++-arm-none-eabi-newlib"'},
    **{name: {f"bin/{program}": ""} for name, program in {
        "cmake": "cmake", "ninja-build": "ninja", "valgrind": "valgrind", "cppcheck": "cppcheck", "chromium": "chromium",
        "stress-ng": "stress-ng", "spin": "spin", "z3": "z3", "git": "git", "clang-tidy-19": "run-clang-tidy-19",
        "clang-format-19": "clang-format-19", "llvm-19": "llvm-cov-19", "qemu-system-arm": "qemu-system-arm", "graphviz": "dot",
        "openssh-client": "ssh-keygen", "liblcm-bin": "lcm-gen", "iproute2": "ip", "cyclonedds-tools": "idlc", "rt-tests": "cyclictest"}.items()},
    **{name: {f"share/{name}": ""} for name in ("libclang-rt-19-dev", "libstdc++-arm-none-eabi-newlib")},
    **{name: {f"include/{header}": ""} for name, header in {
        "libsimbody-dev": "simbody/Simbody.h", "liborocos-kdl-dev": "kdl/chain.hpp", "libeigen3-dev": "eigen3/Eigen/Core",
        "libyaml-cpp-dev": "yaml-cpp/yaml.h", "libgtest-dev": "gtest/gtest.h", "relacy-dev": "relacy/relacy.hpp",
        "libcli11-dev": "CLI/CLI.hpp", "nlohmann-json3-dev": "nlohmann/json.hpp", "libboost-dev": "boost/version.hpp",
        "liblcm-dev": "lcm/lcm.h", "cyclonedds-dev": "dds/dds.h"}.items()},
}  # fmt: skip


def write_script(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!{shutil.which('bash')}\n{text}\n", encoding="utf-8")
    path.chmod(0o755)


def list_errors(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Lines of standard error that are not progress."""
    return [line for line in done.stderr.splitlines() if not re.search(r"( \.\.\.|: done in \d+ s)$|^mamori: missing packages: ", line)]


@dataclass
class Box:
    """A host without any package."""

    folder: Path

    def __post_init__(self) -> None:
        for package, files in STORE.items():
            for name, text in files.items():
                write_script(self.folder / "store" / package / name, text)
        write_script(self.folder / "share" / "venv-python", VENV_PYTHON)
        for name, text in TOOLS.items():
            write_script(self.folder / "bin" / name, text)
        for name in SYSTEM_PROGRAMS:
            (self.folder / "bin" / name).symlink_to(shutil.which(name) or name)
        for name in ("mamori", "requirements.lock", "requirements-test.lock", "pyproject.toml"):
            shutil.copy(ROOT / name, self.folder)
        shutil.copytree(FOLDER, self.folder / FOLDER.relative_to(ROOT))
        # Without a compiler, the launcher would search the folders of the real system.
        script = self.folder / "mamori"
        text = script.read_text(encoding="utf-8")
        assert text.count(" /usr/local/include /usr/include;") == 1
        script.write_text(text.replace(" /usr/local/include /usr/include;", f" {self.folder}/include;"), encoding="utf-8")

    def install(self, *packages: str) -> None:
        for name in packages:
            shutil.copytree(self.folder / "store" / name, self.folder, dirs_exist_ok=True)

    def remove_tools(self, *names: str) -> None:
        for name in names:
            (self.folder / "bin" / name).unlink()

    def environment(self, **settings: str) -> dict[str, str]:
        kept = {name: value for name, value in os.environ.items() if name not in ("CI", "CXX", "CMAKE_PREFIX_PATH")}
        return {**kept, "BOX": str(self.folder), "PATH": f"{self.folder}/bin", **settings}

    def run(self, *words: str, **settings: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([str(self.folder / "mamori"), *words], env=self.environment(**settings), text=True,
                              capture_output=True, stdin=subprocess.DEVNULL, check=False, timeout=60)  # fmt: skip

    def take_calls(self) -> list[str]:
        path = self.folder / "calls"
        calls = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        path.unlink(missing_ok=True)
        return calls


def listen_to_ctrl_c() -> None:
    """Runs in a child before it executes the launcher, because bash cannot undo an ignored or blocked signal of its parent."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
