// SPDX-License-Identifier: Apache-2.0
/// @file
/// The threads of the test program.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_THREADS_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_THREADS_HPP

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <string>

namespace mamori::ports::posix_rt {

inline std::set<pid_t> find_threads() {
    std::set<pid_t> threads;
    for (const auto& entry : std::filesystem::directory_iterator{"/proc/self/task"}) {
        threads.insert(std::stoi(entry.path().filename().string()));
    }
    return threads;
}

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_THREADS_HPP
