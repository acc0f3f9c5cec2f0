# SPDX-License-Identifier: Apache-2.0
"""Proofs about the compiled safe-state machine: its complete step relation, made into models for spin and z3.

Design: docs/design/safe_state.md#proofs
"""
