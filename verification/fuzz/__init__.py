# SPDX-License-Identifier: Apache-2.0
"""Feeds random bytes to parsers: libFuzzer harnesses, one per file `<name>_fuzz.cpp`, with a corpus each."""
