// SPDX-License-Identifier: Apache-2.0
/// @file
/// How one window instance ended, as Executive::run_window() returns it.
///
/// @satisfies SWR-KRN-022, SWR-KRN-034      Design: docs/design/kernel.md#windows
#ifndef MAMORI_KERNEL_WINDOW_OUTCOME_HPP
#define MAMORI_KERNEL_WINDOW_OUTCOME_HPP

#include <cstdint>

namespace mamori {

enum class WindowOutcome : std::uint8_t {
    kCompleted,  ///< every component completed both passes; the outputs are published
    kOverrun,    ///< the budget was exhausted, or earlier work still hangs; no output was published
    kMissed,     ///< it would have started after its planned end; no component ran, and none is responsible
    kStopped,    ///< the context is Stopped; no cycle ran, at most what stop() had to leave for later
    kNotDue,     ///< no cycle in this window instance: a slower rate omits it, or no tick has come
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_OUTCOME_HPP
