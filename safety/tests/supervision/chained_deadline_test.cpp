// SPDX-License-Identifier: Apache-2.0
// Goal: the violation that was latched first stays while other deadlines follow it in a chain, where a
// checkpoint ends one deadline and starts the next. Method: directed sequences, and seeded random sequences
// against an oracle that is written from the rules alone.
#include <array>
#include <cstdint>
#include <random>

#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

using literals::operator""_ns;

enum class Point : CheckpointIndex { kZero, kOne, kTwo };
constexpr std::size_t kPoints = 3U;

constexpr std::array kEntities{supervise(Only::kEntity)};
constexpr std::array kCheckpoints{checkpoint(Point::kZero, Only::kEntity),
                                  checkpoint(Point::kOne, Only::kEntity),
                                  checkpoint(Point::kTwo, Only::kEntity)};
// A ring: each checkpoint ends one deadline and starts another. The rows are in both orders.
constexpr DeadlineLimits kLimits{10_ns, 100_ns};
constexpr std::array kForward{deadline(Point::kZero, Point::kOne, kLimits),
                              deadline(Point::kOne, Point::kTwo, kLimits)};
constexpr std::array kBackward{deadline(Point::kOne, Point::kTwo, kLimits),
                               deadline(Point::kZero, Point::kOne, kLimits)};
constexpr SupervisionTable kForwardTable{kEntities, kCheckpoints, {}, kForward, {}, 1U, 0xFFFFU};
constexpr SupervisionTable kBackwardTable{kEntities, kCheckpoints, {}, kBackward, {}, 1U, 0xFFFFU};

template <const auto& kTable>
void expect_first_violation_stays() {
    SupervisionRig<kTable> rig;
    rig.report(Point::kZero, 0);
    rig.report(Point::kOne, 101);  // too late, and the start of the next deadline
    rig.report(Point::kTwo, 151);  // in time
    rig.report(Point::kZero, 160);
    rig.report(Point::kOne, 200);

    EXPECT_EQ(rig.step(200), SupervisionStatus::kExpired);
    EXPECT_EQ(rig.get_violation(), Violation::kTooLong);
    for (std::int64_t now = 300; now < 1000; now += 100) {
        rig.report(Point::kZero, now);
        rig.report(Point::kOne, now + 50);
        EXPECT_EQ(rig.step(now + 60), SupervisionStatus::kExpired);
        EXPECT_EQ(rig.get_violation(), Violation::kTooLong);
    }
}

TEST(ChainedDeadlineTest, LegalDeadlineThatFollowsDoesNotOverwriteTheLatch) {
    verifies("SWR-SUP-005", Technique::kStateTransition, Polarity::kViolation);
    expect_first_violation_stays<kForwardTable>();
    expect_first_violation_stays<kBackwardTable>();
}

/// The rules of both deadlines: what a report at `now` violates, if anything.
class Oracle final {
  public:
    void report(std::size_t point, std::int64_t now) {
        if (violation != Violation::kNone) {
            return;
        }
        if (point > 0U) {
            const std::int64_t elapsed = now - started_[point - 1U];
            violation = !is_running_[point - 1U] ? Violation::kMissingStart
                        : elapsed > 100          ? Violation::kTooLong
                        : elapsed < 10           ? Violation::kTooShort
                                                 : Violation::kNone;
            is_running_[point - 1U] = false;
        }
        if (point < 2U) {
            if (is_running_[point] && violation == Violation::kNone) {
                violation = Violation::kMissingFinish;
            }
            is_running_[point] = true;
            started_[point] = now;
        }
    }
    void step(std::int64_t now) {
        for (std::size_t i = 0U; i < 2U; ++i) {
            if (violation == Violation::kNone && is_running_[i] && now - started_[i] > 100) {
                violation = Violation::kMissingFinish;
            }
        }
    }
    Violation violation{Violation::kNone};

  private:
    std::array<bool, 2U> is_running_{};
    std::array<std::int64_t, 2U> started_{};
};

TEST(ChainedDeadlineTest, FirstViolationOfEveryRandomSequenceStays) {
    verifies("SWR-SUP-005", Technique::kErrorGuessing, Polarity::kViolation);
    std::mt19937 random{24U};
    std::array<int, kCheckpointViolationMax + 1U> seen{};
    for (int run = 0; run < 20000; ++run) {
        SupervisionRig<kForwardTable> rig;
        Oracle oracle;
        std::int64_t now = 0;
        std::size_t point = 0U;
        for (int i = 0; i < 12; ++i) {
            now += random() % 8U == 0U ? static_cast<std::int64_t>(random() % 130U)
                                       : 10 + static_cast<std::int64_t>(random() % 40U);
            if (random() % 4U == 0U) {
                static_cast<void>(rig.step(now));
                oracle.step(now);
            } else {
                const std::size_t reported = random() % 10U == 0U ? random() % kPoints : point;
                point = (reported + 1U) % kPoints;
                rig.report(static_cast<Point>(reported), now);
                oracle.report(reported, now);
            }
        }
        static_cast<void>(rig.step(now));
        oracle.step(now);
        ASSERT_EQ(rig.get_violation(), oracle.violation) << "run " << run;
        ++seen[static_cast<std::size_t>(oracle.violation)];
    }
    for (const Violation violation : {Violation::kNone, Violation::kTooShort, Violation::kTooLong,
                                      Violation::kMissingFinish, Violation::kMissingStart}) {
        EXPECT_GT(seen[static_cast<std::size_t>(violation)], 100);
    }
}

}  // namespace
}  // namespace mamori::safety
