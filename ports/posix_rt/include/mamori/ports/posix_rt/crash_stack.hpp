// SPDX-License-Identifier: Apache-2.0
/// @file
/// Alternate signal stack of a thread. After a stack overflow, the crash handlers cannot run on the stack of
/// the thread.
///
/// @satisfies SWR-PRT-026      Design: docs/design/posix_rt.md#crash-handlers
#ifndef MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP
#define MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP

#include <signal.h>

#include <array>
#include <cstddef>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

/// Alternate stack of one thread. The threads of windows and of the watchdog have one already. Each other
/// thread of the application, including the main thread, calls take().
///
/// Calling context: take() and give_back() on the thread that uses the stack. Memory: kSize, no heap.
class CrashStack final {
  public:
    /// [byte] The registers of a large processor take up to 11 KiB, a handler about 1 KiB.
    static constexpr std::size_t kSize = std::size_t{32U} * 1024U;

    constexpr CrashStack() noexcept = default;
    CrashStack(const CrashStack&) = delete;
    CrashStack& operator=(const CrashStack&) = delete;
    ~CrashStack() { give_back(); }

    /// @return kOk; kPreconditionNotMet (taken already); kOutOfResources (the registers of this processor do
    ///         not fit).
    Status take() noexcept;
    /// Restores the previous alternate stack of the thread. Without a successful take(), the call has no
    /// effect.
    void give_back() noexcept;

  private:
    alignas(16) std::array<std::byte, kSize> memory_{};
    stack_t previous_{};
    bool is_taken_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_CRASH_STACK_HPP
