// SPDX-License-Identifier: Apache-2.0
/// @file
/// A second stack of a thread for the handlers of a crash, since a thread that has used up its own has none
/// left to run them on.
///
/// @satisfies SWR-PRT-026      Design: docs/design/posix_rt.md#crash-handlers
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP

#include <signal.h>

#include <array>
#include <cstddef>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// Stack of one thread. The threads of windows and of the watchdog have theirs; a thread of the application,
/// the main one included, takes its own.
///
/// Calling context: take() and give_back() on the thread that it is for. Memory: kSize, and no heap.
class CrashStack final {
  public:
    /// [byte] The registers of a large machine take 11 KiB of it, a handler about one.
    static constexpr std::size_t kSize = std::size_t{32U} * 1024U;

    constexpr CrashStack() noexcept = default;
    CrashStack(const CrashStack&) = delete;
    CrashStack& operator=(const CrashStack&) = delete;
    ~CrashStack() { give_back(); }

    /// @return kOk; kPreconditionNotMet (taken already); kOutOfResources (the registers of this machine do
    ///         not fit).
    Status take() noexcept;
    /// The thread has again what it had before; without a stack that is taken it does nothing.
    void give_back() noexcept;

  private:
    alignas(16) std::array<std::byte, kSize> memory_{};
    stack_t previous_{};
    bool is_taken_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP
