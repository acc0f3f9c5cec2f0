# SPDX-License-Identifier: Apache-2.0
"""Shows the JSON of a system table from mamori::table_dump: `mamori table`."""
