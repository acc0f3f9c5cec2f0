# SPDX-License-Identifier: Apache-2.0
"""Programs that create evidence across layers: the campaign, static checks, proofs."""
