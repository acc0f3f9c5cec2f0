// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a thread is at, so that a crash can be told by its component. The host of the windows notes it before
/// each step.
///
/// @satisfies SWR-PRT-027      Design: docs/design/posix_rt.md#crash-note
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP

#include <cstddef>
#include <cstdint>

namespace mamori::ports::posix_rt {

/// Places in the system table.
struct CrashPlace {
    static constexpr std::uint16_t kNone = 0xFFFFU;      ///< no window, no component
    static constexpr std::uint16_t kWatchdog = 0xFFFEU;  ///< as component: the thread of the watchdog

    std::uint16_t window{kNone};
    std::uint16_t component{kNone};
};

/// Of the calling thread, from here on. One store. @param[in] window, component places in the system table;
/// what is too large for a note is noted as kNone.
void set_crash_place(std::size_t window, std::size_t component) noexcept;
/// The calling thread is between two steps, or was never in one.
void clear_crash_place() noexcept;
/// The calling thread is that of the watchdog.
void set_crash_place_of_watchdog() noexcept;
/// Of the calling thread, also from a signal handler.
CrashPlace get_crash_place() noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP
