// SPDX-License-Identifier: Apache-2.0
/// @file
/// Puts a value into an input of a component under test, the way the executive does within a window.
#ifndef EXAMPLES_SAFE_ARM_TESTS_FEED_HPP
#define EXAMPLES_SAFE_ARM_TESTS_FEED_HPP

#include "mamori/kernel/dataflow/data_port.hpp"

namespace safe_arm {

template <typename T>
void feed(mamori::InPort<T>& input, const T& value, mamori::Instant now = {}) {
    // One source for all calls: an input takes only what is newer than what it has.
    static mamori::OutPort<T> source{mamori::kNoOwner, "source"};
    source.write(value);
    input.take(source.get_staged_sample(now));
}

/// Publishes and returns what the component wrote in this cycle.
template <typename T>
const T& take(mamori::OutPort<T>& output) {
    static_cast<void>(output.publish(mamori::Instant{}));
    return output.get_published();
}

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_TESTS_FEED_HPP
