// SPDX-License-Identifier: Apache-2.0
// Goal: each system call that fails is reported with its cause, and nothing is left behind. Method: a
// filter of system calls (seccomp) in a process of its own, one call at a time.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "mamori/ports/posix_rt/crash_stack.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/ports/posix_rt/provisions.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/shared_memory.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr std::uint32_t kAnyUser = 65534U;

/// One call that fails with EPERM: each one, or the one whose argument `index` is `value`.
struct Refusal {
    std::uint32_t call;
    int index{-1};
    std::uint32_t value{0U};
};

void refuse(const Refusal& refusal) {
    ASSERT_TRUE(refusal.index < 0 ? refuse_call(refusal.call, EPERM, false)
                                  : refuse_call_with(refusal.call, EPERM,
                                                     static_cast<std::size_t>(refusal.index), refusal.value));
}

/// Starts a process with all limits. @param[in] user of it.
Status start_limited(PartitionProcess& process, uid_t user) {
    const std::array<int, 1U> descriptors{2};
    PartitionOrder order{"/bin/true", {}, descriptors, nullptr, {}};
    order.limits.memory_max = std::uint64_t{1U} << 40U;
    order.limits.process_max = 1000U;
    order.limits.user = user;
    return process.start(order);
}

void expect_no_start(const Refusal& refusal, PartitionError error, uid_t user) {
    const std::string what =
        "call " + std::to_string(refusal.call) + ", argument " + std::to_string(refusal.value);
    EXPECT_EQ(run_in_process([&] {
                  refuse(refusal);
                  PartitionProcess process;
                  EXPECT_NE(start_limited(process, user), Status::kOk);
                  EXPECT_EQ(process.get_error(), error) << describe(process.get_error());
                  EXPECT_EQ(process.check(), PartitionState::kNone);
                  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a process is left";
              }),
              0)
        << what;
}

TEST(RefusedCallsTest, APartitionThatCannotBeRestrictedIsNotStarted) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    const std::array<Refusal, 15U> refusals{{{SYS_setsid},
                                             {SYS_capget},
                                             {SYS_capset},
                                             {SYS_getppid},
                                             {SYS_sched_setscheduler},
                                             {SYS_setpriority},
                                             {SYS_prctl, 0, PR_SET_PDEATHSIG},
                                             {SYS_prlimit64, 1, RLIMIT_RTPRIO},
                                             {SYS_prlimit64, 1, RLIMIT_NICE},
                                             {SYS_prlimit64, 1, RLIMIT_MEMLOCK},
                                             {SYS_prlimit64, 1, RLIMIT_CORE},
                                             {SYS_prlimit64, 1, RLIMIT_NOFILE},
                                             {SYS_prlimit64, 1, RLIMIT_AS},
                                             {SYS_prlimit64, 1, RLIMIT_NPROC},
                                             {SYS_prctl, 0, PR_SET_NO_NEW_PRIVS}}};
    for (const Refusal& refusal : refusals) {
        expect_no_start(refusal, PartitionError::kCannotRestrict, PartitionLimits::kSameUser);
    }
}

TEST(RefusedCallsTest, APartitionThatCannotGetItsDescriptorsIsNotStarted) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::uint32_t place : {0U, 1U, 2U, 3U}) {
        expect_no_start({SYS_dup2, 1, place}, PartitionError::kCannotHandOver, PartitionLimits::kSameUser);
    }
    expect_no_start({SYS_dup3}, PartitionError::kCannotHandOver, PartitionLimits::kSameUser);
    expect_no_start({SYS_openat, 2, O_RDWR | O_CLOEXEC}, PartitionError::kCannotHandOver,
                    PartitionLimits::kSameUser);
    expect_no_start({SYS_vfork}, PartitionError::kNoProcess, PartitionLimits::kSameUser);
    // The socket through which the process reports.
    const int next = ::dup(2);
    ASSERT_EQ(::close(next), 0);
    expect_no_start({SYS_fcntl, 0, static_cast<std::uint32_t>(next + 1)}, PartitionError::kCannotHandOver,
                    PartitionLimits::kSameUser);
}

TEST(RefusedCallsTest, APartitionThatCannotBecomeItsUserIsNotStarted) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    if (::geteuid() != 0U) {
        GTEST_SKIP() << "verdict=no-privilege: another user needs root";
    }
    for (const int call : {SYS_setgroups, SYS_setresgid, SYS_setresuid}) {
        expect_no_start({static_cast<std::uint32_t>(call)}, PartitionError::kCannotBecome, kAnyUser);
    }
}

TEST(RefusedCallsTest, APartitionIsStartedWithoutWhatItOnlyPrefers) {
    verifies("SWR-PRT-015", Technique::kFaultInjection);
    const std::array<Refusal, 3U> refusals{
        {{SYS_getpriority}, {SYS_openat, 2, O_WRONLY | O_CLOEXEC}, {SYS_prctl, 0, PR_CAPBSET_DROP}}};
    for (const Refusal& refusal : refusals) {
        EXPECT_EQ(run_in_process([&] {
                      refuse(refusal);
                      PartitionProcess process;
                      EXPECT_EQ(start_limited(process, PartitionLimits::kSameUser), Status::kOk)
                          << describe(process.get_error());
                  }),
                  0)
            << refusal.call;
    }
}

TEST(RefusedCallsTest, AProcessThatCannotBeCreatedIsReportedWithItsCause) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    for (const int call : {SYS_vfork, SYS_socketpair}) {
        EXPECT_EQ(run_in_process([call] {
                      refuse({static_cast<std::uint32_t>(call)});
                      PartitionProcess process;
                      EXPECT_EQ(start_limited(process, PartitionLimits::kSameUser), Status::kOutOfResources);
                      EXPECT_EQ(process.get_error(), PartitionError::kNoProcess);
                      EXPECT_EQ(process.get_system_error(), EPERM);
                      EXPECT_EQ(process.get_pid(), -1);
                  }),
                  0)
            << call;
    }
}

TEST(RefusedCallsTest, MemoryIsNotLockedWithoutRoomForLaterAllocations) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
                      return;  // no privilege
                  }
                  ASSERT_EQ(::munlockall(), 0);
                  ASSERT_TRUE(refuse_call_with(SYS_mmap, EAGAIN, 1U, 64U << 20U));
                  const Right right = lock_memory(4096U);
                  EXPECT_FALSE(right.is_granted);
                  EXPECT_EQ(right.system_error, ENOMEM);
                  std::ifstream status{"/proc/self/status"};
                  const std::string text{std::istreambuf_iterator<char>{status}, {}};
                  EXPECT_NE(text.find("VmLck:\t       0 kB"), std::string::npos) << text;
              }),
              0);
}

TEST(RefusedCallsTest, ARefusedLockIsReportedWithItsCause) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  ASSERT_TRUE(refuse_call(SYS_mlockall, ENOSYS, false));
                  if (::mlockall(MCL_CURRENT) == 0) {
                      return;  // a sanitizer does not call Linux
                  }
                  const Right right = lock_memory(4096U);
                  EXPECT_FALSE(right.is_granted);
                  EXPECT_EQ(right.system_error, ENOSYS);
              }),
              0);
}

/// The threads of the next calls cannot be created.
void refuse_threads() {
    ASSERT_TRUE(refuse_call(SYS_clone3, EAGAIN, false));
}

TEST(RefusedCallsTest, AThreadThatCannotBeCreatedIsReported) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  refuse_threads();
                  pthread_t thread{};
                  ThreadRights rights{};
                  EXPECT_EQ(start_thread(
                                thread, [](void*) -> void* { return nullptr; }, nullptr, {}, rights),
                            Status::kOutOfResources);
                  EXPECT_FALSE(may_leave_idle());
              }),
              0);
}

TEST(RefusedCallsTest, AThreadThatCannotBecomeIdleMayNotLeaveIt) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  refuse({SYS_sched_setscheduler, 1, SCHED_IDLE});
                  EXPECT_FALSE(may_leave_idle());
              }),
              0);
}

TEST(RefusedCallsTest, APriorityThatCannotBeReadCountsAsNone) {
    verifies("SWR-PRT-002", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  static_cast<void>(set_priority(pthread_self(), 3));
                  refuse({SYS_sched_getparam});
                  EXPECT_EQ(get_own_priority(), 0);
              }),
              0);
}

TEST(RefusedCallsTest, AGuardIsUnknownWhereItsPriorityCannotBeRead) {
    verifies("SWR-AOU-014", Technique::kFaultInjection, Polarity::kViolation);
    for (const bool only_own : {false, true}) {
        EXPECT_EQ(run_in_process([&] {
                      GuardAbove sut;
                      sut.set_guard();
                      refuse(only_own ? Refusal{SYS_sched_getparam, 0, 0U} : Refusal{SYS_sched_getparam});
                      EXPECT_EQ(sut.look(), Status::kUnsupported);
                  }),
                  0);
    }
}

TEST(RefusedCallsTest, LockedMemoryIsUnknownWhereLinuxDoesNotTell) {
    verifies("SWR-AOU-011", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  refuse({SYS_openat});
                  MemoryLocked sut;
                  EXPECT_EQ(sut.open(), Status::kUnsupported);
              }),
              0);
    EXPECT_EQ(run_in_process([] {
                  MemoryLocked sut;
                  ASSERT_EQ(sut.open(), Status::kOk);
                  refuse({SYS_pread64});
                  EXPECT_EQ(sut.look(), Status::kUnsupported);
              }),
              0);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasCrashStackOfASanitizer = true;
#elif defined(__has_feature)
constexpr bool kHasCrashStackOfASanitizer = __has_feature(address_sanitizer);
#else
constexpr bool kHasCrashStackOfASanitizer = false;
#endif

TEST(RefusedCallsTest, ACrashStackThatLinuxDoesNotTakeIsReported) {
    verifies("SWR-PRT-026", Technique::kFaultInjection, Polarity::kViolation);
    if (kHasCrashStackOfASanitizer) {
        GTEST_SKIP() << "verdict=not-shown: this sanitizer calls sigaltstack() itself";
    }
    EXPECT_EQ(run_in_process([] {
                  refuse({SYS_sigaltstack});
                  CrashStack sut;
                  EXPECT_EQ(sut.take(), Status::kOutOfResources);
              }),
              0);
}

class RefusedFileTest : public ::testing::Test {
  protected:
    void TearDown() override { static_cast<void>(::unlink(path_.c_str())); }
    /// @return whether the file is there.
    bool exists() const { return ::access(path_.c_str(), F_OK) == 0; }
    void expect_refused(const Refusal& refusal, Status status, MappedFileError error) {
        EXPECT_EQ(run_in_process([&] {
                      MappedFile sut;
                      refuse(refusal);
                      EXPECT_EQ(sut.open(path_.c_str(), 4096U), status);
                      EXPECT_EQ(sut.get_error(), error) << describe(sut.get_error());
                      EXPECT_EQ(sut.get_system_error(), EPERM);
                      EXPECT_FALSE(sut.is_open());
                  }),
                  0)
            << refusal.call;
    }

    std::string path_{::testing::TempDir() + "mamori_refused_" + std::to_string(::getpid())};
};

TEST_F(RefusedFileTest, ANewFileThatCannotBeUsedIsRemoved) {
    verifies("SWR-REC-010", Technique::kFaultInjection, Polarity::kViolation);
    expect_refused({SYS_newfstatat}, Status::kError, MappedFileError::kCannotOpen);
    EXPECT_FALSE(exists());
    expect_refused({SYS_flock}, Status::kError, MappedFileError::kCannotOpen);
    EXPECT_FALSE(exists());
    expect_refused({SYS_fallocate}, Status::kOutOfResources, MappedFileError::kCannotReserve);
    EXPECT_FALSE(exists());
    expect_refused({SYS_mmap, 3, MAP_SHARED | MAP_POPULATE}, Status::kOutOfResources,
                   MappedFileError::kCannotMap);
    EXPECT_FALSE(exists());
}

TEST_F(RefusedFileTest, AnExistingFileThatCannotBeUsedKeepsItsSize) {
    verifies("SWR-REC-010", Technique::kFaultInjection, Polarity::kViolation);
    {
        MappedFile file;
        ASSERT_EQ(file.open(path_.c_str(), 4096U), Status::kOk);
    }
    expect_refused({SYS_fallocate}, Status::kOutOfResources, MappedFileError::kCannotReserve);
    struct stat facts{};
    ASSERT_EQ(::stat(path_.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_size, 4096);
}

TEST_F(RefusedFileTest, ANewFileWithTheFirstNumberIsRemovedLikewise) {
    verifies("SWR-REC-010", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(run_in_process([&] {
                  ASSERT_EQ(::close(0), 0);
                  refuse({SYS_flock});
                  MappedFile sut;
                  EXPECT_EQ(sut.open(path_.c_str(), 4096U), Status::kError);
              }),
              0);
    EXPECT_FALSE(exists());
}

TEST_F(RefusedFileTest, AFileThatOpensAfterAFailureReportsNone) {
    verifies("SWR-REC-010", Technique::kStateTransition);
    MappedFile sut;
    ASSERT_EQ(sut.open("/nowhere/file", 4096U), Status::kError);
    ASSERT_EQ(sut.get_system_error(), ENOENT);

    const mode_t before = ::umask(0);
    EXPECT_EQ(sut.open(path_.c_str(), 4096U), Status::kOk);
    static_cast<void>(::umask(before));
    EXPECT_EQ(sut.get_system_error(), 0);
    EXPECT_EQ(sut.get_error(), MappedFileError::kNone);
    struct stat facts{};
    ASSERT_EQ(::stat(path_.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777U, 0644U) << "others read it";
}

TEST_F(RefusedFileTest, AFlushThatFailsIsReported) {
    verifies("SWR-REC-010", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([&] {
                  MappedFile sut;
                  ASSERT_EQ(sut.open(path_.c_str(), 4096U), Status::kOk);
                  refuse({SYS_msync});
                  EXPECT_EQ(sut.flush(), Status::kError);
              }),
              0);
}

TEST_F(RefusedFileTest, ASocketIsNotARegularFile) {
    verifies("SWR-REC-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(socket, 0);
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    ASSERT_LT(path_.size(), sizeof place.sun_path);
    std::memcpy(place.sun_path, path_.c_str(), path_.size());
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);

    MappedFile sut;
    EXPECT_EQ(sut.open(path_.c_str(), 4096U), Status::kError);
    EXPECT_EQ(sut.get_error(), MappedFileError::kNotRegular);
    EXPECT_EQ(sut.get_system_error(), ENXIO);
    ASSERT_EQ(::close(socket), 0);
}

TEST(RefusedCallsTest, SharedMemoryWhoseSizeIsUnknownIsNotMapped) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  SharedMemory owner;
                  ASSERT_EQ(owner.create("refused", 4096U, SharedAccess::kWrite), Status::kOk);
                  refuse({SYS_newfstatat});
                  SharedMemory sut;
                  EXPECT_EQ(sut.adopt(owner.get_descriptor(), 4096U, SharedAccess::kRead), Status::kError);
                  EXPECT_EQ(sut.get_error(), SharedMemoryError::kNoMemory);
              }),
              0);
}

/// @param[in] last enumerator. @return number of different sentences.
template <typename Error>
std::size_t count_sentences(Error last) {
    std::set<std::string> sentences;
    for (int error = 0; error <= static_cast<int>(last); ++error) {
        sentences.insert(describe(static_cast<Error>(error)));
    }
    EXPECT_EQ(sentences.count(""), 0U);
    EXPECT_EQ(sentences.count(describe(static_cast<Error>(200))), 0U);
    return sentences.size();
}

TEST(ErrorSentenceTest, EachErrorHasASentenceOfItsOwn) {
    verifies("SWR-REC-010", Technique::kEquivalenceClasses);
    EXPECT_EQ(count_sentences(MappedFileError::kCannotMap), 7U);
    EXPECT_EQ(count_sentences(WatchdogDeviceError::kCannotSetTimeout), 7U);
    EXPECT_EQ(count_sentences(PartitionError::kCannotWatch), 9U);
    EXPECT_EQ(count_sentences(SharedMemoryError::kCannotMap), 9U);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
