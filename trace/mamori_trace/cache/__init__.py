# SPDX-License-Identifier: Apache-2.0
"""Repeats the stored outcome of a complete check instead of running it again (docs/design/trace.md#cache).

This package imports no readers or rules: an unchanged project must be recognised before they are loaded.
"""
