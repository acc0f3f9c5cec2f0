// SPDX-License-Identifier: Apache-2.0
/// @file
/// SIGINT and SIGTERM as a request to stop the system. A handler that the application had before is called
/// after the stop.
///
/// @satisfies SWR-PRT-072      Design: docs/design/posix_rt.md#machine
#ifndef MAMORI_PORTS_POSIX_RT_STOP_SIGNALS_HPP
#define MAMORI_PORTS_POSIX_RT_STOP_SIGNALS_HPP

#include <array>
#include <csignal>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::posix_rt {

inline constexpr std::array<int, 2U> kStopSignals{SIGINT, SIGTERM};

/// Receives the signals while it is installed.
class StopListener {
  public:
    /// Called in a signal handler, on any thread, for each signal: system calls and stores only.
    virtual void on_stop_signal(int signal) noexcept = 0;

  protected:
    ~StopListener() = default;
};

/// Handlers of this process. One object of a process can be installed at a time.
///
/// Calling context: any thread, outside a signal handler. Memory: no heap.
class StopSignals final {
  public:
    constexpr StopSignals() noexcept = default;
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals() { remove(); }

    /// A signal that is ignored (SIG_IGN), as a shell does for background programs, stays ignored.
    /// @param[in] listener must outlive the process: a handler may still run on another
    ///            thread after remove().
    /// @return kOk; kPreconditionNotMet (an object is installed in this process).
    Status install(StopListener& listener) noexcept;
    /// Restores the previous handlers. Without an installation, the call has no effect.
    void remove() noexcept;
    /// To be called after remove(). Raises the signal again if the application had its own handler for it.
    void forward(int signal) const noexcept;

  private:
    std::array<struct sigaction, kStopSignals.size()> previous_{};
    bool is_installed_{false};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_STOP_SIGNALS_HPP
