// SPDX-License-Identifier: Apache-2.0
/// @file
/// Result of a check of a system table: the violated rule and the faulty row.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_FINDING_HPP
#define MAMORI_KERNEL_SYSTEM_FINDING_HPP

#include <cstddef>

#include "mamori/kernel/table/table_rules.hpp"

namespace mamori {

/// Why a table is rejected: kNone (no rule is violated), then each rule of table_rules.hpp.
enum class Rule {
    kNone,
#define MAMORI_ENUMERATOR(name, Message, Faulty, sentence) k##name,
    MAMORI_TABLE_RULES(MAMORI_ENUMERATOR)
#undef MAMORI_ENUMERATOR
};

/// A violated rule; table_rules.hpp defines what `element` and `other` count.
struct Finding {
    Rule rule{Rule::kNone};
    std::size_t element{0U};
    std::size_t other{0U};
};

/// Spelling of a rule for tools; never nullptr.
const char* get_name(Rule rule) noexcept;

/// The rule as a sentence, for tools; never nullptr.
constexpr const char* get_sentence(Rule rule) noexcept {
    switch (rule) {
        case Rule::kNone:
            return "the table keeps every rule";
#define MAMORI_SENTENCE(name, Message, Faulty, sentence) \
    case Rule::k##name:                                  \
        return sentence;
            MAMORI_TABLE_RULES(MAMORI_SENTENCE)
#undef MAMORI_SENTENCE
    }
    return "invalid rule";  // reached by a corrupted value only
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_FINDING_HPP
