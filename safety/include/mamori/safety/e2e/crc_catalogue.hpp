// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parameters of the checksums that AUTOSAR names. The values are facts; each has its published check values
/// as a test.
///
/// @satisfies SWR-E2E-001      Design: docs/design/e2e.md#checksums
/// Source:   AUTOSAR SWS CRC Library; SAE J1850; IEEE 802.3; ECMA-182
#ifndef MAMORI_SAFETY_E2E_CRC_CATALOGUE_HPP
#define MAMORI_SAFETY_E2E_CRC_CATALOGUE_HPP

#include <cstdint>

#include "mamori/safety/e2e/crc.hpp"

namespace mamori::safety {

/// SAE J1850, as the library of AUTOSAR starts it.
inline constexpr CrcParameters<std::uint8_t> kCrc8{0x1DU, 0xFFU, false, 0xFFU};
/// The same polynomial as profiles 1 and 11 use it: they start the library "not for the first time" with FF.
inline constexpr CrcParameters<std::uint8_t> kCrc8E2e{0x1DU, 0x00U, false, 0x00U};
/// Profiles 2 and 22.
inline constexpr CrcParameters<std::uint8_t> kCrc8H2f{0x2FU, 0xFFU, false, 0xFFU};
/// CCITT-FALSE: profiles 5 and 6.
inline constexpr CrcParameters<std::uint16_t> kCrc16{0x1021U, 0xFFFFU, false, 0x0000U};
inline constexpr CrcParameters<std::uint16_t> kCrc16Arc{0x8005U, 0x0000U, true, 0x0000U};
/// Ethernet.
inline constexpr CrcParameters<std::uint32_t> kCrc32{0x04C11DB7U, 0xFFFFFFFFU, true, 0xFFFFFFFFU};
/// Profiles 4, 8 and 44.
inline constexpr CrcParameters<std::uint32_t> kCrc32P4{0xF4ACFB13U, 0xFFFFFFFFU, true, 0xFFFFFFFFU};
/// Profile 7.
inline constexpr CrcParameters<std::uint64_t> kCrc64{0x42F0E1EBA9EA3693U, 0xFFFFFFFFFFFFFFFFU, true,
                                                     0xFFFFFFFFFFFFFFFFU};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_CRC_CATALOGUE_HPP
