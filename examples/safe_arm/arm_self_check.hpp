// SPDX-License-Identifier: Apache-2.0
/// @file
/// Self tests that the safety partition repeats from power-up on: of the constant system table, and of the
/// memory of the measured values.
///
/// @satisfies SWR-SAF-060      Design: docs/design/safe_arm.md#self-tests
#ifndef EXAMPLES_SAFE_ARM_ARM_SELF_CHECK_HPP
#define EXAMPLES_SAFE_ARM_ARM_SELF_CHECK_HPP

#include "arm_faults.hpp"
#include "arm_limits.hpp"
#include "mamori/safety/cycle/system.hpp"
#include "mamori/safety/self_test/march.hpp"
#include "mamori/safety/self_test/ram_area.hpp"
#include "mamori/safety/self_test/region_crc.hpp"

namespace safe_arm {

/// A lasting fault is found within this time: two passes of the longer test, with room for larger tables.
inline constexpr mamori::Duration kSelfTestFoundWithin = 1000_ms;
/// Size of a step: the cycle has a few hundred instructions for it.
inline constexpr std::size_t kTableBytesPerStep = 32U;
inline constexpr std::size_t kMarchWordsPerStep = 2U;

/// The tests of one program, in static storage. Declare them before its table and define them after it.
struct ArmSelfCheck {
    /// @param[in] system   constant table. @param[in] measured used by this partition only, and not during a
    ///                     step. Both must outlive this object.
    template <typename System>
    constexpr ArmSelfCheck(const System& system, mamori::safety::ArmInputs& measured) noexcept
        : table(system, kTableBytesPerStep), area(&measured, sizeof(measured) / sizeof(Area::Word)) {}
    ArmSelfCheck(const ArmSelfCheck&) = delete;
    ArmSelfCheck& operator=(const ArmSelfCheck&) = delete;

    using Area = mamori::safety::RamArea;
    static_assert(sizeof(mamori::safety::ArmInputs) % sizeof(Area::Word) == 0U &&
                  alignof(mamori::safety::ArmInputs) >= alignof(Area::Word));

    mamori::safety::RegionCrc table;
    Area area;
    mamori::safety::TransparentMarch<Area, kMarchWordsPerStep> memory{area};
};

/// Rows of the table.
constexpr auto make_arm_self_check(ArmSelfCheck& tests) noexcept {
    using namespace mamori::safety;  // NOLINT: the words of a row
    return mamori::parts(
        self_test(tests.table, found_within(kSelfTestFoundWithin), raises(ArmFault::kSelfTestFailed)),
        self_test(tests.memory, found_within(kSelfTestFoundWithin), raises(ArmFault::kSelfTestFailed)));
}

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_SELF_CHECK_HPP
