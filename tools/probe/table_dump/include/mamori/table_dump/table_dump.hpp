// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes a system table as JSON for `mamori table`, which converts it to text and pictures, and describes in
/// words which rules a table violates. For hosts: link mamori::table_dump into your program and offer
/// `--table-json FILE`.
///
/// @satisfies SWR-TAB-001, SWR-TAB-002, SWR-TAB-003, SWR-TAB-010, SWR-TAB-013, SWR-CYC-032
///           Design: docs/design/cost.md#table-dump
#ifndef MAMORI_TABLE_DUMP_TABLE_DUMP_HPP
#define MAMORI_TABLE_DUMP_TABLE_DUMP_HPP

#include <iosfwd>
#include <string>
#include <vector>

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/kernel/table/system_table.hpp"
#include "mamori/safety/cycle/system.hpp"

namespace mamori::table_dump {

/// Spelling of the enumerators of the application, by their numbers; a number without a name is written as a
/// number.
struct Names {
    std::vector<std::string> faults{};     ///< list_fault_names() reads them from the table
    std::vector<std::string> reactions{};  ///< not used with rows of the safety layer, which has its own
    std::vector<std::string> events{};     ///< those of mode transitions
};

// Every function accepts any rows, including rows that violate rules: an element without a name is written as
// `?`.
//
// Thread safety: none needed, because no state is kept. The components of the table must exist. Only
// write_json() and save_json() read their state (active parameter values): call these while no executive
// runs. Time:          O(rows squared). Memory: heap.

/// One sentence that states the violated rule, the faulty elements and the contradicting numbers.
std::string describe(const Finding& finding, const SystemView& view);

/// Every finding of check_all(), in words; empty if the table complies with every rule.
std::vector<std::string> describe_all(const SystemView& view);

/// Writes one JSON document of schema `mamori.table/5` (docs/design/cost.md#schema): ASCII, names in UTF-8,
/// times as integer nanoseconds, rates in Hz.
/// @param[in] safety rows of the safety layer; nullptr: a table of the kernel alone.
void write_json(std::ostream& out, const SystemView& view, const Names& names = {},
                const safety::SafetyView* safety = nullptr);

/// Writes the same document to a file atomically: to a temporary file next to `path`, which is then renamed.
/// @return empty on success, otherwise one sentence with the path and the cause.
[[nodiscard]] std::string save_json(const std::string& path, const SystemView& view, const Names& names = {},
                                    const safety::SafetyView* safety = nullptr);

}  // namespace mamori::table_dump

#endif  // MAMORI_TABLE_DUMP_TABLE_DUMP_HPP
