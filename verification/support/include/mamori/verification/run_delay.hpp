// SPDX-License-Identifier: Apache-2.0
/// @file
/// Time that a thread was ready but did not run, as the kernel counts it (/proc/thread-self/schedstat).
#ifndef MAMORI_VERIFICATION_RUN_DELAY_HPP
#define MAMORI_VERIFICATION_RUN_DELAY_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori::verification {

/// Thread safety: for one thread, the first that calls take(). Memory: none. The file stays open until the
/// process ends, because a released thread may still read it.
class RunDelayMeter final {
  public:
    /// @return the delay since the previous call; 0 at the first call, or if the kernel does not count it.
    Duration take() noexcept;

  private:
    std::int64_t last_ns_{0};
    int descriptor_{-1};
    bool is_open_{false};
};

}  // namespace mamori::verification

#endif  // MAMORI_VERIFICATION_RUN_DELAY_HPP
