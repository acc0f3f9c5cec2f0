// SPDX-License-Identifier: Apache-2.0
/// @file
/// CRC-32/ISO-HDLC, computed byte by byte: checksum of stored records.
///
/// @satisfies SWR-REC-001      Design: docs/design/recorder.md#checksum
/// Source:   ISO/IEC 13239 and IEEE 802.3: polynomial 04C11DB7 (reflected EDB88320), register begins as
///           FFFFFFFF, bits reflected, result inverted; the check value over "123456789" is CBF43926
#ifndef MAMORI_KERNEL_CRC32_HPP
#define MAMORI_KERNEL_CRC32_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori {

namespace detail {
/// CRC remainder of each byte value: 1 KiB of constants.
constexpr std::array<std::uint32_t, 256U> make_crc32_table() noexcept {
    std::array<std::uint32_t, 256U> table{};
    for (std::uint32_t value = 0U; value < 256U; ++value) {
        std::uint32_t remainder = value;
        for (int bit = 0; bit < 8; ++bit) {
            remainder = (remainder & 1U) != 0U ? (remainder >> 1U) ^ 0xEDB88320U : remainder >> 1U;
        }
        table[value] = remainder;
    }
    return table;
}

inline constexpr std::array<std::uint32_t, 256U> kCrc32Table = make_crc32_table();
}  // namespace detail

/// Checksum over bytes that are added in storage order.
///
/// Thread safety: none. Time: O(1) per byte. Memory: four bytes, plus the shared table.
class Crc32 final {
  public:
    constexpr void add(std::uint8_t byte) noexcept {
        register_ = (register_ >> 8U) ^ detail::kCrc32Table[(register_ ^ byte) & 0xFFU];
    }
    /// Checksum of all bytes added; 0 when no byte was added.
    constexpr std::uint32_t get_value() const noexcept { return ~register_; }

  private:
    std::uint32_t register_{0xFFFFFFFFU};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_CRC32_HPP
