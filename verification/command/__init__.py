# SPDX-License-Identifier: Apache-2.0
"""The command `./mamori`: what happens after the launcher script has installed what was missing."""
