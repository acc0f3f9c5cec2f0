// SPDX-License-Identifier: Apache-2.0
/// @file
/// Cross comparison of two channels: all that one of them has on its ports against all that the other one
/// has, field by field, every cycle.
///
/// @satisfies SWR-RED-008, SWR-RED-009      Design: docs/design/redundancy.md#cross-comparison
/// Source:   IEC 61508-7:2010 A.3.5 (reciprocal comparison by software)
#ifndef MAMORI_SAFETY_REDUNDANCY_CROSS_COMPARISON_HPP
#define MAMORI_SAFETY_REDUNDANCY_CROSS_COMPARISON_HPP

#include <cstddef>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/safety/redundancy/discrepancy.hpp"

namespace mamori::safety {

namespace detail {

/// True for what can be the tolerance of a T, or stands for "exactly".
template <typename T>
constexpr bool is_allowed(T tolerance) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return is_tolerance(static_cast<double>(tolerance));
    } else {
        return tolerance == T{};
    }
}

/// Visitor of a payload that holds tolerances.
struct ToleranceCheck {
    template <typename T>
    constexpr bool run(const T* first, std::size_t count) const noexcept {
        for (std::size_t i = 0U; i < count; ++i) {
            if (!is_allowed(first[i])) {
                return false;
            }
        }
        return true;
    }
    template <typename Sequence>
    constexpr bool open(const Sequence& sequence, std::size_t& count) const noexcept {
        count = sequence.size();
        return count == Sequence::capacity();
    }
    template <std::size_t N>
    constexpr bool text(const BoundedString<N>& string) const noexcept {
        return string.size() == 0U;
    }
};

template <typename T>
inline constexpr std::size_t kFieldCount = mamori::detail::FieldTypes<T>::kSize;

template <typename T>
constexpr bool are_close(const T& a, const T& b, const T& tolerance) noexcept;

/// @return number of fields, from the first on, that are close: kFieldCount<T> when all are.
template <typename T>
constexpr std::size_t count_close_fields(const T& a, const T& b, const T& tolerance) noexcept {
    std::size_t count = 0U;
    const auto tally = [&count](bool is_close) noexcept {
        count += is_close ? 1U : 0U;
        return is_close;
    };
    Fields<T>::apply(a, [&](const auto&... as) noexcept {
        Fields<T>::apply(b, [&](const auto&... bs) noexcept {
            Fields<T>::apply(tolerance, [&](const auto&... ts) noexcept {
                static_cast<void>((tally(are_close(as, bs, ts)) && ...));
            });
        });
    });
    return count;
}

template <typename T>
constexpr bool are_close(const T& a, const T& b, const T& tolerance) noexcept {
    using Shape = mamori::detail::Shape<T>;
    if constexpr (Shape::kIsString) {
        return a == b;
    } else if constexpr (Shape::kIsArray || Shape::kIsSequence) {
        bool is_close = a.size() == b.size();
        const std::size_t count = is_close ? a.size() : 0U;
        for (std::size_t i = 0U; i < count; ++i) {
            is_close = is_close && are_close(a.data()[i], b.data()[i], tolerance.data()[i]);
        }
        return is_close;
    } else if constexpr (std::is_floating_point_v<T>) {
        return agree(static_cast<double>(a), static_cast<double>(b), static_cast<double>(tolerance));
    } else if constexpr (mamori::detail::kIsScalar<T>) {
        return a == b;
    } else {
        return count_close_fields(a, b, tolerance) == kFieldCount<T>;
    }
}

}  // namespace detail

/// True when `tolerance` holds a tolerance for every value of its type: finite and >= 0 for floating point, 0
/// for what is compared exactly (integers, bools, enumerators), every element of a sequence, no text.
template <typename Ports>
constexpr bool are_tolerances(const Ports& tolerance) noexcept {
    detail::ToleranceCheck check{};
    return mamori::detail::walk(tolerance, check);
}

/// Compares the port set of this channel with that of the other one.
///
/// Thread safety: none; call step() once per cycle. Time: O(values), nothing blocks. Memory: no heap.
/// @tparam Ports      struct with one field per port and a field list (MAMORI_FIELDS). Whatever is in it, is
///                    compared; stamps of two clocks do not belong into it.
/// @tparam kTolerance a Ports whose values are the absolute tolerances, each in the unit of its value.
template <typename Ports, const Ports& kTolerance>
class CrossComparison final {
    static_assert(Fields<Ports>::kDeclared,
                  "give the port set a field list: MAMORI_FIELDS(Type, field, ...)");
    static_assert(are_tolerances(kTolerance),
                  "tolerance that is negative or not finite, or for an exact value");

  public:
    /// "No field".
    static constexpr std::size_t kNoField = detail::kFieldCount<Ports>;

    /// @param[in] discrepancy_time for which the sets may differ, in whatever fields, included: >= 0.
    explicit constexpr CrossComparison(Duration discrepancy_time) noexcept : timer_(discrepancy_time) {}

    /// @param[in] own, other the port sets of one cycle. @return judgement after this cycle.
    Discrepancy step(const Ports& own, const Ports& other, Instant now) noexcept {
        const std::size_t field = detail::count_close_fields(own, other, kTolerance);
        if (timer_.get() != Discrepancy::kLatched) {
            field_ = field;
        }
        return timer_.step(field != kNoField, now);
    }

    /// Clears what is latched. Only for a deliberate act of a person.
    /// @return kOk (nothing is latched now); kPreconditionNotMet (they differed in the last step).
    Status acknowledge() noexcept { return timer_.acknowledge(); }

    constexpr Discrepancy get_discrepancy() const noexcept { return timer_.get(); }
    /// @return number of the first field, in the order of declaration, that differed in the last step, or in
    ///         the one that latched it; kNoField when none did.
    constexpr std::size_t get_first_difference() const noexcept { return field_; }

  private:
    DiscrepancyTimer timer_;
    std::size_t field_{kNoField};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_REDUNDANCY_CROSS_COMPARISON_HPP
