// SPDX-License-Identifier: Apache-2.0
// Goal: the owner of a partition leaves no zombie and no descriptor, and never signals a process that reuses
// the id of an ended partition. Method: the test waits for the partition before its owner does and assigns
// its id to another process. System calls are rejected to execute the paths for older and exhausted systems.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/sched.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>

#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/line.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr unsigned int kToGroup{4U};  // PIDFD_SIGNAL_PROCESS_GROUP
constexpr std::array<const char*, 1U> kForLong{"1000"};

std::ptrdiff_t count_descriptors() {
    const std::filesystem::directory_iterator all{"/proc/self/fd"};
    return std::distance(begin(all), end(all));
}

void expect_no_child() {
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child remains";
    EXPECT_EQ(errno, ECHILD);
}

/// Waits for the process before its owner has seen the end.
void steal_end(pid_t pid) {
    int status = 0;
    EXPECT_EQ(::waitpid(pid, &status, 0), pid);
}

bool knows_groups_by_descriptor() {
    const int self = static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0));
    errno = 0;
    const bool is_known =
        ::syscall(SYS_pidfd_send_signal, self, 0, nullptr, kToGroup) == 0 || errno != EINVAL;
    static_cast<void>(::close(self));
    return is_known;
}

/// A process with a given id and a group of the same id. It ends on request.
class Bystander final {
  public:
    explicit Bystander(pid_t number) {
        clone_args arguments{};
        arguments.exit_signal = SIGCHLD;
        arguments.set_tid = reinterpret_cast<std::uint64_t>(&number);
        arguments.set_tid_size = 1U;
        pid_ = static_cast<pid_t>(::syscall(SYS_clone3, &arguments, sizeof(arguments)));
        if (pid_ == 0) {
            static_cast<void>(::setpgid(0, 0));
            for (;;) {
                static_cast<void>(::pause());
            }
        }
        if (pid_ > 0) {
            static_cast<void>(::setpgid(pid_, pid_));
        }
    }
    Bystander(const Bystander&) = delete;
    Bystander& operator=(const Bystander&) = delete;
    ~Bystander() {
        if (pid_ > 0) {
            static_cast<void>(::kill(pid_, SIGKILL));
            static_cast<void>(::waitpid(pid_, nullptr, 0));
        }
    }
    bool is_there() const { return pid_ > 0; }
    bool is_alive() const {
        static_cast<void>(::poll(nullptr, 0U, 20));  // time for a signal to arrive
        return ::waitpid(pid_, nullptr, WNOHANG) == 0;
    }

  private:
    pid_t pid_{-1};
};

/// The test kills a partition, waits for it, reuses its id, and then destroys the owner of the partition.
void expect_that_a_reused_number_is_left_alone() {
    for (int round = 0; round < 3; ++round) {
        PartitionProcess sut;
        ASSERT_EQ(sut.start({"/bin/sleep", kForLong, {}, nullptr, {}}), Status::kOk);
        const pid_t number = sut.get_pid();
        ASSERT_EQ(::kill(number, SIGKILL), 0);
        steal_end(number);
        const Bystander bystander{number};
        ASSERT_TRUE(bystander.is_there()) << errno;

        if (round == 0) {
            EXPECT_EQ(sut.end(), Status::kOk);
        } else if (round == 1) {
            EXPECT_EQ(sut.send_signal(SIGKILL), Status::kPreconditionNotMet);
        }
        EXPECT_TRUE(bystander.is_alive());
        EXPECT_EQ(sut.check(), PartitionState::kEnded);
        EXPECT_EQ(sut.get_exit_status(), -1);
        EXPECT_EQ(sut.get_signal(), 0);
        EXPECT_TRUE(bystander.is_alive());
    }
}

bool may_choose_numbers() {
    const pid_t free = ::fork();
    if (free == 0) {
        ::_exit(0);
    }
    steal_end(free);
    return Bystander{free}.is_there();
}

TEST(PartitionLifeTest, AThousandCyclesLeaveNoZombieAndNoDescriptor) {
    verifies("SWR-PRT-061", Technique::kErrorGuessing, Polarity::kViolation);
    const std::ptrdiff_t before = count_descriptors();
    for (int i = 0; i < 250; ++i) {
        PartitionProcess ended;
        ASSERT_EQ(ended.start({"/bin/sleep", kForLong, {}, nullptr, {}}), Status::kOk);
        EXPECT_EQ(ended.end(), Status::kOk);
        EXPECT_EQ(wait_for_end(ended), PartitionState::kEnded);
        ASSERT_EQ(ended.start({"/bin/true", {}, {}, nullptr, {}}), Status::kOk);
        ASSERT_EQ(wait_for_end(ended), PartitionState::kEnded) << "the process has exited";
        ASSERT_EQ(ended.start({"/no/such/program", {}, {}, nullptr, {}}), Status::kError);
        PartitionProcess destroyed;
        ASSERT_EQ(destroyed.start({"/bin/sleep", kForLong, {}, nullptr, {}}), Status::kOk);
    }

    expect_no_child();
    EXPECT_EQ(count_descriptors(), before);
}

TEST(PartitionLifeTest, SignalsToTheOwnerLeaveNoZombie) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    struct sigaction action{};
    struct sigaction previous{};
    action.sa_handler = [](int) {};  // without SA_RESTART: waits end early
    ASSERT_EQ(::sigaction(SIGALRM, &action, &previous), 0);
    const itimerval often{{0, 50}, {0, 50}};
    ASSERT_EQ(::setitimer(ITIMER_REAL, &often, nullptr), 0);

    for (int i = 0; i < 200; ++i) {
        PartitionProcess sut;
        EXPECT_EQ(sut.start({"/no/such/program", {}, {}, nullptr, {}}), Status::kError);
        EXPECT_EQ(sut.get_error(), PartitionError::kCannotExecute);
        EXPECT_EQ(sut.start({"/bin/true", {}, {}, nullptr, {}}), Status::kOk);
    }
    const itimerval never{};
    ASSERT_EQ(::setitimer(ITIMER_REAL, &never, nullptr), 0);
    ASSERT_EQ(::sigaction(SIGALRM, &previous, nullptr), 0);
    expect_no_child();
}

TEST(PartitionLifeTest, AProcessThatReusesTheIdGetsNoSignal) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    if (!may_choose_numbers()) {
        GTEST_SKIP() << "verdict=no-privilege: only root may choose the id of a process (CAP_SYS_ADMIN)";
    }
    expect_that_a_reused_number_is_left_alone();
    EXPECT_EQ(run_in_process([] {
                  ASSERT_TRUE(refuse_call(SYS_pidfd_send_signal, EINVAL, true));
                  expect_that_a_reused_number_is_left_alone();
              }),
              0)
        << "before Linux 6.9";
}

TEST(PartitionLifeTest, TheGroupOfAnAlreadyReapedProcessEndsToo) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    if (!knows_groups_by_descriptor()) {
        GTEST_SKIP() << "verdict=not-shown: before Linux 6.9, a group has no descriptor";
    }
    Line line;
    const std::array<const char*, 2U> arguments{"-c", "sleep 1000 & exit 0"};
    const std::array<int, 1U> descriptors{line.get_writing_end()};
    PartitionProcess sut;
    ASSERT_EQ(sut.start({"/bin/sh", arguments, descriptors, nullptr, {}}), Status::kOk);
    steal_end(sut.get_pid());

    EXPECT_EQ(sut.check(), PartitionState::kEnded);
    EXPECT_EQ(sut.get_exit_status(), -1) << "unknown";
    EXPECT_EQ(line.read_all(), "");
}

TEST(PartitionLifeTest, OlderSystemsEndTheGroupByItsId) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    Line line;
    EXPECT_EQ(run_in_process([&line] {
                  ASSERT_TRUE(refuse_call(SYS_pidfd_send_signal, EINVAL, true));
                  const std::array<int, 1U> descriptors{line.get_writing_end()};
                  PartitionProcess sut;
                  for (const char* script : {"sleep 1000 & exit 7", "sleep 1000 & sleep 1000"}) {
                      const std::array<const char*, 2U> arguments{"-c", script};
                      ASSERT_EQ(sut.start({"/bin/sh", arguments, descriptors, nullptr, {}}), Status::kOk);
                      if (script[13] == 's') {
                          EXPECT_EQ(sut.end(), Status::kOk);
                      }
                      EXPECT_EQ(wait_for_end(sut), PartitionState::kEnded);
                      EXPECT_EQ(sut.get_exit_status(), script[13] == 's' ? -1 : 7);
                  }
                  expect_no_child();
              }),
              0);
    EXPECT_EQ(line.read_all(), "");
}

TEST(PartitionLifeTest, TheEndIsDetectedAlsoIfSigchldIsIgnored) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  static_cast<void>(std::signal(SIGCHLD, SIG_IGN));
                  PartitionProcess sut;
                  for (int i = 0; i < 100; ++i) {
                      ASSERT_EQ(sut.start({"/bin/true", {}, {}, nullptr, {}}), Status::kOk) << i;
                      ASSERT_EQ(wait_for_end(sut), PartitionState::kEnded);
                      EXPECT_EQ(sut.get_exit_status(), -1);
                      EXPECT_EQ(sut.get_signal(), 0);
                  }
                  expect_no_child();
              }),
              0);
}

TEST(PartitionLifeTest, AFailedStartLeavesNothing) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        std::uint32_t call;
        Status status;
        PartitionError error;
        int system_error;
    };
    for (const Case example :
         {Case{SYS_pidfd_open, Status::kError, PartitionError::kCannotWatch, ENOSYS},
          Case{SYS_setsid, Status::kError, PartitionError::kCannotRestrict, ENOSYS},
          Case{SYS_close_range, Status::kError, PartitionError::kCannotHandOver, ENOSYS},
          Case{SYS_recvmsg, Status::kOutOfResources, PartitionError::kNoProcess, EMFILE}}) {
        EXPECT_EQ(run_in_process([&example] {
                      const std::ptrdiff_t before = count_descriptors();
                      ASSERT_TRUE(refuse_call(example.call, ENOSYS, false));
                      PartitionProcess sut;
                      EXPECT_EQ(sut.start({"/bin/sleep", kForLong, {}, nullptr, {}}), example.status);
                      EXPECT_EQ(sut.get_error(), example.error) << describe(sut.get_error());
                      EXPECT_EQ(sut.get_system_error(), example.system_error);
                      EXPECT_EQ(sut.get_pid(), -1);
                      EXPECT_EQ(sut.check(), PartitionState::kNone);
                      expect_no_child();
                      EXPECT_EQ(count_descriptors(), before);
                  }),
                  0)
            << example.call;
    }
}

TEST(PartitionLifeTest, ASignalReachesTheProcessWhileItRuns) {
    verifies("SWR-PRT-061");
    PartitionProcess sut;
    EXPECT_EQ(sut.send_signal(SIGTERM), Status::kPreconditionNotMet);
    ASSERT_EQ(sut.start({"/bin/sleep", kForLong, {}, nullptr, {}}), Status::kOk);

    EXPECT_EQ(sut.send_signal(-1), Status::kBadParameter);
    EXPECT_EQ(sut.send_signal(0), Status::kOk);
    EXPECT_EQ(sut.send_signal(SIGTERM), Status::kOk);
    EXPECT_EQ(wait_for_end(sut), PartitionState::kEnded);
    EXPECT_EQ(sut.get_signal(), SIGTERM);
    EXPECT_EQ(sut.send_signal(SIGTERM), Status::kPreconditionNotMet);
}

TEST(PartitionLifeTest, ASignalWithoutPermissionIsReported) {
    verifies("SWR-PRT-061", Technique::kFaultInjection, Polarity::kViolation);
    EXPECT_EQ(run_in_process([] {
                  PartitionProcess sut;
                  ASSERT_EQ(sut.start({"/bin/sleep", kForLong, {}, nullptr, {}}), Status::kOk);
                  ASSERT_TRUE(refuse_call(SYS_pidfd_send_signal, EPERM, false));
                  EXPECT_EQ(sut.send_signal(SIGTERM), Status::kError);
                  EXPECT_EQ(sut.check(), PartitionState::kRunning);
                  ASSERT_EQ(::kill(sut.get_pid(), SIGKILL), 0);
              }),
              0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
