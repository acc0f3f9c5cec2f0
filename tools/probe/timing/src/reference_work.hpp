// SPDX-License-Identifier: Apache-2.0
/// @file
/// A fixed piece of work that measures the current speed of the host: a checksum over 4 KiB.
#ifndef MAMORI_TIMING_REFERENCE_WORK_HPP
#define MAMORI_TIMING_REFERENCE_WORK_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"

namespace mamori::timing {

/// The work and its data. Calling context: any. Time: microseconds. Memory: 4 KiB of its own.
class ReferenceWork final {
  public:
    ReferenceWork() noexcept;
    void run() noexcept;

  private:
    std::array<std::uint8_t, 4096U> data_{};
    volatile std::uint32_t sink_{0U};
};

/// Number of repetitions for the median.
inline constexpr std::size_t kReferenceCount = 201U;

/// @return the median of `times`, which are reordered.
Duration take_median(std::array<std::int64_t, kReferenceCount>& times) noexcept;

/// Median time of the work.
Duration measure_reference(const ports::posix_rt::FrameClock& clock) noexcept;

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_REFERENCE_WORK_HPP
