// SPDX-License-Identifier: Apache-2.0
/// @file
/// The receiving thread of a transport: without real-time priority, without signals, ended through a
/// descriptor. Not for users.
///
/// @satisfies SWR-LCM-007      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_LINK_THREAD_HPP
#define MAMORI_PORTS_LCM_LINK_THREAD_HPP

#include <pthread.h>

#include "mamori/kernel/base/status.hpp"

namespace mamori::ports::lcm::detail {

using ThreadCall = void* (*)(void*);

/// Starts `call(argument)` at the default priority, which no window has, with any priority of the caller. Its
/// stack has 256 KiB.
/// @param[out] stop descriptor that becomes readable in stop_thread(). @return kOk; kError.
Status start_thread(pthread_t& thread, int& stop, ThreadCall call, void* argument) noexcept;

/// Makes `stop` readable, waits for the end of the thread and closes `stop`, which becomes -1.
void stop_thread(pthread_t thread, int& stop) noexcept;

/// Waits until `file` or `stop` is readable. @return true: `file`; false: `stop`, or `file` has an error.
bool wait_for(int file, int stop) noexcept;

}  // namespace mamori::ports::lcm::detail

#endif  // MAMORI_PORTS_LCM_LINK_THREAD_HPP
