// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lets a death test tell which check ended the program: an access that a check should have prevented dies in
/// another check, or in none.
#ifndef MAMORI_KERNEL_TESTS_SUPPORT_FAILED_CHECK_HPP
#define MAMORI_KERNEL_TESTS_SUPPORT_FAILED_CHECK_HPP

#include <cstdio>
#include <cstdlib>

#include "mamori/kernel/assert.hpp"

namespace mamori::testing_support {

inline void print_failed_check(const AssertionRecord& record) noexcept {
    std::fprintf(stderr, "%s check %u.", record.file, static_cast<unsigned>(record.id));
    std::abort();
}

/// Runs `work` with failed checks written as "<file> check <number>."; for EXPECT_DEATH only.
template <typename Work>
void run_telling_checks(Work work) {
    set_assertion_handler(&print_failed_check);
    work();
}

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_SUPPORT_FAILED_CHECK_HPP
