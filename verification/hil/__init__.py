# SPDX-License-Identifier: Apache-2.0
"""A short run of `./mamori hil` for the gate, and the long one of `./mamori test --all`."""
