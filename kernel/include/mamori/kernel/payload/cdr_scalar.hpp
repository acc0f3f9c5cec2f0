// SPDX-License-Identifier: Apache-2.0
/// @file
/// Representation of a number, bool or enumeration in CDR: size (equal to the alignment), bits, and valid
/// values.
///
/// @satisfies SWR-CDR-010, SWR-CDR-013      Design: docs/design/data_flow.md#cdr
/// Source:   OMG CORBA 3.0, 15.3 (CDR transfer syntax): alignments of primitive types
#ifndef MAMORI_KERNEL_CDR_SCALAR_HPP
#define MAMORI_KERNEL_CDR_SCALAR_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace mamori {

/// Number of enumerators of an enumeration; they are numbered from 0, as in IDL. Specialised by
/// MAMORI_LAST_ENUMERATOR. An enumeration without it has no encoding, because invalid values could not be
/// detected.
template <typename E>
struct Enumerators {
    static constexpr std::uint32_t kCount = 0U;
};

namespace detail {

/// Size of T on the wire [byte], equal to its alignment.
template <typename T>
constexpr std::size_t calc_wire_size() noexcept {
    static_assert(!std::is_same_v<T, wchar_t> && !std::is_same_v<T, char16_t> && !std::is_same_v<T, char32_t>,
                  "wide characters have no encoding: their form depends on the peers' character sets");
    if constexpr (std::is_enum_v<T>) {
        static_assert(Enumerators<T>::kCount > 0U, "MAMORI_LAST_ENUMERATOR(Type, last) is missing");
        static_assert(sizeof(T) <= sizeof(std::uint32_t), "an IDL enumeration has 32 bits");
        return sizeof(std::uint32_t);
    } else if constexpr (std::is_same_v<T, bool>) {
        return 1U;
    } else {
        static_assert(sizeof(T) <= sizeof(std::uint64_t), "numbers have at most 64 bits");
        return sizeof(T);
    }
}

constexpr std::size_t align_up(std::size_t position, std::size_t alignment) noexcept {
    return (position + alignment - 1U) / alignment * alignment;
}

/// Unsigned integer with as many bits as T has on the wire.
template <typename T>
using WireBits = std::conditional_t<
    calc_wire_size<T>() == 8U, std::uint64_t,
    std::conditional_t<calc_wire_size<T>() == 4U, std::uint32_t,
                       std::conditional_t<calc_wire_size<T>() == 2U, std::uint16_t, std::uint8_t>>>;

template <typename T>
constexpr WireBits<T> to_bits(T value) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return __builtin_bit_cast(WireBits<T>, value);
    } else {
        return static_cast<WireBits<T>>(value);
    }
}
template <typename T>
constexpr T from_bits(WireBits<T> bits) noexcept {
    if constexpr (std::is_floating_point_v<T>) {
        return __builtin_bit_cast(T, bits);
    } else {
        return static_cast<T>(bits);
    }
}
/// True when consecutive values of T in memory equal their encoding; then a block of them is copied at once.
/// False for booleans and enumerations, because each of their values must be checked.
template <bool kIsBig, typename T>
inline constexpr bool kIsEncodedAsStored =
    std::is_arithmetic_v<T> && !std::is_same_v<T, bool> &&
    (sizeof(T) == 1U || kIsBig == (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__));

/// True when `bits` is a value of T: any bits for a number; only declared values for bool and enumerations.
template <typename T>
constexpr bool is_value(WireBits<T> bits) noexcept {
    if constexpr (std::is_same_v<T, bool>) {
        return bits <= 1U;
    } else if constexpr (std::is_enum_v<T>) {
        return bits < Enumerators<T>::kCount;
    } else {
        return true;
    }
}

}  // namespace detail

}  // namespace mamori

/// Declares, at global scope, that the enumerators of `Type` are 0 .. `Type::last` without a gap.
#define MAMORI_LAST_ENUMERATOR(Type, last)                                                   \
    template <>                                                                              \
    struct mamori::Enumerators<Type> {                                                       \
        static constexpr std::uint32_t kCount = static_cast<std::uint32_t>(Type::last) + 1U; \
    };

#endif  // MAMORI_KERNEL_CDR_SCALAR_HPP
