// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/redundancy/time_base_check.hpp"

namespace mamori::safety {

namespace {

constexpr std::uint32_t kHalf = 1U << 31U;  ///< of what a counter counts: a step of so many may be one back

/// Distance on the ring of the counter, the shorter way.
constexpr std::uint32_t calc_distance(std::uint32_t a, std::uint32_t b) noexcept {
    const std::uint32_t forward = b - a;
    return forward < kHalf ? forward : a - b;
}

}  // namespace

TimeBaseFinding TimeBaseCheck::step(const ChannelTime& own, const ChannelTime& other) noexcept {
    if (finding_ != TimeBaseFinding::kNone) {
        return finding_;
    }
    const ClockVerdict clocks = clocks_.step(own.now, other.now);
    const bool has_own_gone_back = own.cycle - own_cycle_ >= kHalf;
    const bool has_other_gone_back = other.cycle - other_cycle_ >= kHalf;
    if (has_begun_ && (has_own_gone_back || has_other_gone_back)) {
        finding_ = TimeBaseFinding::kSteppedBack;
    } else if (calc_distance(own.cycle, other.cycle) > cycles_apart_max_) {
        finding_ = TimeBaseFinding::kCyclesApart;
    } else if (clocks == ClockVerdict::kViolated) {
        finding_ = TimeBaseFinding::kClocksApart;
    }
    has_begun_ = true;
    own_cycle_ = own.cycle;
    other_cycle_ = other.cycle;
    return finding_;
}

Status TimeBaseCheck::acknowledge() noexcept {
    if (finding_ == TimeBaseFinding::kNone) {
        return Status::kPreconditionNotMet;
    }
    static_cast<void>(clocks_.acknowledge());  // the finding may be another one
    finding_ = TimeBaseFinding::kNone;
    has_begun_ = false;
    return Status::kOk;
}

}  // namespace mamori::safety
