// SPDX-License-Identifier: Apache-2.0
/// @file
/// Maximum size of the encoding of a payload, computed from its type alone.
///
/// @satisfies SWR-CDR-014, SWR-CDR-015      Design: docs/design/data_flow.md#largest-size
/// Source:   OMG CORBA 3.0, 15.3 (CDR transfer syntax): alignments of primitive types
#ifndef MAMORI_KERNEL_CDR_SIZE_HPP
#define MAMORI_KERNEL_CDR_SIZE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/type_list.hpp"
#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori {

namespace detail {

/// Number of bytes from a position to the end of an element, including padding, for each remainder of the
/// position modulo 8. No alignment exceeds 8, so the size depends on the remainder only.
struct WireSteps {
    static constexpr std::size_t kRemainders = 8U;
    std::array<std::size_t, kRemainders> from{};

    constexpr WireSteps then(const WireSteps& next) const noexcept {
        WireSteps sum;
        for (std::size_t i = 0U; i < kRemainders; ++i) {
            sum.from[i] = from[i] + next.from[(i + from[i]) % kRemainders];
        }
        return sum;
    }
    /// `count` elements in sequence, by squaring, so that a long sequence needs few compile-time steps.
    constexpr WireSteps repeat(std::size_t count) const noexcept {
        WireSteps sum;
        WireSteps power = *this;
        for (std::size_t rest = count; rest > 0U; rest /= 2U) {
            if (rest % 2U == 1U) {
                sum = sum.then(power);
            }
            power = power.then(power);
        }
        return sum;
    }
};

template <typename T>
constexpr WireSteps calc_steps() noexcept;

template <typename... T>
constexpr WireSteps calc_steps_of_fields(TypeList<T...> /*types*/) noexcept {
    WireSteps sum;
    ((sum = sum.then(calc_steps<T>())), ...);
    return sum;
}

/// Steps of the longest T. A longer part never ends earlier, so the longest encoding has the longest parts.
template <typename T>
constexpr WireSteps calc_steps() noexcept {
    if constexpr (kIsScalar<T>) {
        WireSteps one;
        for (std::size_t i = 0U; i < WireSteps::kRemainders; ++i) {
            one.from[i] = align_up(i, calc_wire_size<T>()) + calc_wire_size<T>() - i;
        }
        return one;
    } else if constexpr (Shape<T>::kIsArray) {
        return calc_steps<typename Shape<T>::Element>().repeat(Shape<T>::kCapacity);
    } else if constexpr (Shape<T>::kIsSequence) {
        return calc_steps<std::uint32_t>().then(
            calc_steps<typename Shape<T>::Element>().repeat(Shape<T>::kCapacity));
    } else if constexpr (Shape<T>::kIsString) {
        return calc_steps<std::uint32_t>().then(calc_steps<char>().repeat(Shape<T>::kCapacity + 1U));
    } else {
        return calc_steps_of_fields(FieldTypes<T>{});
    }
}

}  // namespace detail

/// Maximum size of the encoding of T [byte]; the size of every encoding when T has no sequence and no string.
template <typename T>
constexpr std::size_t max_encoded_size() noexcept {
    static_assert(is_payload<T>(), "give this type a field list: MAMORI_FIELDS(Type, field, ...)");
    return detail::calc_steps<T>().from[0];
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CDR_SIZE_HPP
