# SPDX-License-Identifier: Apache-2.0
"""Proofs about the compiled safe-state machine. Its complete step relation is translated into models for spin and z3.

Design: docs/design/safe_state.md#proofs
"""
