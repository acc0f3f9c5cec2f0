// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/table/system_check.hpp"

#include <array>

namespace mamori {
namespace {

#define MAMORI_SPELLING(name, Message, Faulty, sentence) #name,
/// In the order of Rule.
constexpr std::array kNames{"None", MAMORI_TABLE_RULES(MAMORI_SPELLING)};
#undef MAMORI_SPELLING

}  // namespace

const char* get_name(Rule rule) noexcept {
    const auto index = static_cast<std::size_t>(rule);
    const char* name = "Invalid";  // returned for a corrupted value
    if (index < kNames.size()) {
        name = kNames[index];
    }
    return name;
}

}  // namespace mamori
