// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/march.hpp"

#include "mamori/safety/self_test/ram_area.hpp"

namespace mamori::safety {

static_assert(detail::calc_background_count<std::uint8_t>() == 4U);
static_assert(detail::calc_background_count<std::uint32_t>() == 6U);
static_assert(detail::make_background<std::uint32_t>(0U) == 0x00000000U);
static_assert(detail::make_background<std::uint32_t>(1U) == 0x55555555U);
static_assert(detail::make_background<std::uint32_t>(2U) == 0x33333333U);
static_assert(detail::make_background<std::uint32_t>(5U) == 0x0000FFFFU);

// Real memory, compiled here for every target.
template class RamMarch<RamArea>;
template class TransparentMarch<RamArea, 16U>;

}  // namespace mamori::safety
