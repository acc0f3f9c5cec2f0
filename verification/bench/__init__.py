# SPDX-License-Identifier: Apache-2.0
"""`./mamori bench`: times of kernel operations relative to lower bounds and reference implementations, and exact instruction counts.

Design: docs/design/bench.md
"""
