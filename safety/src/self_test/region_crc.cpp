// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/region_crc.hpp"

#include "mamori/safety/base/opaque.hpp"

namespace mamori::safety {

void RegionCrc::begin() noexcept {
    next_ = 0U;
    crc_ = Crc<kCrc32, 1U>{};
}

SelfTestStatus RegionCrc::step() noexcept {
    forget(first_);  // constants are what the memory says, not what the compiler knows
    const Span<const std::byte> region{static_cast<const std::byte*>(first_), size_};
    const std::size_t rest = size_ - next_;
    const std::size_t count = rest < bytes_per_step_ ? rest : bytes_per_step_;
    crc_.add(region.subspan(next_, count));
    next_ += count;
    if (next_ < size_) {
        return SelfTestStatus::kRunning;
    }
    if (!has_reference_) {
        expected_ = crc_.get_value();
        has_reference_ = true;
    }
    return crc_.get_value() == expected_ ? SelfTestStatus::kPassed : SelfTestStatus::kFailed;
}

}  // namespace mamori::safety
