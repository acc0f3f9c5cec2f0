# SPDX-License-Identifier: Apache-2.0
"""How many small faults, put into the kernel one by one, its tests find: the mutation score."""
