# SPDX-License-Identifier: Apache-2.0
"""End-to-end protection beside an implementation by others, all its undetected errors, and how likely one passes.

Design: docs/design/e2e.md#comparison
"""
