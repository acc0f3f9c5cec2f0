// SPDX-License-Identifier: Apache-2.0
/// @file
/// Converts enumerators of an application (events, faults, reactions) to the numbers in table rows.
/// Not for users.
///
/// @satisfies SWR-MOD-004, SWR-KRN-018      Design: docs/design/modes.md#requests
#ifndef MAMORI_KERNEL_ENUMERATOR_HPP
#define MAMORI_KERNEL_ENUMERATOR_HPP

#include <cstdint>
#include <type_traits>

namespace mamori::detail {

/// Number of an enumerator in a row; unique within its enumeration.
template <typename E>
constexpr std::uint32_t to_number(E enumerator) noexcept {
    static_assert(std::is_enum_v<E>, "events, faults and reactions are enumerators");
    static_assert(sizeof(E) <= sizeof(std::uint32_t),
                  "events, faults and reactions have at most 32 bits: two that differ in higher ones would "
                  "be one and the same");
    return static_cast<std::uint32_t>(enumerator);
}

/// One object per enumeration; its address identifies the enumeration at run time.
template <typename E>
inline constexpr std::uint8_t kEnumerationTag{0U};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_ENUMERATOR_HPP
