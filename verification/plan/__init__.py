# SPDX-License-Identifier: Apache-2.0
"""The steps of `./mamori test`, which verify Mamori itself."""
