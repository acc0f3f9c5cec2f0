# SPDX-License-Identifier: Apache-2.0
"""Leaves out work whose outcome is known: the outcome of a whole check (docs/design/trace.md#cache).

Nothing here imports readers or rules: an unchanged project must be told as such before they are loaded.
"""
