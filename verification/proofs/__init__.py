# SPDX-License-Identifier: Apache-2.0
"""Proofs about the built project. Each is a pytest file that `./mamori test` runs as a separate step."""
