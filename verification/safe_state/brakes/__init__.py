# SPDX-License-Identifier: Apache-2.0
"""Proofs about the compiled brake sequence, alone and under the compiled safe-state machine.

Design: docs/design/safe_state.md#brakes-in-the-models
"""
