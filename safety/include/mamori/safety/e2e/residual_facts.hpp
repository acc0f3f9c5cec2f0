// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the compiler is told of the residual errors of frames with 16- and 32-bit checksums. Written by
/// verification/e2e/facts.py; a test makes it again and compares.
///
/// @satisfies SWR-E2E-023      Design: docs/design/e2e.md#residual-error
#ifndef MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
#define MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori::safety::detail {

/// Error patterns that pass in frames of one length.
struct ResidualFacts {
    std::size_t length{0U};      ///< of the frame with its header [bytes]
    std::uint32_t distance{0U};  ///< fewest turned bits that may pass
    double patterns{0.0};        ///< how many patterns of so many bits pass
    double ratio{0.0};           ///< greatest share of any higher weight that passes [2^-width]
};

// clang-format off: a row per line
/// Profiles 5 and 6.
inline constexpr std::array kResidualFacts16{
    ResidualFacts{3U, 8U, 27.0, 2.93},
    ResidualFacts{4U, 6U, 22.0, 2.06},
    ResidualFacts{5U, 4U, 8.0, 2.17},
    ResidualFacts{6U, 4U, 16.0, 2.36},
    ResidualFacts{7U, 4U, 32.0, 2.34},
    ResidualFacts{8U, 4U, 64.0, 2.23},
    ResidualFacts{10U, 4U, 119.0, 2.03},
    ResidualFacts{12U, 4U, 226.0, 3.00},
    ResidualFacts{14U, 4U, 374.0, 2.16},
    ResidualFacts{16U, 4U, 562.0, 8.07},
    ResidualFacts{20U, 4U, 1130.0, 2.01},
    ResidualFacts{24U, 4U, 2086.0, 2.04},
    ResidualFacts{28U, 4U, 3453.0, 5.25},
    ResidualFacts{32U, 4U, 5393.0, 4.02},
    ResidualFacts{40U, 4U, 12236.0, 2.57},
    ResidualFacts{48U, 4U, 25304.0, 2.01},
    ResidualFacts{56U, 4U, 48038.0, 2.01},
    ResidualFacts{64U, 4U, 83713.0, 2.01},
    ResidualFacts{96U, 4U, 438742.0, 2.01},
    ResidualFacts{128U, 4U, 1403925.0, 2.13},
    ResidualFacts{256U, 4U, 22541309.0, 2.38},
    ResidualFacts{512U, 4U, 357585719.0, 2.01},
    ResidualFacts{1024U, 4U, 5722070037.0, 2.07},
    ResidualFacts{2048U, 4U, 91597712219.0, 2.01},
    ResidualFacts{4093U, 4U, 1461591234300.0, 2.01},
    ResidualFacts{4096U, 2U, 16.0, 2.01},
};

/// Profiles 4, 8 and 44.
inline constexpr std::array kResidualFacts32{
    ResidualFacts{12U, 8U, 131.0, 2.04},
    ResidualFacts{16U, 8U, 836.0, 2.04},
    ResidualFacts{20U, 8U, 4694.0, 2.04},
    ResidualFacts{24U, 8U, 19428.0, 2.41},
    ResidualFacts{28U, 8U, 64696.0, 2.28},
    ResidualFacts{32U, 8U, 189888.0, 2.21},
    ResidualFacts{38U, 8U, 766055.0, 2.04},
    ResidualFacts{48U, 6U, 349.0, 2.01},
    ResidualFacts{56U, 6U, 2103.0, 2.60},
    ResidualFacts{64U, 6U, 7073.0, 4.56},
    ResidualFacts{96U, 6U, 116688.0, 2.69},
    ResidualFacts{128U, 6U, 707853.0, 2.08},
    ResidualFacts{256U, 6U, 47164999.0, 2.14},
    ResidualFacts{512U, 6U, 3045828262.0, 2.02},
    ResidualFacts{1024U, 6U, 195133888326.0, 2.01},
    ResidualFacts{2048U, 6U, 12500339567322.0, 2.01},
    ResidualFacts{4096U, 6U, 800373286599232.0, 2.01},
    ResidualFacts{8191U, 4U, 536625180.0, 2.01},
};
// clang-format on

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
