// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/redundancy/clock_ratio.hpp"

#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

namespace {

/// `part_ppm` of a time, rounded down; cannot overflow for a part below the whole.
constexpr std::int64_t calc_part(Duration time, std::uint32_t part_ppm) noexcept {
    constexpr std::int64_t kWholePpm = 1000000;
    return time.ns / kWholePpm * part_ppm + time.ns % kWholePpm * part_ppm / kWholePpm;
}

}  // namespace

ClockVerdict ClockRatio::judge(const Readings& now) const noexcept {
    const Duration reference = calc_elapsed(begun_.reference, now.reference);
    const Duration checked = calc_elapsed(begun_.checked, now.checked);
    const std::int64_t allowed = calc_part(reference, limits_.deviation_ppm);
    const std::int64_t deviation = checked.ns - reference.ns;  // neither is negative
    return deviation < -allowed || deviation > allowed ? ClockVerdict::kViolated : ClockVerdict::kGood;
}

ClockVerdict ClockRatio::step(Instant reference, Instant checked) noexcept {
    if (verdict_ == ClockVerdict::kViolated) {
        return verdict_;
    }
    const Readings now{reference, checked};
    if (!has_begun_) {
        has_begun_ = true;
        begun_ = now;
    } else if (reference < last_.reference || checked < last_.checked) {
        verdict_ = ClockVerdict::kViolated;
    } else if (calc_elapsed(begun_.reference, reference) >= limits_.window ||
               calc_elapsed(begun_.checked, checked) >= limits_.window) {
        verdict_ = judge(now);
        begun_ = now;
    }
    last_ = now;
    return verdict_;
}

Status ClockRatio::acknowledge() noexcept {
    if (verdict_ != ClockVerdict::kViolated) {
        return Status::kPreconditionNotMet;
    }
    verdict_ = ClockVerdict::kMeasuring;
    has_begun_ = false;
    return Status::kOk;
}

}  // namespace mamori::safety
