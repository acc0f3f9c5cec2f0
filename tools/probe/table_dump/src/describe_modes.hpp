// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sentences about modes and configuration sets, and functions common to all sentences.
#ifndef MAMORI_TABLE_DUMP_SRC_DESCRIBE_MODES_HPP
#define MAMORI_TABLE_DUMP_SRC_DESCRIBE_MODES_HPP

#include <string>

#include "mamori/kernel/table/system_check.hpp"

namespace mamori::table_dump {

inline std::string quote(const std::string& name) {
    return "'" + name + "'";
}

/// @return empty for a rule about other elements than modes and sets.
std::string describe_modes(const Finding& finding, const SystemView& view);

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_SRC_DESCRIBE_MODES_HPP
