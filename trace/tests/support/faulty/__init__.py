# SPDX-License-Identifier: Apache-2.0
"""Projects with known faults: a clean one of any size in several formats, and one fault class at a time seeded into it."""
