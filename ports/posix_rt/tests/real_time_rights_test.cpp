// SPDX-License-Identifier: Apache-2.0
// Goal: each privilege is granted as requested or denied with its cause, and a denial does not change the
// thread. Method: the tests read back policy and processors of the thread, use values that Linux does not
// support, and drop the privileges of a process. They skip privileges that the host does not grant.
#include "mamori/ports/posix_rt/real_time_rights.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>

#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

int read_priority() {
    int policy = -1;
    sched_param parameters{};
    EXPECT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
    return policy == SCHED_FIFO ? parameters.sched_priority : 0;
}

int count_processors() {
    cpu_set_t set;
    EXPECT_EQ(pthread_getaffinity_np(pthread_self(), sizeof set, &set), 0);
    return CPU_COUNT(&set);
}

TEST(RealTimeRightsTest, APriorityIsGrantedAndReleased) {
    verifies("SWR-PRT-002");
    const Right right = set_priority(pthread_self(), 10);
    if (!right.is_granted) {
        ASSERT_EQ(right.system_error, EPERM);
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }

    EXPECT_EQ(read_priority(), 10);
    EXPECT_EQ(get_own_priority(), 10);
    EXPECT_EQ(right.system_error, 0);
    EXPECT_TRUE(set_priority(pthread_self(), 0).is_granted);
    EXPECT_EQ(read_priority(), 0);
    EXPECT_EQ(get_own_priority(), 0);
}

TEST(RealTimeRightsTest, TheFirstRefusalOfTwoRightsCounts) {
    verifies("SWR-PRT-002", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Right granted{true, 0};
    const Right no_permission{false, EPERM};
    const Right no_memory{false, ENOMEM};

    EXPECT_TRUE(combine(granted, granted).is_granted);
    EXPECT_EQ(combine(granted, no_memory).system_error, ENOMEM);
    EXPECT_EQ(combine(no_permission, granted).system_error, EPERM);
    EXPECT_EQ(combine(no_permission, no_memory).system_error, EPERM);
}

TEST(RealTimeRightsTest, AThreadMayLeaveIdleIfAnotherOneCould) {
    verifies("SWR-PRT-042", Technique::kBackToBack);
    bool could = false;
    std::thread{[&could] {
        could = set_idle(pthread_self()).is_granted && set_priority(pthread_self(), 0).is_granted;
    }}.join();
    EXPECT_EQ(may_leave_idle(), could);
}

/// Drops all privileges of this process.
bool drop_privileges() {
    const rlimit none{0U, 0U};
    return setrlimit(RLIMIT_RTPRIO, &none) == 0 && setrlimit(RLIMIT_NICE, &none) == 0 &&
           (geteuid() != 0U || setresuid(65534, 65534, 65534) == 0);
}

/// @return exit status of a process that runs `act`.
int run_in_child(int (*act)()) {
    const pid_t child = fork();
    if (child == 0) {
        _exit(act());
    }
    int status = -1;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
}

TEST(RealTimeRightsTest, APriorityWithoutPrivilegeIsDeniedAndTheThreadIsUnchanged) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_child([] {
                  if (!drop_privileges()) {
                      return 2;
                  }
                  const Right right = set_priority(pthread_self(), 10);
                  return !right.is_granted && right.system_error == EPERM && read_priority() == 0 ? 0 : 1;
              }),
              0);
}

TEST(RealTimeRightsTest, AnInvalidPriorityIsDenied) {
    verifies("SWR-PRT-002", Technique::kBoundaryValues, Polarity::kViolation);

    for (const int priority : {-1, 100}) {
        const Right right = set_priority(pthread_self(), priority);
        EXPECT_FALSE(right.is_granted);
        EXPECT_EQ(right.system_error, EINVAL);
    }
    EXPECT_EQ(read_priority(), 0);
}

TEST(RealTimeRightsTest, AMissingProcessorIsDeniedAndNothingChanges) {
    verifies("SWR-PRT-002", Technique::kBoundaryValues, Polarity::kViolation);
    const int before = count_processors();

    for (const int processor : {-2, CPU_SETSIZE - 1, CPU_SETSIZE}) {
        const Right right = set_processor(pthread_self(), processor);
        EXPECT_FALSE(right.is_granted);
        EXPECT_EQ(right.system_error, EINVAL);
    }
    EXPECT_TRUE(set_processor(pthread_self(), ThreadPlace::kAnyProcessor).is_granted);
    EXPECT_EQ(count_processors(), before);
}

TEST(RealTimeRightsTest, TheFirstProcessorIsOneLikeAnyOther) {
    verifies("SWR-PRT-002", Technique::kBoundaryValues);
    cpu_set_t before;
    ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof before, &before), 0);
    if (!CPU_ISSET(0U, &before)) {
        GTEST_SKIP() << "verdict=not-shown: this process must not use processor 0";
    }
    std::thread{[] {
        EXPECT_TRUE(set_processor(pthread_self(), 0).is_granted);
        EXPECT_EQ(sched_getcpu(), 0);
        EXPECT_EQ(count_processors(), 1);
    }}.join();
}

TEST(RealTimeRightsTest, APermittedProcessorIsGranted) {
    verifies("SWR-PRT-002");
    cpu_set_t before;
    ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof before, &before), 0);
    int processor = 0;
    while (!CPU_ISSET(static_cast<std::size_t>(processor), &before)) {
        ++processor;
    }

    EXPECT_TRUE(set_processor(pthread_self(), processor).is_granted);
    EXPECT_EQ(sched_getcpu(), processor);
    EXPECT_EQ(count_processors(), 1);
    ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof before, &before), 0);
}

std::uint64_t read_mapped_kib() {
    std::ifstream file{"/proc/self/status"};
    std::string word;
    std::uint64_t mapped = 0U;
    while (file >> word) {
        if (word == "VmSize:") {
            file >> mapped;
        }
    }
    return mapped;
}

TEST(RealTimeRightsTest, MemoryIsLocked) {
    verifies("SWR-PRT-002");
    const std::uint64_t before = read_mapped_kib();
    const Right right = lock_memory(64U * 1024U);
    EXPECT_LT(read_mapped_kib(), before + 32U * 1024U) << "nothing stays allocated";
    const bool may_lock = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    void* const room = mmap(nullptr, 64U << 20U, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_EQ(right.is_granted, may_lock && room != MAP_FAILED);
    if (room != MAP_FAILED) {
        ASSERT_EQ(munmap(room, 64U << 20U), 0);
    }
    if (!right.is_granted) {
        ASSERT_TRUE(right.system_error == EPERM || right.system_error == ENOMEM);
        GTEST_SKIP() << "verdict=no-privilege: this host does not let this process lock its memory "
                        "(CAP_IPC_LOCK or ulimit -l)";
    }
    EXPECT_EQ(right.system_error, 0);
    ASSERT_EQ(munlockall(), 0);
}

/// Exit status for a process without privileges; 0: a thread could be started after lock_memory().
int start_thread_under_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0) {
        return 2;
    }
    limit.rlim_max = std::min<rlim_t>(limit.rlim_max, 16U << 20U);
    limit.rlim_cur = limit.rlim_max;
    if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0 || (geteuid() == 0U && setresuid(65534, 65534, 65534) != 0)) {
        return 3;
    }
    const Right right = lock_memory(64U * 1024U);
    pthread_t thread{};
    const bool has_started = pthread_create(
                                 &thread, nullptr, [](void*) -> void* { return nullptr; }, nullptr) == 0 &&
                             pthread_join(thread, nullptr) == 0;
    // With sanitizers, mlockall() has no effect and succeeds.
    return has_started && (right.is_granted || right.system_error == ENOMEM) ? 0 : 1;
}

TEST(RealTimeRightsTest, MemoryIsNotLockedUnderALimitThatWouldPreventNewThreads) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_child(&start_thread_under_limit), 0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
