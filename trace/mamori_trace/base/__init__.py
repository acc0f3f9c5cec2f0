# SPDX-License-Identifier: Apache-2.0
"""Files, errors and processes for all host tools of Mamori. Imports no other package of the project."""
