# SPDX-License-Identifier: Apache-2.0
"""Repeated runs of the real-time campaigns: how often they pass, fail or are inconclusive on this host."""
