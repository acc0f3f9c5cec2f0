# SPDX-License-Identifier: Apache-2.0
"""Programs that create evidence about several layers: the campaign, static checks, proofs."""
