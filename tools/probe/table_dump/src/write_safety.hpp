// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of the safety layer as part of the JSON document.
#ifndef MAMORI_TABLE_DUMP_SRC_WRITE_SAFETY_HPP
#define MAMORI_TABLE_DUMP_SRC_WRITE_SAFETY_HPP

#include <iosfwd>

#include "mamori/kernel/table/system_table.hpp"
#include "mamori/safety/cycle/system.hpp"

namespace mamori::table_dump {

/// The key `safety`, preceded by a comma. @param[in] safety nullptr: a table of the kernel alone.
void write_safety(std::ostream& out, const SystemView& view, const safety::SafetyView* safety);

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_SRC_WRITE_SAFETY_HPP
