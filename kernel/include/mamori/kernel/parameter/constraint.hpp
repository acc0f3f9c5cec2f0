// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which values a parameter may have, in the notation of the RTC Profile of OpenRTM:
///
///     (nothing)              every value of the type
///     100                    this value only
///     x>=100    100<=x<200   limits; each side may be open or closed, and read in either direction
///     (9600,19200)           one of these values; enumerators and bool also by name
///     0<=x<=1, , (1,2)       one constraint for each element of an array, of which any may be empty
///     {pan: x>0, tilt: x<1}  the same, each element with a name
///
/// A constraint without a list holds for every element. A parameter is a finite number: NaN and infinities
/// satisfy no constraint, not even the empty one.
///
/// @satisfies SWR-PAR-001, SWR-PAR-003      Design: docs/design/parameters.md#grammar
/// Source:   RTC Profile 0.2/0.3, attribute `constraint` of a configuration parameter, as RTSystemEditor
///           reads it
#ifndef MAMORI_KERNEL_CONSTRAINT_HPP
#define MAMORI_KERNEL_CONSTRAINT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/parameter/scalar.hpp"

namespace mamori {

/// Values from `lower` to `upper`, either of which may be excluded, for one element or for each.
template <typename S>
struct Range {
    static constexpr std::uint16_t kEachElement = std::numeric_limits<std::uint16_t>::max();

    /// Of an enumeration the numbers count.
    S lower{static_cast<S>(std::numeric_limits<detail::Number<S>>::lowest())};
    S upper{static_cast<S>(std::numeric_limits<detail::Number<S>>::max())};
    std::uint16_t element{kEachElement};  ///< 0 .. 65534, or each
    bool is_lower_open{false};
    bool is_upper_open{false};

    /// Written so that a NaN lies nowhere.
    constexpr bool contains(S value) const noexcept {
        const bool is_above = is_lower_open ? value > lower : value >= lower;
        const bool is_below = is_upper_open ? value < upper : value <= upper;
        return is_above && is_below;
    }
};

/// A constraint as data: an element may have a value that lies in any of its ranges.
///
/// Thread safety: constant once parsed. Time: O(kRanges). Memory: kRanges ranges; no text, no heap.
/// Before any range is added it admits nothing.
template <typename S, std::size_t kRanges>
class Constraint final {
    static_assert(kRanges > 0U && kRanges < Range<S>::kEachElement);

  public:
    /// May element `element` have `value`? @param[in] element 0 .. number of elements - 1.
    constexpr bool admits(S value, std::size_t element) const noexcept {
        for (std::size_t i = 0U; i < range_count_; ++i) {
            const Range<S>& range = ranges_[i];
            if ((range.element == Range<S>::kEachElement || range.element == element) &&
                range.contains(value)) {
                return true;
            }
        }
        return false;
    }
    /// The ranges in the order of the text, for tools; valid as long as the constraint.
    constexpr Span<const Range<S>> get_ranges() const noexcept { return {ranges_.data(), range_count_}; }

    /// @name For the parser
    /// @{
    /// @return false when there is no room.
    constexpr bool add(const Range<S>& range) noexcept {
        if (range_count_ == kRanges) {
            return false;
        }
        ranges_[range_count_] = range;
        ++range_count_;
        return true;
    }
    /// A list of one is a constraint for every element.
    constexpr void widen_to_each_element() noexcept {
        for (Range<S>& range : ranges_) {
            range.element = Range<S>::kEachElement;
        }
    }
    /// @}

  private:
    std::array<Range<S>, kRanges> ranges_{};
    std::size_t range_count_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONSTRAINT_HPP
