// SPDX-License-Identifier: Apache-2.0
/// @file
/// Order among the failures of several threads: one closes the outputs, the others wait before they end the
/// process. Used by the handlers of a crash and by the gate of failed checks.
///
/// @satisfies SWR-PRT-045      Design: docs/design/posix_rt.md#failures-of-several-threads
#ifndef MAMORI_PORTS_POSIX_RT_SRC_FAILURE_ORDER_HPP
#define MAMORI_PORTS_POSIX_RT_SRC_FAILURE_ORDER_HPP

#include "mamori/kernel/base/time.hpp"

namespace mamori::ports::posix_rt::detail {

/// How long a later failure waits for the first. Closing the outputs takes milliseconds, also over a field
/// bus; a handler that hangs must not keep the process alive much longer than a supervisor takes to restart
/// it.
inline constexpr Duration kFailurePatience{1'000'000'000};

/// From here on a failed check of a second thread waits while the handler runs for the first. Any thread.
void install_failure_gate() noexcept;

/// A crash signal has come to the calling thread. Async-signal-safe.
/// @return true: it closes the outputs; false: another thread does and has had kFailurePatience for it, or
/// the
///         calling thread crashed again in its own handler.
bool begin_crash() noexcept;
/// The outputs are closed. Returns when no other thread handles a failed check any more, or after
/// kFailurePatience. Async-signal-safe.
void wait_for_failed_check() noexcept;

}  // namespace mamori::ports::posix_rt::detail

#endif  // MAMORI_PORTS_POSIX_RT_SRC_FAILURE_ORDER_HPP
