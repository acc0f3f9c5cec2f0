// SPDX-License-Identifier: Apache-2.0
#include "processor.hpp"

#include <sched.h>

#include <cstddef>

namespace mamori::time_faults {
namespace {

int find_first() noexcept {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof(set), &set) == 0) {
        for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
            if (CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
                return processor;
            }
        }
    }
    return 0;
}

}  // namespace

int find_processor() noexcept {
    static const int processor = find_first();
    return processor;
}

}  // namespace mamori::time_faults
