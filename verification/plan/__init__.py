# SPDX-License-Identifier: Apache-2.0
"""The steps of `./mamori test`: what proves Mamori itself."""
