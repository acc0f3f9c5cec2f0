// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/awake_processor.hpp"

#include <pthread.h>
#include <sched.h>

#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::verification {

AwakeProcessor::AwakeProcessor(int processor) : thread_{[this, processor] { compute(processor); }} {}

AwakeProcessor::~AwakeProcessor() {
    is_ending_.store(true, std::memory_order_relaxed);
    thread_.join();
}

void AwakeProcessor::compute(int processor) const {
    const sched_param lowest{};
    if (pthread_setschedparam(pthread_self(), SCHED_IDLE, &lowest) != 0 ||
        !ports::posix_rt::set_processor(pthread_self(), processor).is_granted) {
        return;
    }
    while (!is_ending_.load(std::memory_order_relaxed)) {
    }
}

}  // namespace mamori::verification
