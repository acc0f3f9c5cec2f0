// SPDX-License-Identifier: Apache-2.0
/// @file
/// Options of a machine with long limits, so that only faults that a test injects are found.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_PATIENT_OPTIONS_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_PATIENT_OPTIONS_HPP

#include <atomic>

#include "mamori/ports/posix_rt/machine_options.hpp"

namespace mamori::ports::posix_rt {

/// Calls of the function that closes the outputs.
inline std::atomic<int> g_closed{0};
inline void count_closing(void*) noexcept {
    ++g_closed;
}

inline MachineOptions make_options() {
    using literals::operator""_ms;
    using literals::operator""_s;
    MachineOptions options;
    options.outputs = {&count_closing, nullptr};
    options.lead = 5_ms;
    options.watch = {60_s, 2_ms, {10_s, 200'000}};
    options.watchdog_timeout = 100_s;
    return options;
}

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_PATIENT_OPTIONS_HPP
