// SPDX-License-Identifier: Apache-2.0
#include "reference_work.hpp"

#include <algorithm>
#include <numeric>

#include "mamori/kernel/base/crc32.hpp"

namespace mamori::timing {

ReferenceWork::ReferenceWork() noexcept {
    std::iota(data_.begin(), data_.end(), std::uint8_t{0U});
}

void ReferenceWork::run() noexcept {
    Crc32 crc;
    for (const std::uint8_t byte : data_) {
        crc.add(byte);
    }
    sink_ = crc.get_value();
}

Duration take_median(std::array<std::int64_t, kReferenceCount>& times) noexcept {
    std::nth_element(times.begin(), times.begin() + times.size() / 2U, times.end());
    return Duration{times[times.size() / 2U]};
}

Duration measure_reference(const ports::posix_rt::FrameClock& clock) noexcept {
    ReferenceWork work;
    std::array<std::int64_t, kReferenceCount> times{};
    for (std::int64_t& time : times) {
        const Instant begin = clock.get_now();
        work.run();
        time = (clock.get_now() - begin).ns;
    }
    return take_median(times);
}

}  // namespace mamori::timing
