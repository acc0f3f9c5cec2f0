// SPDX-License-Identifier: Apache-2.0
// Shows whether a transport closed its descriptors: Linux gives the lowest free number.
#ifndef MAMORI_PORTS_LCM_FREE_DESCRIPTOR_HPP
#define MAMORI_PORTS_LCM_FREE_DESCRIPTOR_HPP

#include <gtest/gtest.h>
#include <unistd.h>

namespace lcm_sample {

/// @return the descriptor that the next open() of this process gives.
inline int find_free_descriptor() {
    const int descriptor = ::dup(STDERR_FILENO);
    EXPECT_EQ(::close(descriptor), 0);
    return descriptor;
}

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_FREE_DESCRIPTOR_HPP
