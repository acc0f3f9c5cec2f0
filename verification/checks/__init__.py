# SPDX-License-Identifier: Apache-2.0
"""Static checks over the source tree."""
