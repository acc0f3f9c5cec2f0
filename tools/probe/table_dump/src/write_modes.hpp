// SPDX-License-Identifier: Apache-2.0
/// @file
/// Modes, transitions, parameters and configuration sets as parts of the JSON document.
#ifndef MAMORI_TABLE_DUMP_SRC_WRITE_MODES_HPP
#define MAMORI_TABLE_DUMP_SRC_WRITE_MODES_HPP

#include <iosfwd>
#include <string>

#include "mamori/table_dump/table_dump.hpp"

namespace mamori::table_dump {

/// The keys `modes`, `transitions`, `parameters` and `configuration_sets`, each preceded by a comma.
void write_modes(std::ostream& out, const SystemView& view, const Names& names);

/// Modes in which a connection works, as a list of their indices.
std::string make_modes_of(const SystemView& view, ModeMask modes);

/// Modes for which a connection was declared, as a list of their indices, with null for a mode that does not
/// exist. Null if it was declared without modes.
std::string make_only_in(const SystemView& view, std::size_t connection);

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_SRC_WRITE_MODES_HPP
