# SPDX-License-Identifier: Apache-2.0
"""Feeds random bytes to readers of bytes: libFuzzer harnesses, one per file `<name>_fuzz.cpp`, with a corpus each."""
