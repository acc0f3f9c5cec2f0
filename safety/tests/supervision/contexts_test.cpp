// SPDX-License-Identifier: Apache-2.0
// Goal: whichever context dies, hangs, runs too fast or does its work in the wrong order, the watchdog bites
// in bounded time, and the guilty entity is named; without a fault it never does. Method: two supervised
// contexts, the one that supervises, and a watchdog with a clock of its own, in virtual time; each fault in
// each context in turn, at several instants.
#include <array>
#include <cstdint>
#include <utility>

#include "mamori/safety/supervision/challenge_gate.hpp"
#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using literals::operator""_ms;
using literals::operator""_us;

enum class Entity : EntityIndex { kFast, kSlow };
enum class Point : CheckpointIndex { kRead, kCompute, kWrite, kScan, kPublish };

// A fast context runs each millisecond, a slow one each fourth; supervision ends its cycle each millisecond.
constexpr std::array kEntities{supervise(Entity::kFast), supervise(Entity::kSlow)};
constexpr std::array kCheckpoints{
    checkpoint(Point::kRead, Entity::kFast, CheckpointRole::kInitial),
    checkpoint(Point::kCompute, Entity::kFast, CheckpointRole::kInner),
    checkpoint(Point::kWrite, Entity::kFast, CheckpointRole::kFinal),
    checkpoint(Point::kScan, Entity::kSlow, CheckpointRole::kInitial),
    checkpoint(Point::kPublish, Entity::kSlow, CheckpointRole::kFinal),
};
constexpr std::array kAlives{alive(Point::kRead, {1U, 0U, 0U, 1U}), alive(Point::kScan, {1U, 0U, 0U, 4U})};
constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, {50_us, 300_us}),
                                deadline(Point::kScan, Point::kPublish, {50_us, 500_us})};
constexpr std::array kEdges{edge(Point::kRead, Point::kCompute), edge(Point::kCompute, Point::kWrite),
                            edge(Point::kScan, Point::kPublish)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges};

enum class Context { kFast, kSlow, kSupervision };
enum class Misdeed { kNone, kKill, kHang, kSpeedUp, kReorder, kRotate };

struct Fault {
    Context context;
    Misdeed misdeed;
    int from_ms;
};

/// Takes the torque away, by its own clock, after a wrong answer, one outside its window, or none.
class FakeDevice final : public ChallengeWatchdog {
  public:
    Result<std::uint32_t> get_question() noexcept override { return question_; }
    Status answer(Instant, std::uint32_t answer) noexcept override {
        const bool is_right = answer == calc_sound_answer(kTable, question_);
        const bool is_early = is_running_ && clock_ns_ - answered_ns_ < (500_us).ns;
        has_bitten_ = has_bitten_ || !is_right || is_early;
        question_ = question_ * 1664525U + 1013904223U;
        answered_ns_ = clock_ns_;
        is_running_ = true;
        return is_right ? Status::kOk : Status::kBadParameter;
    }
    void set_clock(std::int64_t now_ns) noexcept {
        clock_ns_ = now_ns;
        has_bitten_ = has_bitten_ || (is_running_ && now_ns - answered_ns_ > kLongestNs);
    }
    bool has_bitten() const noexcept { return has_bitten_; }

    static constexpr std::int64_t kLongestNs = 2500000;

  private:
    std::uint32_t question_{1U};
    std::int64_t clock_ns_{0};
    std::int64_t answered_ns_{0};
    bool is_running_{false};
    bool has_bitten_{false};
};

/// All contexts, a millisecond at a time. The order of events follows from their instants.
class Machine final {
  public:
    explicit Machine(Fault fault) : fault_(fault) {}

    void run_ms(int ms) {
        ms_ = ms;
        const std::int64_t begin = (1_ms * ms).ns;
        run_fast(begin + (100_us).ns);
        if (get_misdeed(Context::kFast) == Misdeed::kSpeedUp) {
            run_fast(begin + (400_us).ns);
        }
        if (ms % 4 == 0 || get_misdeed(Context::kSlow) == Misdeed::kSpeedUp) {
            run_slow(begin + (600_us).ns);
        }
        const bool is_rushed = get_misdeed(Context::kSupervision) == Misdeed::kSpeedUp;
        for (std::int64_t at_us = is_rushed ? 230 : 920; at_us <= 920; at_us += 230) {
            run_supervision(begin + at_us * 1000);
        }
        device_.set_clock(begin + (999_us).ns);
    }
    bool has_bitten() const { return device_.has_bitten(); }
    /// What the next start reads.
    ExpiryNote read_note() const { return rig_.memory.read(); }

  private:
    Misdeed get_misdeed(Context context) const {
        return context == fault_.context && ms_ >= fault_.from_ms ? fault_.misdeed : Misdeed::kNone;
    }
    void report(Entity entity, Point point, std::int64_t at_ns) { rig_.report_as(entity, point, at_ns); }

    void run_fast(std::int64_t at_ns) {
        const Misdeed misdeed = get_misdeed(Context::kFast);
        if (misdeed == Misdeed::kKill || has_fast_hung_) {
            return;
        }
        report(Entity::kFast, Point::kRead, at_ns);
        has_fast_hung_ = misdeed == Misdeed::kHang;
        if (has_fast_hung_) {
            return;
        }
        const bool is_swapped = misdeed == Misdeed::kReorder;
        report(Entity::kFast, is_swapped ? Point::kWrite : Point::kCompute, at_ns + (50_us).ns);
        report(Entity::kFast, is_swapped ? Point::kCompute : Point::kWrite, at_ns + (100_us).ns);
    }

    void run_slow(std::int64_t at_ns) {
        const Misdeed misdeed = get_misdeed(Context::kSlow);
        if (misdeed == Misdeed::kKill || has_slow_hung_) {
            return;
        }
        const bool is_swapped = misdeed == Misdeed::kReorder;
        report(Entity::kSlow, is_swapped ? Point::kPublish : Point::kScan, at_ns);
        has_slow_hung_ = misdeed == Misdeed::kHang;
        if (has_slow_hung_) {
            return;
        }
        report(Entity::kSlow, is_swapped ? Point::kScan : Point::kPublish, at_ns + (200_us).ns);
    }

    void run_supervision(std::int64_t at_ns) {
        device_.set_clock(at_ns);
        const Misdeed misdeed = get_misdeed(Context::kSupervision);
        if (misdeed == Misdeed::kKill) {
            return;
        }
        if (misdeed == Misdeed::kRotate) {
            answer(at_ns);  // with what the cycle before has proven
        }
        const std::uint32_t question = gate_.ask(Instant{at_ns});
        if (misdeed == Misdeed::kReorder) {
            answer(at_ns);
        }
        chain_ = ProofChain{question};
        status_ = rig_.sut.step(Instant{at_ns}, chain_);
        if (misdeed == Misdeed::kNone || misdeed == Misdeed::kSpeedUp) {
            answer(at_ns);
        }
    }
    void answer(std::int64_t at_ns) {
        static_cast<void>(gate_.step(Instant{at_ns}, to_global_status(status_), true, chain_.get_value()));
    }

    Fault fault_;
    int ms_{0};
    bool has_fast_hung_{false};
    bool has_slow_hung_{false};
    SupervisionRig<kTable> rig_{};
    FakeDevice device_{};
    ChallengeGate gate_{device_, {600_us, 2_ms}};
    ProofChain chain_{0U};
    SupervisionStatus status_{SupervisionStatus::kFailed};
};

/// @return first millisecond in which the watchdog has bitten; -1 when it did not.
int find_bite(Machine& machine, int length_ms) {
    for (int ms = 0; ms < length_ms; ++ms) {
        machine.run_ms(ms);
        if (machine.has_bitten()) {
            return ms;
        }
    }
    return -1;
}

/// Runs a fault that begins in each millisecond of a turn of the slow context.
/// @param[in] bound_ms from its begin to the bite, at most.
void expect_bite(Context context, Misdeed misdeed, int bound_ms) {
    for (int from_ms = 20; from_ms < 24; ++from_ms) {
        Machine machine{{context, misdeed, from_ms}};
        const int bite_ms = find_bite(machine, 100);
        EXPECT_GE(bite_ms, from_ms) << from_ms;
        EXPECT_LE(bite_ms, from_ms + bound_ms) << from_ms;
        if (context != Context::kSupervision) {
            const ExpiryNote note = machine.read_note();
            EXPECT_EQ(note.state, ExpiryState::kEntity);
            EXPECT_EQ(note.entity, context == Context::kFast ? 0U : 1U);
        }
    }
}

// From the first unanswered cycle to the bite, in whole milliseconds.
constexpr int kWatchdogMs = 3;
// Longest time in which the slow context may show nothing: its period, and the rest of a reference cycle.
constexpr int kSlowMs = 8;

TEST(ContextsTest, WatchdogDoesNotBiteWithoutAFault) {
    verifies("SWR-WDG-013");
    Machine machine{{Context::kFast, Misdeed::kNone, 0}};

    EXPECT_EQ(find_bite(machine, 10000), -1);
    EXPECT_EQ(machine.read_note().state, ExpiryState::kNone);
}

TEST(ContextsTest, WatchdogBitesWhenAContextIsKilled) {
    verifies("SWR-WDG-013", Technique::kFaultInjection, Polarity::kViolation);

    expect_bite(Context::kFast, Misdeed::kKill, kWatchdogMs);
    expect_bite(Context::kSlow, Misdeed::kKill, kSlowMs + kWatchdogMs);
    expect_bite(Context::kSupervision, Misdeed::kKill, kWatchdogMs);
}

TEST(ContextsTest, WatchdogBitesWhenAContextHangs) {
    verifies("SWR-WDG-013", Technique::kFaultInjection, Polarity::kViolation);

    expect_bite(Context::kFast, Misdeed::kHang, 1 + kWatchdogMs);
    expect_bite(Context::kSlow, Misdeed::kHang, kSlowMs + kWatchdogMs);
    expect_bite(Context::kSupervision, Misdeed::kHang, kWatchdogMs);
}

TEST(ContextsTest, WatchdogBitesWhenAContextRunsTooFast) {
    verifies("SWR-WDG-013", Technique::kFaultInjection, Polarity::kViolation);

    expect_bite(Context::kFast, Misdeed::kSpeedUp, kWatchdogMs);
    expect_bite(Context::kSlow, Misdeed::kSpeedUp, 2 + kWatchdogMs);
    expect_bite(Context::kSupervision, Misdeed::kSpeedUp, kWatchdogMs);
}

TEST(ContextsTest, WatchdogBitesWhenAContextDoesItsWorkInTheWrongOrder) {
    verifies("SWR-WDG-013", Technique::kFaultInjection, Polarity::kViolation);

    expect_bite(Context::kFast, Misdeed::kReorder, kWatchdogMs);
    expect_bite(Context::kSlow, Misdeed::kReorder, 4 + kWatchdogMs);
    expect_bite(Context::kSupervision, Misdeed::kReorder, kWatchdogMs);
    expect_bite(Context::kSupervision, Misdeed::kRotate, kWatchdogMs);
}

}  // namespace
}  // namespace mamori::safety
