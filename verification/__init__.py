# SPDX-License-Identifier: Apache-2.0
"""Host tools that make evidence across layers: the command, the campaign, static checks, proofs."""
