# SPDX-License-Identifier: Apache-2.0
"""Files, errors and processes: what every host tool of Mamori uses. Imports no other package of ours."""
