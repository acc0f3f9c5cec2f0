// SPDX-License-Identifier: Apache-2.0
// The next descriptor is 0, as in a process without standard input.
#ifndef MAMORI_PORTS_LCM_ZERO_DESCRIPTOR_HPP
#define MAMORI_PORTS_LCM_ZERO_DESCRIPTOR_HPP

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace lcm_sample {

/// Standard input is closed while it exists.
class ZeroDescriptorScope final {
  public:
    ZeroDescriptorScope() {
        EXPECT_GT(before_, 0);
        EXPECT_EQ(::close(STDIN_FILENO), 0);
    }
    ZeroDescriptorScope(const ZeroDescriptorScope&) = delete;
    ZeroDescriptorScope& operator=(const ZeroDescriptorScope&) = delete;
    ~ZeroDescriptorScope() {
        EXPECT_EQ(::dup2(before_, STDIN_FILENO), STDIN_FILENO);
        EXPECT_EQ(::close(before_), 0);
    }

  private:
    int before_{::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3)};
};

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_ZERO_DESCRIPTOR_HPP
