// SPDX-License-Identifier: Apache-2.0
#include "mamori/table_dump/fault_names.hpp"

#include <cctype>

namespace mamori::table_dump::detail {
namespace {

constexpr std::uint64_t kNumberMax = 0xFFFFU;

// g++: "... [with auto kEnumerator = space::Fault::kOverspeed]"; clang: "... [kEnumerator = ...]". A number
// without an enumerator is "(space::Fault)7".
std::string parse_enumerator(const std::string& spelling) {
    const std::size_t end = spelling.find_last_of(']');
    const std::size_t before = spelling.find_last_of(":) =", end);
    std::string name = spelling.substr(before + 1U, end - before - 1U);
    const bool has_prefix =
        name.size() > 1U && name[0] == 'k' && std::isupper(static_cast<unsigned char>(name[1])) != 0;
    return has_prefix ? name.substr(1U) : name;
}

}  // namespace

void add_name(std::vector<std::string>& names, std::uint64_t number, const std::string& spelling) {
    if (number > kNumberMax) {
        return;
    }
    while (names.size() <= number) {
        names.push_back(std::to_string(names.size()));
    }
    names[static_cast<std::size_t>(number)] = parse_enumerator(spelling);
}

}  // namespace mamori::table_dump::detail
