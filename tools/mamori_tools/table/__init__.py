# SPDX-License-Identifier: Apache-2.0
"""Shows the JSON that mamori::table_dump wrote of a system table: `mamori table`."""
