// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes a system table as JSON for `mamori table`, which makes text and pictures of it, and says in words
/// which rules a table breaks. For hosts: link mamori::table_dump into your program and offer `--table-json
/// FILE`.
///
/// @satisfies SWR-TAB-001, SWR-TAB-002, SWR-TAB-003, SWR-TAB-010, SWR-TAB-013
///           Design: docs/design/cost.md#table-dump
#ifndef MAMORI_TABLE_DUMP_TABLE_DUMP_HPP
#define MAMORI_TABLE_DUMP_TABLE_DUMP_HPP

#include <iosfwd>
#include <string>
#include <vector>

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::table_dump {

/// Spelling of the application's enumerators, by their numbers; a number without one is written as it is.
struct Names {
    std::vector<std::string> faults{};
    std::vector<std::string> reactions{};
    std::vector<std::string> events{};  ///< those of mode transitions
};

// Every function takes any rows, also such as break every rule: what has no name is written as `?`.
//
// Thread safety: none needed, nothing is kept. The components of the table must exist; of their state only
// the active values of parameters are read, by write_json() and save_json(): call these while no executive
// runs. Time:          O(rows squared). Memory: heap.

/// One sentence that says which rule is broken, names the guilty elements and gives the numbers that
/// disagree.
std::string describe(const Finding& finding, const SystemView& view);

/// Every finding of check_all(), in words; empty: the table keeps every rule.
std::vector<std::string> describe_all(const SystemView& view);

/// Writes one JSON document of schema `mamori.table/2` (docs/design/cost.md#schema): ASCII and UTF-8 as
/// the names are, times as whole nanoseconds, rates in Hz.
void write_json(std::ostream& out, const SystemView& view, const Names& names = {});

/// The same into a file, which is whole or not there: written beside `path` and renamed.
/// @return empty when done, else one sentence with the path and the cause.
[[nodiscard]] std::string save_json(const std::string& path, const SystemView& view, const Names& names = {});

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_TABLE_DUMP_HPP
