// SPDX-License-Identifier: Apache-2.0
/// @file
/// Constraints of parameter values. A declaration has one constraint for the whole parameter, or one for each
/// element of an array:
///
///     at_least(a)   above(a)   at_most(b)   below(b)      one limit; above() and below() exclude it
///     between(a, b)                                        a <= value <= b
///     between(above(a), at_most(b))                        limits of either kind
///     one_of(a, b, c)                                      one of these values
///     any_value()                                          for an element without a limit
///
/// `./mamori constraint TEXT` converts the notation of the RTC Profile to these functions. Parameter values
/// are finite: NaN and infinities satisfy no constraint.
///
/// @satisfies SWR-PAR-002, SWR-PAR-003, SWR-PAR-004, SWR-PAR-011
/// Design:   docs/design/parameters.md#constraints
#ifndef MAMORI_KERNEL_CONSTRAINT_HPP
#define MAMORI_KERNEL_CONSTRAINT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// Lower limit of a value, independent of the parameter type.
template <typename L>
struct LowerLimit {
    L value;
    bool is_open;  ///< the limit itself is excluded
};
/// Upper limit of a value, independent of the parameter type.
template <typename L>
struct UpperLimit {
    L value;
    bool is_open;  ///< the limit itself is excluded
};
/// Values between two limits.
template <typename L>
struct Interval {
    LowerLimit<L> lower;
    UpperLimit<L> upper;
};
/// A list of values.
template <typename L, std::size_t kCount>
struct Choices {
    std::array<L, kCount> values;
};
/// Every finite value.
struct AnyValue {};

/// @name Constraints
/// @param limit, lower, upper, first, others of the element's type. A limit of an integer parameter may have
/// another integer type that can represent it.
/// @{
template <typename L>
constexpr LowerLimit<L> at_least(L limit) noexcept {
    return {limit, false};
}
template <typename L>
constexpr LowerLimit<L> above(L limit) noexcept {
    return {limit, true};
}
template <typename L>
constexpr UpperLimit<L> at_most(L limit) noexcept {
    return {limit, false};
}
template <typename L>
constexpr UpperLimit<L> below(L limit) noexcept {
    return {limit, true};
}
template <typename L>
constexpr Interval<L> between(L lower, L upper) noexcept {
    return {{lower, false}, {upper, false}};
}
template <typename L>
constexpr Interval<L> between(LowerLimit<L> lower, UpperLimit<L> upper) noexcept {
    return {lower, upper};
}
template <typename L, typename... Ls>
constexpr Choices<L, sizeof...(Ls) + 1U> one_of(L first, Ls... others) noexcept {
    static_assert((... && std::is_same_v<L, Ls>), "the values of one_of() have one type");
    return {{first, others...}};
}
constexpr AnyValue any_value() noexcept {
    return {};
}
/// @}

/// Values from `lower` to `upper` for one element or for each. Each limit can be excluded.
template <typename S>
struct Range {
    static constexpr std::uint16_t kEachElement = std::numeric_limits<std::uint16_t>::max();
    /// For an enumeration, the limits of its underlying type.
    static constexpr S kLowest = static_cast<S>(std::numeric_limits<detail::Number<S>>::lowest());
    static constexpr S kMax = static_cast<S>(std::numeric_limits<detail::Number<S>>::max());

    S lower{kLowest};
    S upper{kMax};
    std::uint16_t element{kEachElement};  ///< 0 .. 65534, or kEachElement
    bool is_lower_open{false};
    bool is_upper_open{false};

    /// Whether `value` is in the range. The comparisons are false for NaN.
    constexpr bool contains(S value) const noexcept {
        const bool is_above = is_lower_open ? value > lower : value >= lower;
        const bool is_below = is_upper_open ? value < upper : value <= upper;
        return is_above && is_below;
    }
};

/// A constraint as data. An element can have each value that is in one of its ranges.
///
/// Thread safety: constant after construction. Time: O(kRanges). Memory: kRanges ranges, no heap.
/// Before a range is added, it admits no value.
template <typename S, std::size_t kRanges>
class Constraint final {
    static_assert(kRanges > 0U && kRanges < Range<S>::kEachElement);

  public:
    /// Whether element `element` can have `value`. @param[in] element 0 .. number of elements - 1.
    constexpr bool admits(S value, std::size_t element) const noexcept {
        for (const Range<S>& range : get_ranges()) {
            if ((range.element == Range<S>::kEachElement || range.element == element) &&
                range.contains(value)) {
                return true;
            }
        }
        return false;
    }
    /// Ranges in the order of declaration; valid as long as the constraint.
    constexpr Span<const Range<S>> get_ranges() const noexcept { return {ranges_.data(), range_count_}; }

    /// Adds a range. Precondition: fewer than kRanges ranges were added.
    constexpr void add(const Range<S>& range) noexcept {
        ranges_[range_count_] = range;
        ++range_count_;
    }
    /// Removes all ranges, so that no value is admitted; for an invalid declaration.
    constexpr void clear() noexcept { range_count_ = 0U; }

  private:
    std::array<Range<S>, kRanges> ranges_{};
    std::size_t range_count_{0U};
};

namespace detail {

/// @name In a constant expression, a violation stops the compiler, and the message shows the function name.
///       At run time they have no effect: the constraint then admits no value, and initialize() of the
///       executive rejects the parameter.
/// @{
constexpr void require_limit_within_type(bool is_within) noexcept {
    MAMORI_REQUIRE(1, is_within || !__builtin_is_constant_evaluated());
}
constexpr void require_range_contains_a_value(bool contains) noexcept {
    MAMORI_REQUIRE(2, contains || !__builtin_is_constant_evaluated());
}
/// @}

/// Number of ranges of a constraint; 0 for a type that is not a constraint.
template <typename C>
inline constexpr std::size_t kRangeCountOf = 0U;
template <typename L>
inline constexpr std::size_t kRangeCountOf<LowerLimit<L>> = 1U;
template <typename L>
inline constexpr std::size_t kRangeCountOf<UpperLimit<L>> = 1U;
template <typename L>
inline constexpr std::size_t kRangeCountOf<Interval<L>> = 1U;
template <typename L, std::size_t kCount>
inline constexpr std::size_t kRangeCountOf<Choices<L, kCount>> = kCount;
template <>
inline constexpr std::size_t kRangeCountOf<AnyValue> = 1U;

/// Excludes bool, which is an integer type of C++ but not a number here.
template <typename S>
inline constexpr bool kIsInteger = std::is_integral_v<S> && !std::is_same_v<S, bool>;

/// Whether the range contains a value. For floating-point limits a < b, this is assumed without a check that
/// the type has a value between them.
template <typename S>
constexpr bool has_value(const Range<S>& range) noexcept {
    if (!(range.lower < range.upper)) {
        return range.contains(range.lower);
    }
    if constexpr (std::is_floating_point_v<S>) {
        return true;
    } else {
        return !range.is_lower_open || !range.is_upper_open ||
               static_cast<Number<S>>(range.lower) + 1 < static_cast<Number<S>>(range.upper);
    }
}

/// Converts the constraints of a declaration to ranges of the parameter constraint.
template <typename S, std::size_t kRanges>
struct ConstraintMaker {
    Constraint<S, kRanges> constraint{};
    Range<S> range{};
    bool is_valid{true};

    constexpr void add() noexcept {
        const bool contains = has_value(range);
        require_range_contains_a_value(contains);
        is_valid = is_valid && contains;
        constraint.add(range);
    }
    template <typename L>
    constexpr S to_limit(L limit) noexcept {
        static_assert(std::is_same_v<S, L> || (kIsInteger<S> && kIsInteger<L>),
                      "a limit has the type of its parameter, for example 0.0 for double and 0.1F for float");
        const Result<S> value = from_scalar<S>(to_scalar(limit));
        require_limit_within_type(value.has_value());
        is_valid = is_valid && value.has_value();
        return value.has_value() ? value.get_value() : S{};
    }
    template <typename L>
    constexpr void set(const LowerLimit<L>& limit) noexcept {
        range.lower = to_limit(limit.value);
        range.is_lower_open = limit.is_open;
    }
    template <typename L>
    constexpr void set(const UpperLimit<L>& limit) noexcept {
        range.upper = to_limit(limit.value);
        range.is_upper_open = limit.is_open;
    }
    template <typename L>
    constexpr void set(const Interval<L>& interval) noexcept {
        set(interval.lower);
        set(interval.upper);
    }
    constexpr void set(AnyValue) noexcept {}

    template <typename C>
    constexpr void take(std::uint16_t element, const C& part) noexcept {
        range = {};
        range.element = element;
        set(part);
        add();
    }
    template <typename L, std::size_t kCount>
    constexpr void take(std::uint16_t element, const Choices<L, kCount>& choices) noexcept {
        for (const L value : choices.values) {
            take(element, between(value, value));
        }
    }
};

}  // namespace detail

/// The constraint of a parameter with `kElements` elements of type S.
/// @param[in] parts none, one for all elements, or one for each element.
/// @return the constraint; without ranges, so that it admits no value, if a part is invalid at run time.
template <typename S, std::size_t kRanges, std::size_t kElements, typename... Cs>
constexpr Constraint<S, kRanges> make_constraint(const Cs&... parts) noexcept {
    static_assert((... && (detail::kRangeCountOf<Cs> > 0U)),
                  "a constraint is at_least(), above(), at_most(), below(), between(), one_of() or "
                  "any_value(); ./mamori constraint TEXT converts a constraint of the RTC Profile");
    static_assert(sizeof...(Cs) <= 1U || sizeof...(Cs) == kElements,
                  "a parameter has one constraint, or one constraint for each element");
    static_assert((detail::kRangeCountOf<Cs> + ... + 0U) <= kRanges,
                  "more ranges and choices than the parameter has room for: increase its kRanges");
    detail::ConstraintMaker<S, kRanges> maker{};
    if constexpr (sizeof...(Cs) == 0U) {
        maker.take(Range<S>::kEachElement, any_value());
    } else if constexpr (sizeof...(Cs) == 1U) {
        (maker.take(Range<S>::kEachElement, parts), ...);
    } else {
        std::uint16_t element = 0U;
        (maker.take(element++, parts), ...);
    }
    if (!maker.is_valid) {
        maker.constraint.clear();
    }
    return maker.constraint;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONSTRAINT_HPP
