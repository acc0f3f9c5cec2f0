# SPDX-License-Identifier: Apache-2.0
"""Readers: each converts one kind of file to parts of the model, and reports unreadable parts instead of stopping."""
