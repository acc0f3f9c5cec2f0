// SPDX-License-Identifier: Apache-2.0
/// @file
/// Pieces of JSON text, for any characters, numbers and indices.
#ifndef MAMORI_TABLE_DUMP_SRC_JSON_TEXT_HPP
#define MAMORI_TABLE_DUMP_SRC_JSON_TEXT_HPP

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace mamori::table_dump::json {

std::string quote(std::string_view text);

/// The shortest text that converts back to the same number; null for infinity and not-a-number.
std::string format_number(double value);

inline const char* format_truth(bool value) {
    return value ? "true" : "false";
}

/// An index of the table; null if the table has no such row.
inline std::string format_index(std::size_t index, std::size_t count) {
    return index < count ? std::to_string(index) : "null";
}

/// Spelling of an enumerator in quotes; its number without a spelling.
inline std::string quote_enumerator(const std::vector<std::string>& names, std::uint32_t number) {
    return quote(number < names.size() ? names[number] : std::to_string(number));
}

/// `[a, b]` on one line; if `make_item(i)` is empty, the item is omitted.
template <typename MakeItem>
std::string make_list(std::size_t count, const MakeItem& make_item) {
    std::string items;
    for (std::size_t i = 0U; i < count; ++i) {
        const std::string item = make_item(i);
        items += (items.empty() || item.empty() ? "" : ", ") + item;
    }
    return "[" + items + "]";
}

/// `"key": [` rows `]`, one row per line.
template <typename MakeRow>
void write_rows(std::ostream& out, const char* key, std::size_t count, const MakeRow& make_row) {
    out << ",\n \"" << key << "\": [";
    for (std::size_t i = 0U; i < count; ++i) {
        out << (i == 0U ? "\n  " : ",\n  ") << make_row(i);
    }
    out << (count == 0U ? "]" : "\n ]");
}

}  // namespace mamori::table_dump::json

#endif  // MAMORI_TABLE_DUMP_SRC_JSON_TEXT_HPP
