// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads the text of a constraint (grammar: constraint.hpp) for a type of value, at compile time or for a
/// tool while running. One pass from left to right; the first thing that is wrong ends it and is reported
/// with its place.
///
/// @satisfies SWR-PAR-001, SWR-PAR-002      Design: docs/design/parameters.md#grammar
#ifndef MAMORI_KERNEL_CONSTRAINT_PARSER_HPP
#define MAMORI_KERNEL_CONSTRAINT_PARSER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/text_cursor.hpp"
#include "mamori/kernel/parameter/constraint.hpp"
#include "mamori/kernel/parameter/constraint_finding.hpp"

namespace mamori {

/// A constraint, or what is wrong with its text; the constraint admits part of its values then.
template <typename S, std::size_t kRanges>
struct ParsedConstraint {
    Constraint<S, kRanges> constraint{};
    ConstraintFinding finding{};
};

namespace detail {

/// A comparison as it stands between a limit and the variable.
struct Comparison {
    bool is_less{false};  ///< < or <=
    bool is_open{false};  ///< < or >
};

/// Is there a number between the two, neither of them counted? Of floating-point limits it is not asked how
/// many numbers of the type lie between them. @param[in] lower below `upper`.
template <typename S>
constexpr bool has_number_between(S lower, S upper) noexcept {
    if constexpr (std::is_floating_point_v<S>) {
        return true;
    } else {
        return static_cast<Number<S>>(lower) + 1 < static_cast<Number<S>>(upper);
    }
}

/// Recursive structures are not in the grammar, so neither is recursion here. Each loop takes at least one
/// character per turn.
template <typename S, std::size_t kRanges>
class ConstraintParser final {
  public:
    constexpr ConstraintParser(Text text, std::size_t element_count) noexcept
        : cursor_(text), element_count_(element_count) {}

    constexpr ParsedConstraint<S, kRanges> parse() noexcept {
        cursor_.skip_spaces();
        const bool is_named = cursor_.take('{');
        const std::size_t count = is_named ? parse_named_list() : parse_list();
        if (count == 1U) {
            result_.constraint.widen_to_each_element();
        }
        if (count < element_count_ && (is_named || count > 1U)) {
            refuse(ConstraintRule::kElementCount);
        }
        cursor_.skip_spaces();
        if (!cursor_.is_at_end()) {
            refuse(ConstraintRule::kTextBeyondEnd);
        }
        return result_;
    }

  private:
    constexpr bool is_good() const noexcept { return result_.finding.rule == ConstraintRule::kNone; }
    constexpr void refuse_at(ConstraintRule rule, std::size_t position) noexcept {
        if (is_good()) {
            result_.finding = {rule, position};
        }
    }
    constexpr void refuse(ConstraintRule rule) noexcept { refuse_at(rule, cursor_.get_position()); }

    /// @return number of constraints.
    constexpr std::size_t parse_list() noexcept {
        std::size_t count = 1U;
        parse_item(0U);
        while (is_good() && cursor_.take(',')) {
            parse_item(count);
            ++count;
        }
        return count;
    }

    constexpr std::size_t parse_named_list() noexcept {
        std::array<Text, kRanges> keys{};
        std::size_t count = 1U;
        parse_entry(0U, keys);
        while (is_good() && cursor_.take(',')) {
            parse_entry(count, keys);
            ++count;
        }
        if (is_good() && !cursor_.take('}')) {
            refuse(ConstraintRule::kBracketExpected);
        }
        return count;
    }

    constexpr void parse_entry(std::size_t element, std::array<Text, kRanges>& keys) noexcept {
        cursor_.skip_spaces();
        const std::size_t position = cursor_.get_position();
        const Text key = cursor_.take_word();
        if (key.empty()) {
            refuse(ConstraintRule::kKeyExpected);
            return;
        }
        for (std::size_t i = 0U; i < element && i < kRanges; ++i) {
            if (keys[i] == key) {
                refuse_at(ConstraintRule::kKeyTwice, position);
                return;
            }
        }
        if (element < kRanges) {
            keys[element] = key;
        }
        cursor_.skip_spaces();
        if (!cursor_.take(':')) {
            refuse(ConstraintRule::kColonExpected);
            return;
        }
        parse_item(element);
    }

    constexpr void parse_item(std::size_t element) noexcept {
        cursor_.skip_spaces();
        item_position_ = cursor_.get_position();
        if (element >= element_count_) {
            refuse(ConstraintRule::kElementCount);
            return;
        }
        range_ = {};
        range_.element = static_cast<std::uint16_t>(element);
        if (cursor_.is_at_end() || cursor_.is_at(',') || cursor_.is_at('}')) {
            add_range();
        } else if (cursor_.take('(')) {
            parse_choices();
        } else if (cursor_.take('x')) {
            const Comparison comparison = take_comparison();
            narrow(comparison, take_number());
            add_range();
        } else {
            parse_from_number();
        }
        cursor_.skip_spaces();
    }

    constexpr void parse_choices() noexcept {
        take_choice();
        while (is_good() && cursor_.take(',')) {
            take_choice();
        }
        if (is_good() && !cursor_.take(')')) {
            refuse(ConstraintRule::kBracketExpected);
        }
    }

    constexpr void take_choice() noexcept {
        cursor_.skip_spaces();
        item_position_ = cursor_.get_position();
        TextCursor ahead = cursor_;
        const Text word = cursor_.is_at_digit() ? Text{} : ahead.take_word();
        if (word.empty()) {
            range_.lower = take_number();
        } else {
            const Result<S> named = from_name<S>(word);
            if (!named.has_value()) {
                refuse(ConstraintRule::kNameUnknown);
            }
            range_.lower = named.get_value();
            cursor_ = ahead;
        }
        range_.upper = range_.lower;
        add_range();
        cursor_.skip_spaces();
    }

    /// A number alone, or one that is compared with x.
    constexpr void parse_from_number() noexcept {
        const S number = take_number();
        cursor_.skip_spaces();
        if (cursor_.is_at('=')) {
            refuse(ConstraintRule::kComparisonExpected);
        }
        if (!cursor_.is_at('<') && !cursor_.is_at('>')) {
            range_.lower = number;
            range_.upper = number;
            add_range();
            return;
        }
        const Comparison first = take_comparison();
        narrow({!first.is_less, first.is_open}, number);  // 1<x is x>1
        cursor_.skip_spaces();
        if (!cursor_.take('x')) {
            refuse(ConstraintRule::kVariableExpected);
            return;
        }
        cursor_.skip_spaces();
        if (cursor_.is_at('<') || cursor_.is_at('>')) {
            const std::size_t position = cursor_.get_position();
            const Comparison second = take_comparison();
            if (second.is_less != first.is_less) {
                refuse_at(ConstraintRule::kDirectionsDiffer, position);
            }
            narrow(second, take_number());
        }
        add_range();
    }

    constexpr Comparison take_comparison() noexcept {
        cursor_.skip_spaces();
        const bool is_less = cursor_.take('<');
        if (!is_less && !cursor_.take('>')) {
            refuse(ConstraintRule::kComparisonExpected);
        }
        return {is_less, !cursor_.take('=')};
    }

    constexpr S take_number() noexcept {
        cursor_.skip_spaces();
        const std::size_t position = cursor_.get_position();
        const Result<Decimal> decimal = take_decimal(cursor_);
        if (decimal.get_status() == Status::kUnsupported) {
            refuse_at(ConstraintRule::kTooManyDigits, position);
        } else if (!decimal.has_value()) {
            refuse(ConstraintRule::kNumberExpected);
        }
        const Result<S> number = from_decimal<S>(decimal.get_value());
        if (!number.has_value()) {
            refuse_at(ConstraintRule::kNotInType, position);
        }
        return number.get_value();
    }

    /// `x` compared with `limit`.
    constexpr void narrow(Comparison comparison, S limit) noexcept {
        (comparison.is_less ? range_.upper : range_.lower) = limit;
        (comparison.is_less ? range_.is_upper_open : range_.is_lower_open) = comparison.is_open;
    }

    constexpr bool is_range_empty() const noexcept {
        if (!(range_.lower < range_.upper)) {
            return range_.lower > range_.upper || range_.is_lower_open || range_.is_upper_open;
        }
        return range_.is_lower_open && range_.is_upper_open &&
               !has_number_between(range_.lower, range_.upper);
    }

    constexpr void add_range() noexcept {
        if (is_range_empty()) {
            refuse_at(ConstraintRule::kRangeEmpty, item_position_);
        }
        if (is_good() && !result_.constraint.add(range_)) {
            refuse_at(ConstraintRule::kTooManyRanges, item_position_);
        }
    }

    TextCursor cursor_;
    std::size_t element_count_;
    std::size_t item_position_{0U};
    Range<S> range_{};
    ParsedConstraint<S, kRanges> result_{};
};

}  // namespace detail

/// Reads `text` as the constraint of a value with `element_count` elements of type S.
/// O(length of the text, and for named elements kRanges squared).
/// @param[in] text          need not outlive the call.
/// @param[in] element_count 1 .. 65534, which is not checked.
/// @return the constraint, with finding.rule kNone, or the first thing that is wrong.
template <typename S, std::size_t kRanges>
constexpr ParsedConstraint<S, kRanges> parse_constraint(Text text, std::size_t element_count = 1U) noexcept {
    static_assert(is_scalar<S>(), "a constraint is for bool, integers, float, double and enums");
    return detail::ConstraintParser<S, kRanges>{text, element_count}.parse();
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONSTRAINT_PARSER_HPP
