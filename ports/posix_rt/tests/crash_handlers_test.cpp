// SPDX-License-Identifier: Apache-2.0
// Goal: a crash closes the outputs, keeps all records that were written, is recorded with signal, address and
// component, and ends the process with the same status as without handlers. Method: processes that crash in
// each way, by their own code and by signals at random instants, most of them during a write of the recorder
// (the seed is printed on failure). Their parent reads the file.
#include "mamori/ports/posix_rt/crash_handlers.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"
#include "mamori/ports/posix_rt/crash_stack.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr std::size_t kCapacity = 256U;
constexpr std::uint64_t kUnreachable = 0x10U;
constexpr int kPatience =
    2'000'000'000;  ///< maximum number of loop iterations, for a child that never writes

/// Data that parent and child share.
struct Shared {
    std::atomic<std::uint64_t> first{0U};   ///< first number of the session
    std::atomic<std::uint64_t> newest{0U};  ///< number of the last record whose write has returned
    std::atomic<std::uint64_t> address{0U};
    std::atomic<int> closings{0};
    std::atomic<bool> is_writing{false};

    /// Runs for some time, and at least until a record was written.
    void spin(int rounds) const {
        for (volatile int i = 0; i < rounds || (!is_writing && i < kPatience); i = i + 1) {
        }
    }
    static void close_outputs(void* self) noexcept { static_cast<Shared*>(self)->closings.fetch_add(1); }
};

std::int64_t calc_argument(std::uint64_t sequence) {
    return static_cast<std::int64_t>(sequence * 0x9E3779B97F4A7C15U);
}

/// Objects of a child. They are never destroyed.
struct Child {
    MappedFile file{};
    FlightRecorder recorder{};
    CrashStack stack{};
    CrashHandlers handlers{};
    FrameClock clock = FrameClock::starting_in(0_ms);

    Child(const std::string& path, Shared& shared, void (*close)(void*) noexcept) {
        const rlimit no_core{0U, 0U};
        static_cast<void>(::setrlimit(RLIMIT_CORE, &no_core));
        if (file.open(path.c_str(), calc_recorder_file_size(kCapacity)) != Status::kOk ||
            recorder.open(get_recorder_region(file.get_region())) != Status::kOk ||
            stack.take() != Status::kOk ||
            handlers.install({close, &shared, file.get_region(), recorder.get_session(), clock}) !=
                Status::kOk) {
            ::_exit(1);
        }
        shared.first = recorder.get_next_sequence();
    }

    [[noreturn]] void write_until_killed(Shared& shared) {
        for (;;) {
            const std::uint64_t sequence = recorder.get_next_sequence();
            recorder.write(Instant{1}, Severity::kInfo, 1U, 2U, calc_argument(sequence));
            shared.newest.store(sequence, std::memory_order_release);
            shared.is_writing.store(true, std::memory_order_relaxed);
        }
    }
};

class CrashHandlersTest : public ::testing::Test {
  protected:
    CrashHandlersTest() {
        std::filesystem::remove(path_);
        void* const memory =
            ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        EXPECT_NE(memory, MAP_FAILED);
        shared_ = new (memory) Shared{};
    }
    ~CrashHandlersTest() override {
        static_cast<void>(::munmap(shared_, sizeof(Shared)));
        std::filesystem::remove(path_);
    }

    /// @param[in] act runs in the child, which ends with status 3 if `act` returns.
    /// @param[in] disturb runs in the parent meanwhile.
    /// @return exit status of the child.
    int run(const std::function<void(Child&)>& act, const std::function<void(pid_t)>& disturb = {},
            void (*close)(void*) noexcept = &Shared::close_outputs) {
        shared_->closings = 0;
        shared_->is_writing = false;
        const pid_t child = ::fork();
        if (child == 0) {
            Child self{path_, *shared_, close};
            act(self);
            ::_exit(3);
        }
        if (disturb) {
            disturb(child);
        }
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        return status;
    }

    void expect_killed_by(int status, int signal) const {
        EXPECT_TRUE(WIFSIGNALED(status)) << "status " << status;
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_EQ(shared_->closings, 1);
    }

    std::vector<std::byte> read_file() const {
        std::ifstream file{path_, std::ios::binary};
        std::vector<std::byte> bytes(std::filesystem::file_size(path_));
        file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return bytes;
    }

    CrashNote read_note() const {
        CrashNote note;
        const std::vector<std::byte> bytes = read_file();
        EXPECT_EQ(read_crash_note({bytes.data(), bytes.size()}, note), CrashNoteState::kWhole);
        return note;
    }

    /// All records of the session whose write had returned are intact, and at most one additional slot is
    /// torn.
    /// @return torn slots.
    int expect_records(int torn_before) const {
        const std::vector<std::byte> bytes = read_file();
        FlightReader reader;
        EXPECT_EQ(reader.open({bytes.data(), bytes.size()}), Status::kOk);
        int torn = 0;
        for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
            FlightRecord record{};
            const SlotState state = reader.read(slot, record);
            EXPECT_NE(state, SlotState::kCorrupt);
            torn += state == SlotState::kTorn ? 1 : 0;
            if (state == SlotState::kWhole) {
                EXPECT_EQ(record.argument, calc_argument(record.sequence));
            }
        }
        EXPECT_LE(torn, torn_before + 1);
        const std::uint64_t newest = shared_->newest;
        // The record in progress overwrites the oldest one. The child may not have reported a complete record
        // yet.
        const std::uint64_t oldest = newest + 2U > kCapacity ? newest + 2U - kCapacity + 1U : 1U;
        for (std::uint64_t number = std::max<std::uint64_t>(oldest, shared_->first); number <= newest;
             ++number) {
            FlightRecord record{};
            EXPECT_EQ(reader.read(flight::calc_slot(number, kCapacity), record), SlotState::kWhole) << number;
            EXPECT_EQ(record.sequence, number);
        }
        return torn;
    }

    const std::string path_ = ::testing::TempDir() + "crash_" + std::to_string(::getpid());
    Shared* shared_{nullptr};
};

// Functions that crash. Their undefined behaviour is intended.

__attribute__((no_sanitize("undefined", "address"))) void reach_nowhere(Shared&) {
    volatile std::uintptr_t place = kUnreachable;
    *reinterpret_cast<volatile int*>(place) = 1;
}

__attribute__((no_sanitize("undefined", "address"))) void reach_behind_a_file(Shared& shared) {
    const int memory_file = ::memfd_create("crash", 0U);
    void* const memory = ::mmap(nullptr, 4096U, PROT_READ | PROT_WRITE, MAP_SHARED, memory_file, 0);
    shared.address = reinterpret_cast<std::uintptr_t>(memory);
    *static_cast<volatile int*>(memory) = 1;
}

__attribute__((no_sanitize("undefined"))) void divide_by_zero(Shared&) {
    volatile int one = 1;
    volatile int zero = 0;
    volatile int result = one / zero;
    static_cast<void>(result);
}

void break_an_invariant(Shared&) {
    volatile bool holds = false;
    MAMORI_INVARIANT(1, holds);
}

void give_up(Shared&) {
    std::abort();
}

void trap(Shared&) {
    static_cast<void>(::raise(SIGTRAP));
}

__attribute__((noinline, no_sanitize("address"))) int use_up_stack(volatile int depth) {
    volatile char room[4096];
    room[0] = static_cast<char>(depth);
    return depth < 0 ? 0 : use_up_stack(depth + 1) + room[0];
}

struct CrashCase {
    const char* name;
    void (*crash)(Shared&);
    int signal;
    bool is_sent;
    bool has_address;
};
void PrintTo(const CrashCase& example, std::ostream* out) {
    *out << example.name;
}

class CrashCaseTest : public CrashHandlersTest, public ::testing::WithParamInterface<CrashCase> {};

TEST_P(CrashCaseTest, IsRecordedAndLosesNoRecordWhileAnotherThreadWrites) {
    verifies("SWR-PRT-027", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 20261122U;
    constexpr std::uint32_t kRounds = 25U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 generator{kSeed};
    int torn = 0;
    for (std::uint32_t round = 1U; round <= kRounds; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const int spins = std::uniform_int_distribution<int>{0, 300'000}(generator);
        const int status = run([&](Child& self) {
            std::thread faulty{[&] {
                CrashStack stack;
                static_cast<void>(stack.take());
                set_crash_place(3U, 7U);
                shared_->spin(spins);
                GetParam().crash(*shared_);
                ::_exit(4);
            }};
            self.write_until_killed(*shared_);
        });

        expect_killed_by(status, GetParam().signal);
        torn = expect_records(torn);
        const CrashNote note = read_note();
        EXPECT_EQ(note.signal, GetParam().signal);
        EXPECT_EQ(note.is_sent, GetParam().is_sent);
        EXPECT_EQ(note.session, round);
        EXPECT_EQ(note.place.window, 3U);
        EXPECT_EQ(note.place.component, 7U);
        EXPECT_EQ(note.address != 0U, GetParam().has_address);
        if (GetParam().signal == SIGSEGV) {
            EXPECT_EQ(note.address, kUnreachable);
        } else if (GetParam().signal == SIGBUS) {
            EXPECT_EQ(note.address, shared_->address);
        }
        if (HasFailure()) {
            break;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, CrashCaseTest,
                         ::testing::Values(CrashCase{"segv", &reach_nowhere, SIGSEGV, false, true},
                                           CrashCase{"bus", &reach_behind_a_file, SIGBUS, false, true},
                                           CrashCase{"fpe", &divide_by_zero, SIGFPE, false, true},
                                           CrashCase{"ill", &break_an_invariant, SIGILL, false, true},
                                           CrashCase{"abrt", &give_up, SIGABRT, true, false},
                                           CrashCase{"trap", &trap, SIGTRAP, true, false}),
                         [](const auto& example) { return std::string{example.param.name}; });

TEST_F(CrashHandlersTest, CrashDuringAWriteOfTheRecorderCorruptsAtMostThatRecord) {
    verifies("SWR-PRT-027", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 4077U;
    constexpr std::uint32_t kRounds = 120U;
    constexpr std::uint32_t kRoundsMax = 10U * kRounds;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 generator{kSeed};
    int torn = 0;
    int torn_rounds = 0;
    // Whether a signal comes inside a write is up to the host: a busy one needs more rounds.
    for (std::uint32_t round = 1U;
         (round <= kRounds || (torn_rounds == 0 && round <= kRoundsMax)) && !HasFailure(); ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const int signal = kCrashSignals[round % kCrashSignals.size()];
        const int status = run([&](Child& self) { self.write_until_killed(*shared_); },
                               [&](pid_t child) {
                                   const int spins =
                                       std::uniform_int_distribution<int>{0, 100'000}(generator);
                                   shared_->spin(spins);
                                   EXPECT_EQ(::kill(child, signal), 0);
                               });

        expect_killed_by(status, signal);
        const int now_torn = expect_records(torn);
        torn_rounds += now_torn > torn ? 1 : 0;
        torn = now_torn;
        const CrashNote note = read_note();
        EXPECT_EQ(note.signal, signal);
        EXPECT_TRUE(note.is_sent);
        EXPECT_EQ(note.address, 0U);
        EXPECT_EQ(note.session, round);
        EXPECT_EQ(note.place.window, CrashPlace::kNone);
    }
    RecordProperty("rounds_with_a_torn_record", torn_rounds);
    EXPECT_GT(torn_rounds, 0) << "no signal came inside a write";
}

/// Runs a component that crashes as the second step of window 1, whose first component is the fourth.
void crash_in_a_window(void (*crash)() noexcept) {
    static std::array<WindowThread, 2U> threads;
    static const FrameClock clock = FrameClock::starting_in(0_ms);
    static GuardedHost host{threads, clock, {}};
    const auto run = [](void* argument, std::size_t begin, std::size_t) noexcept {
        if (begin == 1U) {
            reinterpret_cast<void (*)() noexcept>(argument)();
        }
    };
    WindowHost::Work work{run, reinterpret_cast<void*>(crash), 1U, 4U, 0U, 3U, WindowHost::Pass::kExecute};
    if (host.open() == Status::kOk) {
        static_cast<void>(host.run_within(work, clock.get_now() + Duration{60'000'000'000}));
    }
}

TEST_F(CrashHandlersTest, ReplacedPlanIsUsed) {
    verifies("SWR-PRT-026", Technique::kInterface, Polarity::kNominal);
    const int status = run([this](Child& child) {
        CrashPlan plan{nullptr, shared_, child.file.get_region(), 77U, child.clock};
        bool is_ok = child.handlers.replace(plan) == Status::kBadParameter;
        plan.close_outputs = &Shared::close_outputs;
        is_ok = is_ok && CrashHandlers{}.replace(plan) == Status::kPreconditionNotMet;
        for (; is_ok && plan.session < 80U; ++plan.session) {
            is_ok = child.handlers.replace(plan) == Status::kOk;
        }
        static_cast<void>(is_ok && ::raise(SIGSEGV) == 0);
    });
    expect_killed_by(status, SIGSEGV);
    EXPECT_EQ(read_note().session, 79U);
}

TEST_F(CrashHandlersTest, CrashOfAComponentIsRecordedWithItsIndexInTheTable) {
    verifies("SWR-PRT-027", Technique::kFaultInjection, Polarity::kViolation);
    const int status = run([](Child&) {
        crash_in_a_window([]() noexcept {
            volatile std::uintptr_t place = kUnreachable;
            *reinterpret_cast<volatile int*>(place) = 1;
        });
    });

    expect_killed_by(status, SIGSEGV);
    EXPECT_EQ(read_note().place.window, 1U);
    EXPECT_EQ(read_note().place.component, 5U);
}

TEST_F(CrashHandlersTest, StackOverflowOfAComponentIsRecorded) {
    verifies("SWR-PRT-026", Technique::kFaultInjection, Polarity::kViolation);
    const int status =
        run([](Child&) { crash_in_a_window([]() noexcept { static_cast<void>(use_up_stack(0)); }); });

    expect_killed_by(status, SIGSEGV);
    EXPECT_EQ(read_note().place.component, 5U);
    EXPECT_FALSE(read_note().is_sent);
}

TEST_F(CrashHandlersTest, StackOverflowOfTheMainThreadIsRecorded) {
    verifies("SWR-PRT-026", Technique::kFaultInjection, Polarity::kViolation);
    expect_killed_by(run([](Child&) { static_cast<void>(use_up_stack(0)); }), SIGSEGV);
    EXPECT_EQ(read_note().signal, SIGSEGV);
}

TEST_F(CrashHandlersTest, WatchdogThatEndsTheProcessIsRecordedAsCause) {
    verifies("SWR-PRT-027", Technique::kFaultInjection, Polarity::kViolation);
    const int status = run([this](Child& self) {
        SoftwareWatchdog watchdog{self.clock, {0_ms, 2_ms}, {&Shared::close_outputs, shared_, true}};
        if (watchdog.open({}) == Status::kOk && watchdog.service(self.clock.get_now()) == Status::kOk) {
            self.write_until_killed(*shared_);
        }
    });

    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGABRT);
    EXPECT_EQ(shared_->closings, 2) << "by the watchdog, and by the crash";
    EXPECT_EQ(read_note().place.component, CrashPlace::kWatchdog);
    static_cast<void>(expect_records(0));
}

TEST_F(CrashHandlersTest, CrashesOfSeveralThreadsCloseTheOutputsOnce) {
    verifies("SWR-PRT-026", Technique::kErrorGuessing, Polarity::kViolation);
    for (int round = 0; round < 20 && !HasFailure(); ++round) {
        const int status = run([this](Child&) {
            std::vector<std::thread> threads;
            std::atomic<int> ready{0};
            for (int i = 0; i < 4; ++i) {
                threads.emplace_back([&] {
                    ++ready;
                    while (ready < 4) {
                    }
                    reach_nowhere(*shared_);
                });
            }
            threads[0].join();
        });
        expect_killed_by(status, SIGSEGV);
        EXPECT_EQ(read_note().address, kUnreachable);
    }
}

TEST_F(CrashHandlersTest, CrashWhileTheOutputsAreClosedEndsTheProcess) {
    verifies("SWR-PRT-026", Technique::kErrorGuessing, Polarity::kViolation);
    const int faulty = run([this](Child&) { give_up(*shared_); }, {},
                           [](void* self) noexcept {
                               Shared::close_outputs(self);
                               reach_nowhere(*static_cast<Shared*>(self));
                           });
    expect_killed_by(faulty, SIGSEGV);
    const int aborting = run([this](Child&) { reach_nowhere(*shared_); }, {},
                             [](void* self) noexcept {
                                 Shared::close_outputs(self);
                                 std::abort();
                             });
    expect_killed_by(aborting, SIGABRT);
}

TEST_F(CrashHandlersTest, HandlerThatHangsIsEndedByTheWatchdog) {
    verifies("SWR-PRT-026", Technique::kErrorGuessing, Polarity::kViolation);
    const auto hang = [](void* self) noexcept {
        while (static_cast<Shared*>(self)->closings >= 0) {
        }
    };
    const int status = run(
        [this](Child& self) {
            SoftwareWatchdog watchdog{self.clock, {0_ms, 2_ms}, {&Shared::close_outputs, shared_, true}};
            if (watchdog.open({}) == Status::kOk && watchdog.service(self.clock.get_now()) == Status::kOk) {
                reach_nowhere(*shared_);
            }
        },
        {}, hang);
    expect_killed_by(status, SIGABRT);
}

TEST_F(CrashHandlersTest, WithoutAFileTheOutputsAreClosed) {
    verifies("SWR-PRT-026");
    const int status = run([this](Child& self) {
        self.handlers.remove();
        CrashHandlers other;
        if (other.install({&Shared::close_outputs, shared_, {}, 0U, self.clock}) == Status::kOk) {
            reach_nowhere(*shared_);
        }
    });
    expect_killed_by(status, SIGSEGV);
    CrashNote note;
    const std::vector<std::byte> bytes = read_file();
    EXPECT_EQ(read_crash_note({bytes.data(), bytes.size()}, note), CrashNoteState::kEmpty);
}

TEST_F(CrashHandlersTest, OrderlyEndWritesNoRecordAndKeepsThePreviousOne) {
    verifies("SWR-PRT-027");
    CrashNote note;
    EXPECT_EQ(WEXITSTATUS(run([](Child&) {})), 3);
    const std::vector<std::byte> bytes = read_file();
    EXPECT_EQ(read_crash_note({bytes.data(), bytes.size()}, note), CrashNoteState::kEmpty);
    static_cast<void>(run([this](Child&) { give_up(*shared_); }));
    EXPECT_EQ(WEXITSTATUS(run([](Child&) {})), 3);
    EXPECT_EQ(read_note().session, 2U) << "of the session that crashed";
    EXPECT_EQ(shared_->closings, 0);
}

TEST_F(CrashHandlersTest, InvalidPlanAndSecondHandlersAreRejected) {
    verifies("SWR-PRT-026", Technique::kEquivalenceClasses, Polarity::kViolation);
    MappedFile file;
    ASSERT_EQ(file.open(path_.c_str(), calc_recorder_file_size(1U)), Status::kOk);
    const Span<std::byte> region = file.get_region();
    const FrameClock clock = FrameClock::starting_in(0_ms);
    CrashHandlers sut;
    EXPECT_EQ(sut.install({nullptr, nullptr, {}, 0U, clock}), Status::kBadParameter);
    EXPECT_EQ(
        sut.install({&Shared::close_outputs, shared_, region.subspan(0U, kCrashNoteSize - 1U), 0U, clock}),
        Status::kBadParameter);
    EXPECT_EQ(sut.install({&Shared::close_outputs, shared_, region.subspan(1U, kCrashNoteSize), 0U, clock}),
              Status::kBadParameter);
    EXPECT_EQ(sut.install({&Shared::close_outputs, shared_, region.subspan(0U, kCrashNoteSize), 0U, clock}),
              Status::kOk);
    sut.remove();
    struct sigaction before{};
    ASSERT_EQ(::sigaction(SIGSEGV, nullptr, &before), 0);
    ASSERT_EQ(sut.install({&Shared::close_outputs, shared_, region, 0U, clock}), Status::kOk);
    CrashHandlers second;
    EXPECT_EQ(second.install({&Shared::close_outputs, shared_, {}, 0U, clock}), Status::kPreconditionNotMet);
    second.remove();

    sut.remove();

    struct sigaction after{};
    ASSERT_EQ(::sigaction(SIGSEGV, nullptr, &after), 0);
    EXPECT_EQ(after.sa_handler, before.sa_handler);
    EXPECT_EQ(second.install({&Shared::close_outputs, shared_, {}, 0U, clock}), Status::kOk);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
