// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/rate_check.hpp"

#include <limits>

namespace mamori::ports::posix_rt {
namespace {

constexpr int kTries = 3;
constexpr std::int64_t kMillion = 1'000'000;

}  // namespace

ClockPair read_pair(const FrameClock& watched, const ClockReading& reference) noexcept {
    ClockPair best{};
    std::int64_t narrowest = std::numeric_limits<std::int64_t>::max();
    for (int i = 0; i < kTries; ++i) {
        const std::int64_t before = reference.read_ns();
        const Instant now = watched.get_now();
        const std::int64_t width = reference.read_ns() - before;
        if (width < narrowest) {
            narrowest = width;
            best = {now, before + width / 2, Duration{width / 2 + 1}};
        }
    }
    return best;
}

void RateCheck::restart() noexcept {
    has_begun_ = false;
    sound_spans_ = 0U;
}

void RateCheck::begin(const ClockPair& pair) noexcept {
    begin_ = pair;
    has_begun_ = true;
}

Rate RateCheck::look(const ClockPair& pair) noexcept {
    if (!has_begun_) {
        begin(pair);
        return Rate::kSound;
    }
    const std::int64_t passed = pair.reference_ns - begin_.reference_ns;
    const std::int64_t gained = (pair.watched - begin_.watched).ns - passed;
    const std::int64_t slack = pair.uncertainty.ns + begin_.uncertainty.ns;
    // After a late call, the comparison covers more than a span. The limit then refers to the elapsed time.
    const std::int64_t over = passed > limits_.span.ns ? passed : limits_.span.ns;
    const std::int64_t allowed =
        over / kMillion * limits_.limit_ppm + over % kMillion * limits_.limit_ppm / kMillion;
    if (gained > allowed + slack || gained < -allowed - slack) {
        restart();
        return gained > 0 ? Rate::kFast : Rate::kSlow;
    }
    if (passed >= limits_.span.ns) {
        ++sound_spans_;
        begin(pair);
    }
    return Rate::kSound;
}

}  // namespace mamori::ports::posix_rt
