// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an executive calls of SystemModes. Virtual, so that an executive without SystemModes links no mode
/// switch. Not for users.
///
/// @satisfies SWR-KRN-071      Design: docs/design/kernel.md#parts-that-a-table-does-not-use
#ifndef MAMORI_KERNEL_MODE_EXECUTION_HPP
#define MAMORI_KERNEL_MODE_EXECUTION_HPP

#include <cstddef>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori::detail {

class ModeFollower;
struct WindowState;

/// Each function executes the one of the follower that calls it, on the core of the follower.
class ModeExecution {
  public:
    ModeExecution(const ModeExecution&) = delete;
    ModeExecution& operator=(const ModeExecution&) = delete;

    virtual Status initialize_core(ModeFollower& follower) noexcept = 0;
    virtual Status join_core(ModeFollower& follower) noexcept = 0;
    virtual void leave_core(ModeFollower& follower) noexcept = 0;
    virtual void begin_core_frame(ModeFollower& follower) noexcept = 0;
    virtual std::size_t open_window(ModeFollower& follower, WindowState& state, Instant deadline,
                                    WindowHost& host) noexcept = 0;
    virtual std::size_t close_window(ModeFollower& follower, WindowState& state, Instant deadline,
                                     WindowHost& host) noexcept = 0;

  protected:
    constexpr ModeExecution() noexcept = default;
    ~ModeExecution() = default;
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_MODE_EXECUTION_HPP
