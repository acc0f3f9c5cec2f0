// SPDX-License-Identifier: Apache-2.0
// Goal: a thread has the alternate signal stack between take() and give_back(), and the previous one
// afterwards. Method: the test reads the stack with sigaltstack().
#include "mamori/ports/posix_rt/crash_stack.hpp"

#include <gtest/gtest.h>

#include <csignal>

#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

TEST(CrashStackTest, IsTakenOnceAndGivenBack) {
    verifies("SWR-PRT-026");
    stack_t before{};
    ASSERT_EQ(::sigaltstack(nullptr, &before), 0);
    {
        CrashStack sut;
        EXPECT_EQ(sut.take(), Status::kOk);
        EXPECT_EQ(sut.take(), Status::kPreconditionNotMet);
        stack_t taken{};
        ASSERT_EQ(::sigaltstack(nullptr, &taken), 0);
        EXPECT_EQ(taken.ss_size, CrashStack::kSize);
    }
    stack_t after{};
    ASSERT_EQ(::sigaltstack(nullptr, &after), 0);
    EXPECT_EQ(after.ss_sp, before.ss_sp);
    EXPECT_EQ(after.ss_flags, before.ss_flags);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
