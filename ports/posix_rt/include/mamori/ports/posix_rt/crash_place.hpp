// SPDX-License-Identifier: Apache-2.0
/// @file
/// Window and component that a thread currently runs, so that a crash record can name them. The platform host
/// records them before each step.
///
/// @satisfies SWR-PRT-027      Design: docs/design/posix_rt.md#crash-note
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP

#include <cstddef>
#include <cstdint>

namespace mamori::ports::posix_rt {

/// Indices in the system table.
struct CrashPlace {
    static constexpr std::uint16_t kNone = 0xFFFFU;      ///< no window, no component
    static constexpr std::uint16_t kWatchdog = 0xFFFEU;  ///< value of `component` for the watchdog thread

    std::uint16_t window{kNone};
    std::uint16_t component{kNone};
};

/// Sets the values of the calling thread. One store.
/// @param[in] window, component indices in the system table; an index that is too large for a crash record is
///            recorded as kNone.
void set_crash_place(std::size_t window, std::size_t component) noexcept;
/// Records that the calling thread runs no step.
void clear_crash_place() noexcept;
/// Records that the calling thread is the watchdog thread.
void set_crash_place_of_watchdog() noexcept;
/// Values of the calling thread. Async-signal-safe.
CrashPlace get_crash_place() noexcept;

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_PLACE_HPP
