# SPDX-License-Identifier: Apache-2.0
"""The mutation score: the share of small faults, seeded into the kernel one by one, that its tests find."""
