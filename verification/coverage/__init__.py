# SPDX-License-Identifier: Apache-2.0
"""Coverage of the kernel by its tests: lines, branches and MC/DC, measured by clang, compared with a list of known gaps."""
