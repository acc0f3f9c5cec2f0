# SPDX-License-Identifier: Apache-2.0
"""Repeated runs of the real-time campaigns: the frequencies of passed, failed and inconclusive runs on this host."""
