# SPDX-License-Identifier: Apache-2.0
"""How much of the kernel its tests reach: lines, branches and MC/DC, measured by clang, held against a list of known gaps."""
