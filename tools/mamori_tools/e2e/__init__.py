# SPDX-License-Identifier: Apache-2.0
"""End-to-end protection: comparison with an independent implementation, and the probability of undetected errors.

Design: docs/design/e2e.md#comparison
"""
