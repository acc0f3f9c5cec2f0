// SPDX-License-Identifier: Apache-2.0
// Goal: lock_memory() uses no more stack than its thread has. Method: threads with stacks from the minimum
// that Linux permits. This test and the tested sources are compiled without optimisation, so that each local
// object and copy uses stack (see CMakeLists.txt).
#include <gtest/gtest.h>
#include <limits.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr std::size_t kPage = 4096U;

struct Call {
    std::size_t asked;
    bool has_returned{false};
    std::size_t resident_pages{0U};  ///< resident pages of the stack after the call
};

/// Resident pages of the stack of the calling thread.
std::size_t count_stack_pages() {
    pthread_attr_t attributes;
    void* lowest = nullptr;
    std::size_t size = 0U;
    EXPECT_EQ(pthread_getattr_np(pthread_self(), &attributes), 0);
    EXPECT_EQ(pthread_attr_getstack(&attributes, &lowest, &size), 0);
    EXPECT_EQ(pthread_attr_destroy(&attributes), 0);
    std::size_t count = 0U;
    for (std::size_t offset = 0U; offset < size; offset += kPage) {
        unsigned char is_resident = 0U;
        EXPECT_EQ(mincore(static_cast<char*>(lowest) + offset, kPage, &is_resident), 0);
        count += is_resident & 1U;
    }
    return count;
}

Call lock_on_stack(std::size_t stack_size, std::size_t asked) {
    Call call{asked};
    pthread_attr_t attributes;
    pthread_t thread{};
    EXPECT_EQ(pthread_attr_init(&attributes), 0);
    EXPECT_EQ(pthread_attr_setstacksize(&attributes, stack_size), 0);
    const auto run = [](void* argument) -> void* {
        auto& self = *static_cast<Call*>(argument);
        static_cast<void>(lock_memory(self.asked));
        static_cast<void>(munlockall());
        self.resident_pages = count_stack_pages();
        self.has_returned = true;
        return nullptr;
    };
    EXPECT_EQ(pthread_create(&thread, &attributes, run, &call), 0);
    EXPECT_EQ(pthread_join(thread, nullptr), 0);
    EXPECT_EQ(pthread_attr_destroy(&attributes), 0);
    return call;
}

std::size_t get_smallest() {
    return static_cast<std::size_t>(PTHREAD_STACK_MIN);
}

TEST(SmallStackTest, LockingOnASmallStackTouchesOnlyItsPages) {
    verifies("SWR-PRT-046", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::size_t size : {get_smallest(), get_smallest() + kPage, std::size_t{64U} * 1024U,
                                   std::size_t{256U} * 1024U, std::size_t{1024U} * 1024U}) {
        for (const std::size_t asked : {std::size_t{0U}, std::size_t{1U}, size - kPage, size, size + 1U,
                                        std::size_t{1024U} * 1024U, ~std::size_t{0U}}) {
            EXPECT_TRUE(lock_on_stack(size, asked).has_returned) << size << " " << asked;
        }
    }
}

TEST(SmallStackTest, WithoutThePrivilegeToLockTheStackIsResident) {
    verifies("SWR-PRT-046", Technique::kFaultInjection);
    EXPECT_EQ(run_in_process([] {
                  ASSERT_TRUE(refuse_call(SYS_mlockall, EPERM, false));
                  constexpr std::size_t kStack = std::size_t{4U} * 1024U * 1024U;
                  EXPECT_GE(lock_on_stack(kStack, 128U * kPage).resident_pages, 128U);
              }),
              0);
}

TEST(SmallStackTest, AtMostOneMebibyteOfTheStackIsTouched) {
    verifies("SWR-PRT-046", Technique::kBoundaryValues);
    EXPECT_EQ(run_in_process([] {
                  ASSERT_TRUE(refuse_call(SYS_mlockall, EPERM, false));
                  constexpr std::size_t kStack = std::size_t{32U} * 1024U * 1024U;  // none like it was used
                  const std::size_t touched = lock_on_stack(kStack, kStack).resident_pages;
                  EXPECT_GE(touched, 256U);
                  EXPECT_LT(touched, 256U + 32U);
              }),
              0);
}

TEST(SmallStackTest, TheRequestedBytesAreResidentAfterwards) {
    verifies("SWR-PRT-046");
    constexpr std::size_t kStack = std::size_t{4U} * 1024U * 1024U;
    const Call call = lock_on_stack(kStack, 128U * kPage);
    EXPECT_TRUE(call.has_returned);
    EXPECT_GE(call.resident_pages, 128U);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
