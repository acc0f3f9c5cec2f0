// SPDX-License-Identifier: Apache-2.0
/// @file
/// Enumerators of an application in the rows of a table, where they are numbers: events, faults, reactions.
/// Not for users.
///
/// @satisfies SWR-MOD-004, SWR-KRN-018      Design: docs/design/modes.md#requests
#ifndef MAMORI_KERNEL_ENUMERATOR_HPP
#define MAMORI_KERNEL_ENUMERATOR_HPP

#include <cstdint>
#include <type_traits>

namespace mamori::detail {

/// Number of an enumerator in a row; no two of one enumeration have the same.
template <typename E>
constexpr std::uint32_t to_number(E enumerator) noexcept {
    static_assert(std::is_enum_v<E>, "events, faults and reactions are enumerators");
    static_assert(sizeof(E) <= sizeof(std::uint32_t),
                  "events, faults and reactions have at most 32 bits: two that differ in higher ones would "
                  "be one and the same");
    return static_cast<std::uint32_t>(enumerator);
}

/// An object for each enumeration; its address tells one from another while the program runs.
template <typename E>
inline constexpr std::uint8_t kEnumerationTag{0U};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_ENUMERATOR_HPP
