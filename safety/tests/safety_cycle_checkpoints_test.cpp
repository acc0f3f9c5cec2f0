// SPDX-License-Identifier: Apache-2.0
// Goal: a component whose checkpoints violate their table expires with its cause, and a reset clears it once
// they are right again. Method: a table with two supervised sequences; the reports are made, left out,
// repeated or delayed by the test.
#include <new>

#include "safety_cycle_fixture.hpp"

namespace mamori::safety::testing_of_cycle {
namespace {

enum class Entity { kController, kLogger };
enum class Point { kRead, kWrite, kLog };
constexpr std::array kEntities{supervise(Entity::kController), supervise(Entity::kLogger)};
constexpr std::array kPoints{checkpoint(Point::kRead, Entity::kController, CheckpointRole::kInitial),
                             checkpoint(Point::kWrite, Entity::kController, CheckpointRole::kFinal),
                             checkpoint(Point::kLog, Entity::kLogger)};
constexpr std::array kAlives{alive(Point::kLog, {1U, 0U, 0U, 1U})};
constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, {50_us, 300_us})};
constexpr std::array kEdges{edge(Point::kRead, Point::kWrite)};
constexpr std::uint32_t kTolerated = 5U;
constexpr SupervisionTable kTable{kEntities, kPoints, kAlives, kDeadlines, kEdges, 1U, kTolerated};
constexpr SupervisionTable kOtherTable{kEntities, kPoints, kAlives, kDeadlines, kEdges};

/// The supervisor of all tests, made again for each: the table below refers to its address.
struct Supervision {
    SupervisionStorage<kTable> storage{};
    ExpiryStorage expiry{};
    ExpiryMemory memory{expiry};
    CheckpointSupervisor supervisor{storage, memory};
};
Supervision g_points;

Decider g_cycle{"cycle"};
Watched g_control{"control"};
Watched g_log{"log"};
Sensor g_measure{"measure"};
/// @tparam kOf table of the supervisor, or another one.
template <const auto& kOf>
constexpr auto make_system() noexcept {
    return safety::system(
        frame(kFrame), window("all", 0_us, kFrame, budget(kFrame), run(g_measure, g_cycle, g_control, g_log)),
        connect(g_measure.seen, g_cycle.seen, any_age()),
        confirmed_by(g_measure.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                     StopConfirmation::kTorqueOff),
        faults<Fault::kFast, Fault::kSlip, Fault::kSilent>(),
        react(Fault::kFast, Reaction::kSto, within(2_ms)), react(Fault::kSlip, Reaction::kSs1, within(3_ms)),
        react(Fault::kSilent, Reaction::kSs2, within(2_ms)), supervise(g_cycle, alive(), deadline(100_us)),
        supervise(g_measure, alive(), deadline(100_us)),
        supervise(g_control, alive(), deadline(400_us),
                  checkpoints<kOf>(g_points.supervisor, Entity::kController), raises(Fault::kSilent)),
        supervise(g_log, alive(), deadline(100_us), checkpoints<kOf>(g_points.supervisor, Entity::kLogger)),
        cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
              torque_feedback(kTorqueFeedback), tolerated_lateness(50_us),
              on_late_reaction(raises(Fault::kFast)), on_failed_self_test(raises(Fault::kFast)),
              on_unconfirmed_brakes(raises(Fault::kFast))));
}
constexpr auto kChecked = make_system<kTable>();
constexpr auto kMismatched = make_system<kOtherTable>();
MAMORI_SAFETY_CHECK(kChecked);
constexpr std::size_t kControl = index_of(kChecked, g_control);
constexpr std::size_t kLog = index_of(kChecked, g_log);

class CheckpointsTest : public ::testing::Test {
  protected:
    void SetUp() override {
        new (&g_points) Supervision;
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        sut_.inputs.is_standing = true;
        sut_.inputs.are_brakes_closed = true;
        sut_.inputs.may_start = true;
        step();
        step();
        sut_.inputs.start_button = true;
        step();
        ASSERT_EQ(sut_.get_state(), SafeState::kOperational);
    }
    void report(Point point, Duration after = {}) {
        const Entity entity = point == Point::kLog ? Entity::kLogger : Entity::kController;
        g_points.storage.get_log(entity).report(point, now_ + after);
    }
    /// Runs all components. Each reports its checkpoints; the test can replace the controller's reports.
    SafeState step(bool is_controller_correct = true) {
        for (std::size_t i = 0U; i < kChecked.components.size(); ++i) {
            state_.get_observer().get_records()[i].note_run(now_, now_ + 100_us);
        }
        if (is_controller_correct) {
            report(Point::kRead, 0_us);
            report(Point::kWrite, 100_us);
        }
        report(Point::kLog);
        now_ = now_ + kFrame;
        EXPECT_EQ(sut_.on_execute({0, now_}), Status::kOk);
        sut_.inputs.applied = sut_.outputs;
        sut_.inputs.has_torque = sut_.outputs.torque_enable;
        sut_.inputs.are_brakes_closed = !sut_.outputs.brake_release;
        return sut_.get_state();
    }
    void expect_expired(std::size_t component, ExpiryCause cause) {
        EXPECT_EQ(sut_.get_last_expiry().component, component);
        EXPECT_EQ(sut_.get_last_expiry().cause, cause);
    }

    SafetyStorage<kChecked> storage_;
    SpyWatchdog watchdog_;
    SafetyState state_{storage_, watchdog_};
    std::array<Event, 32U> events_{};
    EventLog log_{events_};
    FakeMachine sut_{state_, &log_};
    Instant now_{};
};

TEST_F(CheckpointsTest, CheckpointsInOrderAndTimeExpireNothing) {
    verifies("SWR-CYC-014", Technique::kBoundaryValues);
    const int services = watchdog_.services;
    for (int i = 1; i <= 20; ++i) {
        report(Point::kRead);
        report(Point::kWrite, i % 2 == 0 ? 300_us : 50_us);
        ASSERT_EQ(step(false), SafeState::kOperational);
        ASSERT_EQ(watchdog_.services, services + i);
    }
    expect_expired(kNoIndex, ExpiryCause::kNone);
}

TEST_F(CheckpointsTest, ACheckpointOutOfOrderIsTheCause) {
    verifies("SWR-CYC-014", Technique::kFaultInjection, Polarity::kViolation);
    const int services = watchdog_.services;
    report(Point::kWrite);

    EXPECT_EQ(step(false), SafeState::kProtectiveStopSs2);
    expect_expired(kControl, ExpiryCause::kOutOfOrder);
    EXPECT_STREQ(kExpiryCauseNames[static_cast<std::size_t>(ExpiryCause::kOutOfOrder)], "out_of_order");
    EXPECT_EQ(watchdog_.services, services + 1) << "its failure is a fault";
}

TEST_F(CheckpointsTest, TheEventNamesTheComponentThatIsOutOfOrder) {
    verifies("SWR-CYC-010", Technique::kFaultInjection, Polarity::kViolation);
    report(Point::kWrite);
    step(false);

    std::vector<Event> expired;
    for (std::size_t i = 0U; i < log_.size(); ++i) {
        if (log_.get(i).code == static_cast<std::uint16_t>(CycleEvent::kComponentExpired)) {
            expired.push_back(log_.get(i));
        }
    }
    ASSERT_EQ(expired.size(), 1U);
    EXPECT_EQ(expired[0U].source, kControl + 1U);
    EXPECT_EQ(expired[0U].argument, static_cast<std::int64_t>(ExpiryCause::kOutOfOrder));
}

class CheckpointTimesTest : public CheckpointsTest, public ::testing::WithParamInterface<Duration> {};

TEST_P(CheckpointTimesTest, ATimeBetweenCheckpointsOutsideItsLimitsIsTheDeadline) {
    verifies("SWR-CYC-014", Technique::kBoundaryValues, Polarity::kViolation);
    report(Point::kRead);
    if (GetParam() < kFrame) {
        report(Point::kWrite, GetParam());
    }

    EXPECT_EQ(step(false), SafeState::kProtectiveStopSs2);
    expect_expired(kControl, ExpiryCause::kDeadline);
}
INSTANTIATE_TEST_SUITE_P(TooShortTooLongAndNever, CheckpointTimesTest,
                         ::testing::Values(50_us - 1_ns, 300_us + 1_ns, kFrame),
                         [](const auto& one) { return std::to_string(one.param.ns); });

TEST_F(CheckpointsTest, AWrongNumberOfACheckpointStopsTheServiceOfTheWatchdog) {
    verifies("SWR-CYC-014", Technique::kFaultInjection, Polarity::kViolation);
    const int services = watchdog_.services;
    report(Point::kLog);

    EXPECT_EQ(step(), SafeState::kOperational) << "no fault is declared";
    expect_expired(kLog, ExpiryCause::kOutOfOrder);
    step();
    EXPECT_EQ(watchdog_.services, services);
}

TEST_F(CheckpointsTest, AResetClearsAComponentThatIsInOrderAgain) {
    verifies("SWR-CYC-014", Technique::kStateTransition);
    report(Point::kWrite);
    step(false);
    for (int i = 0; i < 4; ++i) {
        step();
    }
    ASSERT_EQ(sut_.get_state(), SafeState::kStandstillHold);
    sut_.inputs.reset_button = true;

    EXPECT_EQ(step(), SafeState::kStandby);
    EXPECT_EQ(state_.get_faults().get_latched_count(), 0U);
}

TEST_F(CheckpointsTest, AResetDoesNotClearAComponentThatIsStillOutOfOrder) {
    verifies("SWR-CYC-014", Technique::kFaultInjection, Polarity::kViolation);
    for (int i = 0; i < 20; ++i) {
        sut_.inputs.reset_button = i % 2 == 1;
        report(Point::kWrite);
        step(false);
        ASSERT_EQ(state_.get_faults().get_latched_count(), 1U) << i;
    }
}

TEST_F(CheckpointsTest, BeyondItsToleratedCyclesOnlyARestartClearsAnEntity) {
    verifies("SWR-CYC-014", Technique::kStateTransition, Polarity::kViolation);
    for (std::uint32_t i = 0U; i <= kTolerated; ++i) {
        report(Point::kWrite);
        step(false);
    }
    ASSERT_EQ(g_points.supervisor.get_status(), SupervisionStatus::kStopped);
    for (int i = 0; i < 10; ++i) {
        step();
    }
    sut_.inputs.reset_button = true;
    step();
    EXPECT_EQ(state_.get_faults().get_latched_count(), 1U);
}

TEST_F(CheckpointsTest, ASupervisorOfAnotherTableIsRejectedAtStart) {
    verifies("SWR-CYC-014", Technique::kErrorGuessing, Polarity::kViolation);
    SafetyStorage<kMismatched> storage;
    SafetyState state{storage, watchdog_};
    FakeMachine machine{state, nullptr};

    EXPECT_EQ(machine.initialize(), Status::kBadParameter);
}

}  // namespace
}  // namespace mamori::safety::testing_of_cycle
