# SPDX-License-Identifier: Apache-2.0
"""Throws random bytes at what reads bytes: libFuzzer harnesses, one per file `<name>_fuzz.cpp`, with a corpus each."""
