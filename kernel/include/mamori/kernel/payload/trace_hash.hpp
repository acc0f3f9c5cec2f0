// SPDX-License-Identifier: Apache-2.0
/// @file
/// Hash over all values that ports publish. Two runs with equal hashes published the same values at the same
/// instants. Tests compare runs by this hash.
///
/// @satisfies SWR-KRN-006      Design: docs/design/kernel.md#determinism
/// Source:   FNV-1a, 64 bit (offset basis cbf29ce484222325, prime 100000001b3), draft-eastlake-fnv
#ifndef MAMORI_KERNEL_TRACE_HASH_HPP
#define MAMORI_KERNEL_TRACE_HASH_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/payload/fields.hpp"

namespace mamori {

/// FNV-1a over scalars, each as its value bits in little-endian order, independent of the byte order of the
/// host. Payloads of fixed-width types have the same hash on every host; those with `long` or `size_t` do
/// not.
///
/// Thread safety: none. Time: O(bytes). Memory: eight bytes.
class TraceHash final {
  public:
    /// Adds one number, bool or enum. Negative and positive zero differ; every NaN pattern differs.
    template <typename T>
    constexpr void operator()(T scalar) noexcept {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        if constexpr (std::is_floating_point_v<T>) {
            static_assert(sizeof(T) == sizeof(std::uint64_t) || sizeof(T) == sizeof(std::uint32_t));
            using Bits = std::conditional_t<sizeof(T) == sizeof(std::uint64_t), std::uint64_t, std::uint32_t>;
            add_bits(__builtin_bit_cast(Bits, scalar), sizeof scalar);
        } else {
            add_bits(static_cast<std::uint64_t>(scalar), sizeof scalar);
        }
    }

    /// Adds every scalar of a payload in declaration order, as visit_scalars(); padding is not included.
    template <typename T>
    constexpr void add(const T& payload) noexcept {
        visit_scalars(payload, *this);
    }

    /// Hash of all data added; the offset basis when no data was added.
    constexpr std::uint64_t get_value() const noexcept { return value_; }

  private:
    constexpr void add_bits(std::uint64_t bits, std::size_t byte_count) noexcept {
        for (std::size_t i = 0U; i < byte_count; ++i) {
            value_ = (value_ ^ ((bits >> (8U * i)) & 0xFFU)) * 0x100000001B3U;
        }
    }

    std::uint64_t value_{0xCBF29CE484222325U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_TRACE_HASH_HPP
