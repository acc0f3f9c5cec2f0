// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks that a region which nobody may write, code or constants, still is what was built: its CRC-32
/// against the checksum of the build, or against that of the first pass.
///
/// @satisfies SWR-SLF-007, SWR-CYC-024      Design: docs/design/self_tests.md#code-and-constants
/// Source:   IEC 61508-7:2010 A.4 (signature of invariable memory)
#ifndef MAMORI_SAFETY_SELF_TEST_REGION_CRC_HPP
#define MAMORI_SAFETY_SELF_TEST_REGION_CRC_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/crc.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// CRC-32 (Ethernet) of one region. Several regions are several tests of one schedule.
///
/// Thread safety: none. Time: a step is O(bytes per step). Memory: no heap; one table of 1 KiB in all.
class RegionCrc final : public SelfTest {
  public:
    /// @param[in] region         size >= 1.
    /// @param[in] expected       its CRC-32 as built.
    /// @param[in] bytes_per_step >= 1.
    constexpr RegionCrc(Span<const std::byte> region, std::uint32_t expected,
                        std::size_t bytes_per_step) noexcept
        : first_(region.data()),
          size_(region.size()),
          bytes_per_step_(bytes_per_step),
          expected_(expected),
          has_reference_(true) {
        MAMORI_REQUIRE(1, !region.empty() && bytes_per_step >= 1U);
    }
    /// Without a checksum of the build: that of the first pass since power-up is the reference. A change
    /// before the end of this pass is not found.
    /// @param[in] object constant; must outlive this object. @param[in] bytes_per_step >= 1.
    template <typename T>
    constexpr RegionCrc(const T& object, std::size_t bytes_per_step) noexcept
        : first_(&object), size_(sizeof(T)), bytes_per_step_(bytes_per_step) {
        MAMORI_REQUIRE(2, bytes_per_step >= 1U);
    }

    void begin() noexcept override;
    SelfTestStatus step() noexcept override;
    std::size_t get_step_count() const noexcept override {
        return (size_ + bytes_per_step_ - 1U) / bytes_per_step_;
    }

  private:
    const void* first_;
    std::size_t size_;
    std::size_t bytes_per_step_;
    std::size_t next_{0U};
    std::uint32_t expected_{0U};
    bool has_reference_{false};
    Crc<kCrc32, 1U> crc_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_REGION_CRC_HPP
