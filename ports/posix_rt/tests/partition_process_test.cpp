// SPDX-License-Identifier: Apache-2.0
// Goal: a partition gets the necessary privileges only, ends when required, and no function waits for it.
// Method: a shell as its program reports its environment through a pipe. The pipe ends when no process holds
// it, so a remaining process is detected.
#include "mamori/ports/posix_rt/partition_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "support/line.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

#if defined(__SANITIZE_THREAD__)
constexpr bool kIsEachStartACopy = true;
#else
constexpr bool kIsEachStartACopy = false;
#endif

class PartitionProcessTest : public ::testing::Test {
  protected:
    /// Starts a script with the line as descriptor 3.
    Status start(const char* script) {
        const std::array<const char*, 2U> arguments{"-c", script};
        const std::array<int, 1U> descriptors{line_.get_writing_end()};
        order_.program = "/bin/sh";
        order_.arguments = arguments;
        order_.descriptors = descriptors;
        return sut_.start(order_);
    }
    PartitionState wait_for_end() { return posix_rt::wait_for_end(sut_); }
    /// Returns the output of the script to descriptor 3.
    std::string run(const char* script) {
        EXPECT_EQ(start(script), Status::kOk) << describe(sut_.get_error());
        std::string text = line_.read_all();
        EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
        EXPECT_EQ(sut_.get_exit_status(), 0);
        return text;
    }

    Line line_{};
    PartitionOrder order_{};
    PartitionProcess sut_{};
};

/// The rest of the line that begins with `key`, without blanks around it.
std::string find(const std::string& text, const std::string& key) {
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) {
        if (line.compare(0U, key.size(), key) == 0) {
            const std::size_t first = line.find_first_not_of(" \t", key.size());
            return first == std::string::npos ? ""
                                              : line.substr(first, line.find_last_not_of(' ') - first + 1U);
        }
    }
    return "no " + key;
}

TEST_F(PartitionProcessTest, ItRunsWithItsArgumentsAndItsEndIsDetected) {
    verifies("SWR-PRT-015");
    EXPECT_EQ(sut_.check(), PartitionState::kNone);
    const std::array<const char*, 5U> arguments{"-c", "read x; echo \"$0,$1,$2,$x\" >&3; exit 7", "a", "b c",
                                                ""};
    const std::array<int, 1U> descriptors{line_.get_writing_end()};
    order_.program = "/bin/sh";
    order_.arguments = arguments;
    order_.descriptors = descriptors;

    ASSERT_EQ(sut_.start(order_), Status::kOk);
    EXPECT_EQ(line_.read_all(), "a,b c,,\n") << "its standard input is empty";
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
    EXPECT_EQ(sut_.get_exit_status(), 7);
    EXPECT_EQ(sut_.get_signal(), 0);
    EXPECT_EQ(sut_.get_pid(), -1);
}

TEST_F(PartitionProcessTest, DescriptorsGetTheirNumbersInAnyOrderAndNoOtherOneIsOpen) {
    verifies("SWR-PRT-015", Technique::kErrorGuessing, Polarity::kViolation);
    Line second;
    const int leak = ::dup(line_.get_writing_end());  // without close-on-exec
    const int a = ::fcntl(line_.get_writing_end(), F_DUPFD_CLOEXEC, 3);
    const std::array<const char*, 2U> arguments{"-c",
                                                "for i in 0 1 2 3 4 5 6 7 8 9 10 11 12; do test -e "
                                                "/proc/$$/fd/$i && echo -n $i; done >&4; echo x >&3"};
    const std::array<int, 3U> descriptors{second.get_writing_end(), a, second.get_writing_end()};
    order_ = {"/bin/sh", arguments, descriptors, nullptr, {}};

    ASSERT_EQ(sut_.start(order_), Status::kOk) << describe(sut_.get_error());
    static_cast<void>(::close(a));
    static_cast<void>(::close(leak));
    EXPECT_EQ(second.read_all(), "x\n");
    const std::string open = line_.read_all();
    EXPECT_EQ(open.substr(0U, 6U), "012345");
    EXPECT_EQ(open.find('6'), std::string::npos) << open;
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, ItCountsFromTheEpochOfTheSafetyProcess) {
    verifies("SWR-PRT-015");
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    order_.clock = &clock;

    const std::string epoch = run("echo -n $MAMORI_EPOCH_NS >&3");
    EXPECT_EQ(epoch, std::to_string(clock.get_epoch_ns()));
    ASSERT_EQ(::setenv("MAMORI_EPOCH_NS", epoch.c_str(), 1), 0);
    FrameClock same = FrameClock::at_epoch(0);
    EXPECT_EQ(find_partition_clock(same), Status::kOk);
    EXPECT_EQ(same.get_epoch_ns(), clock.get_epoch_ns());
}

TEST_F(PartitionProcessTest, AnInheritedEpochIsNotForwardedAndAnInvalidOneIsIgnored) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues, Polarity::kViolation);
    FrameClock clock = FrameClock::at_epoch(5);
    for (const char* text : {"", "1x", "x", "99999999999999999999"}) {
        ASSERT_EQ(::setenv("MAMORI_EPOCH_NS", text, 1), 0);
        EXPECT_EQ(find_partition_clock(clock), Status::kPreconditionNotMet) << text;
    }
    ASSERT_EQ(::setenv("MAMORI_EPOCH_NS", "77", 1), 0);

    EXPECT_EQ(run("echo -n $MAMORI_EPOCH_NS >&3"), "");
    ASSERT_EQ(::unsetenv("MAMORI_EPOCH_NS"), 0);
    EXPECT_EQ(find_partition_clock(clock), Status::kPreconditionNotMet);
    EXPECT_EQ(clock.get_epoch_ns(), 5);
}

TEST_F(PartitionProcessTest, AnotherEntryOfTheEnvironmentIsNoEpoch) {
    verifies("SWR-PRT-015", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr const char* kSameLength = "MAMORI_OTHER_NS";  // same length as the name of the epoch
    ASSERT_EQ(::setenv(kSameLength, "77", 1), 0);
    FrameClock clock = FrameClock::at_epoch(5);
    EXPECT_EQ(find_partition_clock(clock), Status::kPreconditionNotMet);
    EXPECT_EQ(clock.get_epoch_ns(), 5);
    ASSERT_EQ(::unsetenv(kSameLength), 0);
}

TEST_F(PartitionProcessTest, ItsStartCopiesNoMemory) {
    verifies("SWR-PRT-015", Technique::kErrorGuessing, Polarity::kViolation);
    if (kIsEachStartACopy) {
        GTEST_SKIP() << "verdict=not-shown: this sanitizer copies the memory at each start";
    }
    constexpr std::size_t kPage = 4096U;
    constexpr std::size_t kPages = 1024U;
    std::vector<char> memory(kPage * kPages, 'a');
    const auto count_faults = [] {
        rusage usage{};
        EXPECT_EQ(::getrusage(RUSAGE_THREAD, &usage), 0);
        return usage.ru_minflt;
    };

    ASSERT_EQ(start("read x <&3"), Status::kOk);
    const long before = count_faults();
    for (std::size_t page = 0U; page < kPages; ++page) {
        *static_cast<volatile char*>(memory.data() + page * kPage) = 'b';
    }
    EXPECT_LT(count_faults() - before, static_cast<long>(kPages / 4U));
    ASSERT_EQ(sut_.end(), Status::kOk);
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, AnOrderOutOfRangeStartsNothing) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues, Polarity::kViolation);
    const std::array<const char*, 17U> arguments{};
    const std::array<int, 9U> descriptors{};
    const auto refuse = [this](const PartitionOrder& order) {
        EXPECT_EQ(sut_.start(order), Status::kBadParameter);
        EXPECT_EQ(sut_.check(), PartitionState::kNone);
    };
    PartitionOrder order{"/bin/true", {}, {}, nullptr, {}};

    refuse({});
    refuse({"/bin/true", arguments, {}, nullptr, {}});
    refuse({"/bin/true", {}, descriptors, nullptr, {}});
    order.limits.niceness = -1;
    refuse(order);
    order.limits.niceness = 20;
    refuse(order);
    order.limits.niceness = 19;
    order.limits.file_max = 7U;
    refuse(order);
    order.limits.file_max = 8U;
    order.limits.processor = -2;
    refuse(order);
    order.limits.processor = ThreadPlace::kAnyProcessor;
    order.output = -2;
    refuse(order);
    order.output = kNoStream;
    order.errors = -2;
    refuse(order);
    order.errors = kNoStream;
    EXPECT_EQ(sut_.start(order), Status::kOk);
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, AnOrderAtItsLimitsIsStarted) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues);
    std::array<const char*, 16U> arguments{};
    arguments.fill("x");
    std::array<int, 8U> descriptors{};
    descriptors.fill(line_.get_writing_end());
    errno = EINTR;  // of an earlier call

    for (const int niceness : {0, 19}) {
        PartitionOrder order{"/bin/true", arguments, descriptors, nullptr, {}};
        order.limits.niceness = niceness;
        EXPECT_EQ(sut_.start(order), Status::kOk);
        EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
        EXPECT_EQ(sut_.get_exit_status(), 0);
    }
}

TEST_F(PartitionProcessTest, TheEarliestEpochIsHandedOver) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues);
    const FrameClock clock = FrameClock::at_epoch(std::numeric_limits<std::int64_t>::min());
    order_.clock = &clock;
    EXPECT_EQ(run("echo -n $MAMORI_EPOCH_NS >&3"), "-9223372036854775808");
}

TEST_F(PartitionProcessTest, AnEnvironmentIsInheritedUpToTheLimit) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  ASSERT_EQ(::clearenv(), 0);
                  FrameClock clock = FrameClock::at_epoch(5);
                  order_.program = "/bin/true";
                  order_.clock = &clock;
                  EXPECT_EQ(sut_.start(order_), Status::kOk) << "without an entry";
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
                  EXPECT_EQ(find_partition_clock(clock), Status::kPreconditionNotMet);
                  for (int i = 0; i < 510; ++i) {
                      ASSERT_EQ(::setenv(("E" + std::to_string(i)).c_str(), "x", 1), 0);
                  }
                  EXPECT_EQ(sut_.start(order_), Status::kOk) << "and the epoch";
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
                  ASSERT_EQ(::setenv("LAST", "x", 1), 0);
                  EXPECT_EQ(sut_.start(order_), Status::kOutOfResources);
                  EXPECT_EQ(sut_.get_error(), PartitionError::kTooManyStrings);
              }),
              0);
}

TEST_F(PartitionProcessTest, AStartLeavesTheSignalsOfTheCallingThread) {
    verifies("SWR-PRT-015", Technique::kStateTransition);
    sigset_t blocked{};
    sigset_t before{};
    sigset_t after{};
    ASSERT_EQ(sigemptyset(&blocked) + sigaddset(&blocked, SIGUSR2), 0);
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &blocked, &before), 0);
    ASSERT_EQ(start("true"), Status::kOk);
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &before, &after), 0);
    for (int signal = 1; signal < NSIG; ++signal) {
        EXPECT_EQ(sigismember(&after, signal), sigismember(&blocked, signal)) << signal;
    }
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, AFailedStartReportsItsCause) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    const std::array<int, 1U> no_descriptor{-1};
    const auto refuse = [this](const PartitionOrder& order, PartitionError error, int system_error) {
        EXPECT_EQ(sut_.start(order), Status::kError);
        EXPECT_EQ(sut_.get_error(), error) << describe(sut_.get_error());
        EXPECT_EQ(sut_.get_system_error(), system_error);
        EXPECT_EQ(sut_.check(), PartitionState::kNone);
        EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a process remains";
    };

    refuse({"/no/such/program", {}, {}, nullptr, {}}, PartitionError::kCannotExecute, ENOENT);
    refuse({"/", {}, {}, nullptr, {}}, PartitionError::kCannotExecute, EACCES);
    refuse({"/bin/true", {}, no_descriptor, nullptr, {}}, PartitionError::kCannotHandOver, EBADF);
    PartitionOrder order{"/bin/true", {}, {}, nullptr, {}};
    order.limits.processor = 1023;
    refuse(order, PartitionError::kCannotPlace, EINVAL);
    order.limits.processor = 1 << 20;
    refuse(order, PartitionError::kCannotPlace, EINVAL);
    order.limits = {};
    EXPECT_EQ(sut_.start(order), Status::kOk);
    EXPECT_EQ(sut_.get_error(), PartitionError::kNone);
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, AnExhaustedSystemIsReported) {
    verifies("SWR-PRT-015", Technique::kFaultInjection, Polarity::kViolation);
    const PartitionOrder order{"/bin/true", {}, {}, nullptr, {}};
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit none{0U, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    EXPECT_EQ(sut_.start(order), Status::kOutOfResources);
    EXPECT_EQ(sut_.get_error(), PartitionError::kNoProcess);
    EXPECT_EQ(sut_.get_system_error(), EMFILE);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);

    const auto name = [](int i) { return "MAMORI_TEST_" + std::to_string(i); };
    for (int i = 0; i < 520; ++i) {
        ASSERT_EQ(::setenv(name(i).c_str(), "x", 1), 0);
    }
    EXPECT_EQ(sut_.start(order), Status::kOutOfResources);
    EXPECT_EQ(sut_.get_error(), PartitionError::kTooManyStrings);
    for (int i = 0; i < 520; ++i) {
        ASSERT_EQ(::unsetenv(name(i).c_str()), 0);
    }
    EXPECT_EQ(sut_.start(order), Status::kOk);
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
}

TEST_F(PartitionProcessTest, EachCauseHasItsOwnMessage) {
    verifies("SWR-PRT-015", Technique::kEquivalenceClasses);
    const auto last = static_cast<int>(PartitionError::kCannotWatch);

    for (int i = 0; i <= last; ++i) {
        const std::string text = describe(static_cast<PartitionError>(i));
        EXPECT_NE(text, "failed for an unknown reason");
        for (int j = 0; j < i; ++j) {
            EXPECT_NE(text, describe(static_cast<PartitionError>(j)));
        }
    }
    EXPECT_STREQ(describe(static_cast<PartitionError>(last + 1)), "failed for an unknown reason");
}

TEST_F(PartitionProcessTest, ItHasNoPrivilegeThatCouldDelayAWindow) {
    verifies("SWR-PRT-016", Technique::kRequirementsBased, Polarity::kViolation);
    // The maximum privileges and settings of this thread. The partition must have none of them.
    for (const int signal : {SIGHUP, SIGPIPE, NSIG - 1}) {
        static_cast<void>(std::signal(signal, SIG_IGN));
    }
    sigset_t blocked;
    sigset_t before;
    ASSERT_EQ(sigemptyset(&blocked) + sigaddset(&blocked, SIGUSR1), 0);
    ASSERT_EQ(::pthread_sigmask(SIG_BLOCK, &blocked, &before), 0);

    const std::string facts =
        run("cat /proc/self/status /proc/$$/limits >&3; cut -d')' -f2 /proc/$$/stat >&3");
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &before, nullptr), 0);
    for (const int signal : {SIGHUP, SIGPIPE, NSIG - 1}) {
        static_cast<void>(std::signal(signal, SIG_DFL));
    }
    EXPECT_EQ(find(facts, "CapEff:"), "0000000000000000");
    EXPECT_EQ(find(facts, "CapPrm:"), "0000000000000000");
    EXPECT_EQ(find(facts, "CapAmb:"), "0000000000000000");
    EXPECT_EQ(find(facts, "NoNewPrivs:"), "1");
    EXPECT_EQ(find(facts, "SigIgn:"), "0000000000000000");
    EXPECT_EQ(find(facts, "SigBlk:"), "0000000000000000");
    EXPECT_EQ(find(facts, "Max realtime priority").substr(0U, 1U), "0");
    EXPECT_EQ(find(facts, "Max nice priority").substr(0U, 1U), "0");
    EXPECT_EQ(find(facts, "Max locked memory").substr(0U, 1U), "0");
    EXPECT_EQ(find(facts, "Max core file size").substr(0U, 1U), "0");
    std::istringstream stat{facts.substr(facts.rfind("\n ") + 2U)};
    std::vector<std::string> fields{std::istream_iterator<std::string>{stat}, {}};
    ASSERT_GT(fields.size(), 39U);
    EXPECT_EQ(fields[2U], fields[3U]) << "its group is its session";
    EXPECT_NE(fields[3U], std::to_string(::getsid(0)));
}

TEST_F(PartitionProcessTest, ItDoesNotInheritTheCapabilitiesOfTheSafetyProcess) {
    verifies("SWR-PRT-016", Technique::kErrorGuessing, Polarity::kViolation);
    if (::geteuid() != 0U) {
        GTEST_SKIP() << "verdict=no-privilege: only root has capabilities that a program could inherit";
    }
    EXPECT_EQ(run_in_process([this] {
                  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
                  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
                  ASSERT_EQ(::syscall(SYS_capget, &header, sets.data()), 0);
                  for (__user_cap_data_struct& set : sets) {
                      set.inheritable = set.permitted;
                  }
                  ASSERT_EQ(::syscall(SYS_capset, &header, sets.data()), 0);
                  ASSERT_EQ(::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, CAP_KILL, 0UL, 0UL), 0);
                  ASSERT_EQ(start("cat /proc/self/status >&3"), Status::kOk);
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
              }),
              0);
    const std::string facts = line_.read_all();
    for (const char* const set : {"CapInh:", "CapPrm:", "CapEff:", "CapBnd:", "CapAmb:"}) {
        EXPECT_EQ(find(facts, set), "0000000000000000") << set;
    }
}

TEST_F(PartitionProcessTest, ItDoesNotInheritAFixedPriority) {
    verifies("SWR-PRT-016", Technique::kFaultInjection, Polarity::kViolation);
    if (!set_priority(pthread_self(), 5).is_granted) {
        GTEST_SKIP()
            << "verdict=no-privilege: this host grants no fixed priority (CAP_SYS_NICE or ulimit -r)";
    }
    const std::string facts = run("cut -d')' -f2 /proc/$$/stat >&3");
    ASSERT_TRUE(set_priority(pthread_self(), 0).is_granted);
    std::istringstream stat{facts};
    std::vector<std::string> fields{std::istream_iterator<std::string>{stat}, {}};
    ASSERT_GT(fields.size(), 39U);
    EXPECT_EQ(fields[37U], "0") << "fixed priority";
    EXPECT_EQ(fields[38U], "0") << "policy";
}

TEST_F(PartitionProcessTest, ItHasTheLimitsOfItsOrder) {
    verifies("SWR-PRT-016");
    order_.limits.niceness = 19;
    order_.limits.memory_max = 1U << 30U;
    order_.limits.process_max = 55U;
    order_.limits.file_max = 17U;
    cpu_set_t set;
    CPU_ZERO(&set);
    ASSERT_EQ(::sched_getaffinity(0, sizeof(set), &set), 0);
    int last = 0;
    for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
        last = CPU_ISSET(static_cast<std::size_t>(processor), &set) ? processor : last;
    }
    order_.limits.processor = last;

    const std::string facts =
        run("cat /proc/$$/status /proc/$$/limits >&3; echo score $(cat /proc/$$/oom_score_adj) >&3;"
            "echo nice $(nice) >&3");
    EXPECT_EQ(find(facts, "Max address space").substr(0U, 10U), "1073741824");
    EXPECT_EQ(find(facts, "Max processes").substr(0U, 2U), "55");
    EXPECT_EQ(find(facts, "Max open files").substr(0U, 2U), "17");
    EXPECT_EQ(find(facts, "Cpus_allowed_list:"), std::to_string(last));
    EXPECT_EQ(find(facts, "score"), "1000");
    EXPECT_EQ(find(facts, "nice"), "19");
}

TEST_F(PartitionProcessTest, ItHasNoHigherLimitThanTheSafetyProcess) {
    verifies("SWR-PRT-016", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  const rlimit files{20U, 20U};
                  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &files), 0);
                  ASSERT_EQ(start("cat /proc/$$/limits >&3"), Status::kOk) << describe(sut_.get_error());
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
              }),
              0);
    EXPECT_EQ(find(line_.read_all(), "Max open files").substr(0U, 3U), "20 ");
}

TEST_F(PartitionProcessTest, WithoutAProcessorItMayUseAll) {
    verifies("SWR-PRT-016", Technique::kEquivalenceClasses);
    EXPECT_EQ(run_in_process([this] {
                  cpu_set_t all;
                  std::memset(&all, 0xFF, sizeof all);
                  ASSERT_EQ(::sched_setaffinity(0, sizeof all, &all), 0);
                  cpu_set_t before;
                  ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
                  ASSERT_TRUE(set_processor(pthread_self(), ::sched_getcpu()).is_granted);
                  ASSERT_EQ(start("read x <&3"), Status::kOk);
                  cpu_set_t its{};
                  ASSERT_EQ(::sched_getaffinity(sut_.get_pid(), sizeof its, &its), 0);
                  EXPECT_TRUE(CPU_EQUAL(&its, &before));
                  EXPECT_EQ(sut_.end(), Status::kOk);
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
              }),
              0);
}

TEST_F(PartitionProcessTest, ItIsNeverAboveTheSafetyProcess) {
    verifies("SWR-PRT-016", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  ASSERT_EQ(::setpriority(PRIO_PROCESS, 0, 15), 0);
                  order_.limits.niceness = 10;
                  errno = EIO;  // of an earlier call
                  ASSERT_EQ(start("nice >&3"), Status::kOk);
                  EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
              }),
              0);
    EXPECT_EQ(line_.read_all(), "15\n");
}

TEST_F(PartitionProcessTest, ItRunsAsAnotherUserWhereThatIsAllowed) {
    verifies("SWR-PRT-016", Technique::kInterface, Polarity::kViolation);
    constexpr uid_t kNobody = 65534U;
    order_.limits.user = kNobody;
    if (::geteuid() != 0U) {
        EXPECT_EQ(start("true"), Status::kError);
        EXPECT_EQ(sut_.get_error(), PartitionError::kCannotBecome);
        EXPECT_EQ(sut_.get_system_error(), EPERM);
        GTEST_SKIP()
            << "verdict=no-privilege: only root may start a process as another user (CAP_SETUID, CAP_SETGID)";
    }

    const std::string facts = run("cat /proc/self/status >&3");
    EXPECT_EQ(find(facts, "Uid:"), "65534\t65534\t65534\t65534");
    EXPECT_EQ(find(facts, "Gid:"), "65534\t65534\t65534\t65534");
    EXPECT_EQ(find(facts, "Groups:"), "");
    EXPECT_EQ(::geteuid(), 0U) << "the user of the safety process is unchanged";
}

TEST_F(PartitionProcessTest, AHangingPartitionIsRunningAndCanBeEnded) {
    verifies("SWR-PRT-017", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(start("echo -n s >&3; while :; do :; done"), Status::kOk);
    EXPECT_EQ(line_.read_one(), 's');
    EXPECT_EQ(sut_.start(order_), Status::kPreconditionNotMet);
    ASSERT_EQ(::kill(sut_.get_pid(), SIGSTOP), 0);
    EXPECT_EQ(sut_.check(), PartitionState::kRunning);

    EXPECT_EQ(sut_.end(), Status::kOk);
    EXPECT_EQ(line_.read_all(), "");
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
    EXPECT_EQ(sut_.get_signal(), SIGKILL);
    EXPECT_EQ(sut_.get_exit_status(), -1);
    EXPECT_EQ(sut_.end(), Status::kPreconditionNotMet);
}

TEST_F(PartitionProcessTest, AnOwnerClosesNoDescriptorOfOthers) {
    verifies("SWR-PRT-061", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  ASSERT_EQ(::dup2(2, 0), 0);
                  {
                      PartitionProcess ended;
                      ASSERT_EQ(ended.start({"/bin/true", {}, {}, nullptr, {}}), Status::kOk);
                      EXPECT_EQ(posix_rt::wait_for_end(ended), PartitionState::kEnded);
                      const PartitionProcess unused;
                  }
                  EXPECT_NE(::fcntl(0, F_GETFD), -1);
              }),
              0);
}

TEST_F(PartitionProcessTest, APartitionThatHasEndedCanBeStartedAgain) {
    verifies("SWR-PRT-017");
    for (int round = 0; round < 3; ++round) {
        ASSERT_EQ(start("exit 3"), Status::kOk);
        EXPECT_EQ(wait_for_end(), PartitionState::kEnded);
        EXPECT_EQ(sut_.get_exit_status(), 3);
    }
}

TEST_F(PartitionProcessTest, ItsChildrenEndWithIt) {
    verifies("SWR-PRT-017", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(start("sleep 1000 & sleep 1000 & exit 0"), Status::kOk);
    EXPECT_EQ(wait_for_end(), PartitionState::kEnded);

    EXPECT_EQ(line_.read_all(), "");
}

TEST_F(PartitionProcessTest, ItEndsWithItsOwner) {
    verifies("SWR-PRT-017");
    {
        PartitionProcess owned;
        const std::array<const char*, 2U> arguments{"-c", "sleep 1000 & sleep 1000"};
        const std::array<int, 1U> descriptors{line_.get_writing_end()};
        ASSERT_EQ(owned.start({"/bin/sh", arguments, descriptors, nullptr, {}}), Status::kOk);
    }

    EXPECT_EQ(line_.read_all(), "");
    // The owner may or may not have waited for the child already. In both cases, the child must have ended.
    while (::waitpid(-1, nullptr, 0) > 0) {
    }
    EXPECT_EQ(errno, ECHILD) << "a child remains";
}

TEST_F(PartitionProcessTest, ItEndsWithTheSafetyProcess) {
    verifies("SWR-PRT-017", Technique::kFaultInjection, Polarity::kViolation);
    const pid_t middle = ::fork();
    if (middle == 0) {
        const Status result = start("echo -n s >&3; while :; do :; done");
        for (;;) {
            static_cast<void>(result == Status::kOk ? ::pause() : ::kill(::getpid(), SIGABRT));
        }
    }
    EXPECT_EQ(line_.read_one(), 's');

    ASSERT_EQ(::kill(middle, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(middle, &status, 0), middle);
    EXPECT_EQ(line_.read_all(), "");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
