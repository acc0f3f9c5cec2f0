// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/region_crc.hpp"

#include "mamori/safety/base/opaque.hpp"

namespace mamori::safety {

void RegionCrc::begin() noexcept {
    next_ = 0U;
    crc_ = Crc<kCrc32, 1U>{};
}

SelfTestStatus RegionCrc::step() noexcept {
    forget(region_.data());  // constants are what the memory says, not what the compiler knows
    const std::size_t rest = region_.size() - next_;
    const std::size_t count = rest < bytes_per_step_ ? rest : bytes_per_step_;
    crc_.add(region_.subspan(next_, count));
    next_ += count;
    if (next_ < region_.size()) {
        return SelfTestStatus::kRunning;
    }
    return crc_.get_value() == expected_ ? SelfTestStatus::kPassed : SelfTestStatus::kFailed;
}

}  // namespace mamori::safety
