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

/// Maximum time that a later failure waits for the first. Closing the outputs takes milliseconds, also over a
/// field bus. A hanging handler must not delay the restart of the process much.
inline constexpr Duration kFailurePatience{1'000'000'000};

/// Lets a failed check of a second thread wait while the handler runs for the first thread. Calling context:
/// any thread.
void install_failure_gate() noexcept;

/// Called when the calling thread has received a crash signal. Async-signal-safe.
/// @return true: this thread must close the outputs; false: another thread closes them and had
///         kFailurePatience for this, or the calling thread crashed again in its own handler.
bool begin_crash() noexcept;
/// Called when the outputs are closed. Returns when no other thread handles a failed check, or after
/// kFailurePatience. Async-signal-safe.
void wait_for_failed_check() noexcept;

}  // namespace mamori::ports::posix_rt::detail

#endif  // MAMORI_PORTS_POSIX_RT_SRC_FAILURE_ORDER_HPP
