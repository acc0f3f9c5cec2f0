// SPDX-License-Identifier: Apache-2.0
/// @file
/// What can be wrong with the text of a constraint, and where.
///
/// @satisfies SWR-PAR-001      Design: docs/design/parameters.md#grammar
#ifndef MAMORI_KERNEL_CONSTRAINT_FINDING_HPP
#define MAMORI_KERNEL_CONSTRAINT_FINDING_HPP

#include <cstddef>
#include <cstdint>

namespace mamori {

/// What is wrong with the text of a constraint.
enum class ConstraintRule : std::uint8_t {
    kNone,                ///< nothing
    kNumberExpected,      ///< no number, or no value of an enumeration, stands here
    kTooManyDigits,       ///< digits that do not fit 64 bits
    kNotInType,           ///< the parameter's type has no such value (range, fraction, sign, underflow)
    kNameUnknown,         ///< the parameter's type has no value of this name
    kVariableExpected,    ///< `x` is missing after a comparison
    kComparisonExpected,  ///< none of < <= > >=
    kDirectionsDiffer,    ///< as in 1<x>0
    kRangeEmpty,          ///< no value lies between the limits
    kKeyExpected,         ///< an entry of { } without a name
    kKeyTwice,            ///< an entry of { } whose name was used before
    kColonExpected,       ///< no : after the name of an entry
    kBracketExpected,     ///< ) or } is missing
    kTextBeyondEnd,       ///< something follows a complete constraint
    kElementCount,        ///< not one constraint for each element
    kTooManyRanges,       ///< more ranges and choices than the parameter has room for
};

/// What is wrong, and before which character it was noticed, counted from 0.
struct ConstraintFinding {
    ConstraintRule rule{ConstraintRule::kNone};
    std::size_t position{0U};
};

/// The rule as a phrase for messages; never nullptr.
constexpr const char* get_text(ConstraintRule rule) noexcept {
    switch (rule) {
        case ConstraintRule::kNone:
            return "no finding";
        case ConstraintRule::kNumberExpected:
            return "constraint: a number is expected here";
        case ConstraintRule::kTooManyDigits:
            return "constraint: this number has too many digits, 19 always fit";
        case ConstraintRule::kNotInType:
            return "constraint: the parameter's type does not have this value";
        case ConstraintRule::kNameUnknown:
            return "constraint: the parameter's type has no value of this name";
        case ConstraintRule::kVariableExpected:
            return "constraint: x is expected here";
        case ConstraintRule::kComparisonExpected:
            return "constraint: < <= > or >= is expected here";
        case ConstraintRule::kDirectionsDiffer:
            return "constraint: both comparisons must point the same way";
        case ConstraintRule::kRangeEmpty:
            return "constraint: no value lies between these limits";
        case ConstraintRule::kKeyExpected:
            return "constraint: the name of an element is expected here";
        case ConstraintRule::kKeyTwice:
            return "constraint: this name was used before";
        case ConstraintRule::kColonExpected:
            return "constraint: a colon is expected here";
        case ConstraintRule::kBracketExpected:
            return "constraint: the closing bracket or a comma is expected here";
        case ConstraintRule::kTextBeyondEnd:
            return "constraint: nothing or a comma is expected here";
        case ConstraintRule::kElementCount:
            return "constraint: a list needs one constraint for each element";
        case ConstraintRule::kTooManyRanges:
            return "constraint: more ranges and choices than the parameter has room for";
    }
    return "constraint: invalid finding";  // only a corrupted value comes here
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONSTRAINT_FINDING_HPP
