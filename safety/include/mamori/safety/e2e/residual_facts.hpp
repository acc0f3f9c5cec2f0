// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the compiler is told of the residual errors of frames with 16- and 32-bit checksums. Written by
/// tools/mamori_tools/e2e/facts.py; a test makes it again and compares.
///
/// @satisfies SWR-E2E-023      Design: docs/design/e2e.md#residual-error
#ifndef MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
#define MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/wire.hpp"

namespace mamori::safety::detail {

/// Error patterns that pass in frames of one length.
struct ResidualFacts {
    std::size_t length;              ///< of the frame with its header [bytes]
    std::uint32_t distance;          ///< fewest turned bits that may pass
    std::uint64_t patterns;          ///< how many patterns of so many bits pass, below 2^53
    std::uint32_t share_hundredths;  ///< greatest share of any higher weight that passes [2^-width / 100]
};

/// Checksum of all rows: a row that was changed by hand does not compile.
template <std::size_t kRows>
constexpr std::uint32_t calc_fingerprint(const std::array<ResidualFacts, kRows>& rows) noexcept {
    Crc<kCrc32, 1U> crc;
    for (const ResidualFacts& row : rows) {
        const std::array<std::uint64_t, 4U> values{row.length, row.distance, row.patterns,
                                                   row.share_hundredths};
        for (const std::uint64_t value : values) {
            for (unsigned place = 0U; place < sizeof(value); ++place) {
                crc.add(get_byte(value, place));
            }
        }
    }
    return crc.get_value();
}

// clang-format off: a row per line
/// Profiles 5 and 6.
inline constexpr std::array kResidualFacts16{
    ResidualFacts{3U, 8U, 27U, 293U},
    ResidualFacts{4U, 6U, 22U, 206U},
    ResidualFacts{5U, 4U, 8U, 217U},
    ResidualFacts{6U, 4U, 16U, 236U},
    ResidualFacts{7U, 4U, 32U, 234U},
    ResidualFacts{8U, 4U, 64U, 223U},
    ResidualFacts{10U, 4U, 119U, 203U},
    ResidualFacts{12U, 4U, 226U, 300U},
    ResidualFacts{14U, 4U, 374U, 216U},
    ResidualFacts{16U, 4U, 562U, 807U},
    ResidualFacts{20U, 4U, 1130U, 201U},
    ResidualFacts{24U, 4U, 2086U, 204U},
    ResidualFacts{28U, 4U, 3453U, 525U},
    ResidualFacts{32U, 4U, 5393U, 402U},
    ResidualFacts{40U, 4U, 12236U, 257U},
    ResidualFacts{48U, 4U, 25304U, 201U},
    ResidualFacts{56U, 4U, 48038U, 201U},
    ResidualFacts{64U, 4U, 83713U, 201U},
    ResidualFacts{96U, 4U, 438742U, 201U},
    ResidualFacts{128U, 4U, 1403925U, 213U},
    ResidualFacts{256U, 4U, 22541309U, 238U},
    ResidualFacts{512U, 4U, 357585719U, 201U},
    ResidualFacts{1024U, 4U, 5722070037U, 207U},
    ResidualFacts{2048U, 4U, 91597712219U, 201U},
    ResidualFacts{4093U, 4U, 1461591234300U, 201U},
    ResidualFacts{4096U, 2U, 16U, 201U},
};
static_assert(calc_fingerprint(kResidualFacts16) == 0x5E26C0D5U, "a row was changed; run facts.py");

/// Profiles 4, 8 and 44.
inline constexpr std::array kResidualFacts32{
    ResidualFacts{12U, 8U, 131U, 204U},
    ResidualFacts{16U, 8U, 836U, 204U},
    ResidualFacts{20U, 8U, 4694U, 204U},
    ResidualFacts{24U, 8U, 19428U, 241U},
    ResidualFacts{28U, 8U, 64696U, 228U},
    ResidualFacts{32U, 8U, 189888U, 221U},
    ResidualFacts{38U, 8U, 766055U, 204U},
    ResidualFacts{48U, 6U, 349U, 201U},
    ResidualFacts{56U, 6U, 2103U, 260U},
    ResidualFacts{64U, 6U, 7073U, 456U},
    ResidualFacts{96U, 6U, 116688U, 269U},
    ResidualFacts{128U, 6U, 707853U, 208U},
    ResidualFacts{256U, 6U, 47164999U, 214U},
    ResidualFacts{512U, 6U, 3045828262U, 202U},
    ResidualFacts{1024U, 6U, 195133888326U, 201U},
    ResidualFacts{2048U, 6U, 12500339567322U, 201U},
    ResidualFacts{4096U, 6U, 800373286599232U, 201U},
    ResidualFacts{8191U, 4U, 536625180U, 201U},
};
static_assert(calc_fingerprint(kResidualFacts32) == 0xF4FD7F5BU, "a row was changed; run facts.py");
// clang-format on

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
