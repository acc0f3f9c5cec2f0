# SPDX-License-Identifier: Apache-2.0
"""Faults that are seeded into a clean project, one at a time, sorted by the affected part."""
