// SPDX-License-Identifier: Apache-2.0
// Goal: the cycle asks the machine in a fixed order, executes all rows of its table, and finds a reaction
// that does not reach the outputs. Method: a machine made here, frame after frame; outputs that follow the
// commands or ignore them.
#include "mamori/kernel/component/execution_context.hpp"
#include "safety_cycle_fixture.hpp"

namespace mamori::safety::testing_of_cycle {
namespace {

// ---- The table ----

TEST_F(SafetyCycleTest, TheTableHoldsEverythingThatIsStated) {
    verifies("SWR-CYC-001");
    EXPECT_EQ(kSystem.windows.size(), 2U);
    EXPECT_EQ(kSystem.faults.size(), kFaultCount);
    EXPECT_EQ(kSystem.reactions[1U].within, 3_ms);
    ASSERT_EQ(kSystem.confirmations.size(), 2U);
    EXPECT_EQ(kSystem.confirmations[0U].fault, static_cast<FaultIndex>(Fault::kSlip));
    EXPECT_EQ(kSystem.confirmations[0U].healing.cycles, 5U);
    ASSERT_EQ(kSystem.supervised.size(), 4U);
    EXPECT_EQ(kSystem.supervised[0U].watch.component, &g_guard);
    EXPECT_EQ(kSystem.supervised[0U].fault, kNoFault);
    EXPECT_EQ(kSystem.supervised[1U].watch.limits.deadline.longest, 100_us);
    EXPECT_EQ(kSystem.supervised[1U].fault, static_cast<FaultIndex>(Fault::kSilent));
    ASSERT_EQ(kSystem.stop_sources.size(), 1U);
    EXPECT_EQ(kSystem.stop_sources[0U].port, &g_sensor.seen);
    EXPECT_EQ(kSystem.cycle.brakes.closes_within, 10_ms);
    EXPECT_EQ(kSystem.cycle.late_fault, static_cast<FaultIndex>(Fault::kLate));
    EXPECT_EQ(kSystem.cycle.self_test_fault, static_cast<FaultIndex>(Fault::kSelfTest));
}

// ---- Order ----

TEST_F(SafetyCycleTest, TheMachineIsAskedInAFixedOrder) {
    verifies("SWR-CYC-003");
    const std::vector<std::string> faults{"fault 0", "fault 1", "fault 2", "fault 3",
                                          "fault 4", "fault 5", "fault 6", "fault 7"};
    const auto expect_calls = [&](std::vector<std::string> before) {
        before.insert(before.end(), faults.begin(), faults.end());
        before.emplace_back("command");
        EXPECT_EQ(sut_.calls, before);
    };

    step();
    expect_calls({"inputs", "first self test"});
    step();
    expect_calls({"inputs", "self test"});
    EXPECT_EQ(sut_.commanded, SafeState::kStandby);
    step();
    expect_calls({"inputs"});
}

TEST_F(SafetyCycleTest, AFaultIsAnsweredInTheSameCycle) {
    verifies("SWR-CYC-003", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    ASSERT_TRUE(sut_.outputs.torque_enable);
    set_present(Fault::kFast, true);

    step();
    EXPECT_EQ(sut_.commanded, SafeState::kSafe);
    EXPECT_EQ(sut_.outputs, StopOutputs{});
    EXPECT_EQ(sut_.get_first_fault(), static_cast<FaultIndex>(Fault::kFast));
    EXPECT_EQ(sut_.get_reaction(), Reaction::kSto);
}

TEST_F(SafetyCycleTest, ASecondInitialisationIsRejected) {
    verifies("SWR-CYC-003", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(sut_.on_initialize(), Status::kPreconditionNotMet) << "the components are supervised";
    set_present(Fault::kSlip, true);
    step();
    EXPECT_EQ(sut_.on_initialize(), Status::kPreconditionNotMet) << "a fault with a confirmation is present";
}

TEST_F(SafetyCycleTest, EventsAreWrittenOnceAndOnlyToALog) {
    verifies("SWR-CYC-003", Technique::kEquivalenceClasses);
    operate();
    g_check.answer = SelfTestStatus::kFailed;
    step();
    step();
    std::size_t failed = 0U;
    for (std::size_t i = 0U; i < log_.size(); ++i) {
        failed += log_.get(i).code == static_cast<std::uint16_t>(CycleEvent::kAssumptionFailed) ? 1U : 0U;
    }
    EXPECT_EQ(failed, 1U);

    g_check.answer = SelfTestStatus::kPassed;
    SafetyStorage<kSystem> storage;
    SafetyState state{storage, watchdog_};
    FakeMachine silent{state, nullptr};
    ASSERT_EQ(silent.initialize(), Status::kOk);
    EXPECT_EQ(silent.on_execute({0, now_}), Status::kOk);
    EXPECT_EQ(silent.on_execute({0, now_ + kFrame}), Status::kOk);
    EXPECT_EQ(silent.get_state(), SafeState::kStandby) << "the change of state is an event";
}

// ---- Rows of the table ----

TEST_F(SafetyCycleTest, ConfirmationAndHealingAreThoseOfTheTable) {
    verifies("SWR-CYC-004", Technique::kBoundaryValues);
    operate();
    set_present(Fault::kSlip, true);
    EXPECT_EQ(step(), SafeState::kOperational);
    EXPECT_EQ(step(), SafeState::kOperational);
    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1);

    set_present(Fault::kSlip, false);
    sut_.inputs.is_standing = true;
    for (int i = 0; i < 4; ++i) {
        step();
    }
    sut_.inputs.reset_button = true;
    step();
    EXPECT_FALSE(is_latched(Fault::kSlip)) << "healed in the fifth cycle";
}

TEST_F(SafetyCycleTest, AFaultThatHasNotHealedStaysLatched) {
    verifies("SWR-CYC-004", Technique::kBoundaryValues, Polarity::kViolation);
    operate();
    set_present(Fault::kSlip, true);
    step();
    step();
    step();
    set_present(Fault::kSlip, false);
    for (int i = 0; i < 3; ++i) {
        step();
    }
    sut_.inputs.reset_button = true;
    step();
    EXPECT_TRUE(is_latched(Fault::kSlip)) << "four cycles of five";
}

TEST_F(SafetyCycleTest, AnExpiredComponentRaisesItsFault) {
    verifies("SWR-CYC-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_controller_running_ = false;
    EXPECT_EQ(step(), SafeState::kOperational);
    EXPECT_EQ(step(), SafeState::kOperational);
    const int services = watchdog_.services;

    EXPECT_EQ(step(), SafeState::kProtectiveStopSs2);
    EXPECT_TRUE(is_latched(Fault::kSilent));
    EXPECT_EQ(watchdog_.services, services + 1) << "its failure is a fault, not a matter of the watchdog";
}

TEST_F(SafetyCycleTest, AResetDoesNotClearTheFaultOfAComponentThatIsStillSilent) {
    verifies("SWR-CYC-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_controller_running_ = false;
    sut_.inputs.is_standing = true;
    for (int i = 0; i < 40; ++i) {
        sut_.inputs.reset_button = i % 2 == 1;
        step();
        ASSERT_TRUE(i < 2 || is_latched(Fault::kSilent)) << i;
    }
}

TEST_F(SafetyCycleTest, AfterAHoldAComponentThatRunsAgainCanBeReset) {
    verifies("SWR-CYC-004", Technique::kStateTransition);
    operate();
    is_controller_running_ = false;
    sut_.inputs.is_standing = true;
    for (int i = 0; i < 5; ++i) {
        step();
    }
    ASSERT_EQ(sut_.get_state(), SafeState::kStandstillHold);
    is_controller_running_ = true;
    for (int i = 0; i < 5; ++i) {
        step();
    }
    sut_.inputs.reset_button = true;

    EXPECT_EQ(step(), SafeState::kStandby);
    EXPECT_FALSE(is_latched(Fault::kSilent));
    EXPECT_TRUE(sut_.outputs.torque_enable) << "until the brakes have closed";
    sut_.inputs.reset_button = false;
    is_obeying_ = false;
    sut_.inputs.has_torque = true;
    sut_.inputs.are_brakes_closed = false;
    for (int i = 0; i < 9; ++i) {
        ASSERT_EQ(step(), SafeState::kStandby) << "torque that is wanted contradicts nothing, " << i;
    }
}

TEST_F(SafetyCycleTest, TheModeSelectsTheReaction) {
    verifies("SWR-CYC-004", Technique::kStateTransition, Polarity::kViolation);
    operate();
    sut_.inputs.mode = kSystemModeMax;
    EXPECT_TRUE(sut_.has_reaction(static_cast<FaultIndex>(Fault::kWarm), kSystemModeMax));
    set_present(Fault::kWarm, true);

    EXPECT_EQ(step(), SafeState::kSafe) << "STO in an invalid mode, Degrade in mode 0";
}

TEST_F(SafetyCycleTest, AnExpiredComponentWithoutAFaultStopsTheService) {
    verifies("SWR-CYC-006", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_guard_running_ = false;
    step();
    const int services = watchdog_.services;

    step();
    step();
    EXPECT_EQ(watchdog_.services, services);
    EXPECT_EQ(state_.get_faults().get_latched_count(), 0U);
}

TEST_F(SafetyCycleTest, AHealthyCycleIsServedEachFrame) {
    verifies("SWR-CYC-006");
    for (int i = 1; i <= 20; ++i) {
        step();
        ASSERT_EQ(watchdog_.services, i);
    }
}

TEST_F(SafetyCycleTest, AServiceThatIsTooEarlyIsHeldBackAndNotRefused) {
    verifies("SWR-CYC-006", Technique::kBoundaryValues);
    step();
    step();
    now_ = now_ - kFrame + 100_us;
    const std::size_t events = log_.size();

    step();
    EXPECT_FALSE(sut_.is_watchdog_serviced());
    EXPECT_EQ(watchdog_.services, 2);
    EXPECT_EQ(log_.size(), events);
    EXPECT_EQ(state_.get_supervision().get_global_status(), GlobalStatus::kOk);
}

TEST_F(SafetyCycleTest, AStateThatChangesByItselfStopsTheService) {
    verifies("SWR-CYC-006", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    // The state and its complement, one after the other.
    const std::array<unsigned char, 2U> forms{
        static_cast<unsigned char>(SafeState::kOperational),
        static_cast<unsigned char>(~static_cast<unsigned>(SafeState::kOperational))};
    unsigned char* const place = find_once(forms);
    ASSERT_NE(place, nullptr);
    const int services = watchdog_.services;
    sut_.after_command = [place] { *place = 0U; };

    step();
    EXPECT_EQ(watchdog_.services, services);
    sut_.after_command = {};
    EXPECT_EQ(step(), SafeState::kLockedOut);
}

TEST_F(SafetyCycleTest, ASkippedStepStopsTheServiceForGood) {
    verifies("SWR-CYC-006", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    state_.get_flow().report(FlowPoint::kJudged, now_);
    const int services = watchdog_.services;

    for (int i = 0; i < 5; ++i) {
        step();
    }
    EXPECT_EQ(watchdog_.services, services);
}

TEST_F(SafetyCycleTest, AFailedSelfTestOrAssumptionIsItsFault) {
    verifies("SWR-CYC-004", Technique::kFaultInjection, Polarity::kViolation);
    sut_.self_test = SelfTestStatus::kFailed;
    step();
    EXPECT_EQ(step(), SafeState::kLockedOut);
    EXPECT_TRUE(is_latched(Fault::kSelfTest));
}

TEST_F(SafetyCycleTest, AnAssumptionOfTheTableIsCheckedInEachCycleAndHoldsTheMachineUntilItIsKnown) {
    verifies("SWR-CYC-036");
    g_check.answer = SelfTestStatus::kRunning;
    g_check.calls = 0;
    for (int i = 1; i <= 10; ++i) {
        EXPECT_EQ(step(), SafeState::kSelfTest);
        EXPECT_EQ(g_check.calls, i);
    }
    g_check.answer = SelfTestStatus::kPassed;
    EXPECT_EQ(step(), SafeState::kStandby);
}

TEST_F(SafetyCycleTest, AnAssumptionThatIsLostInOperationLocksOut) {
    verifies("SWR-CYC-004", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    g_check.answer = SelfTestStatus::kFailed;

    EXPECT_EQ(step(), SafeState::kLockedOut);
    EXPECT_TRUE(is_latched(Fault::kSelfTest));
}

// ---- Reaction time ----

TEST_F(SafetyCycleTest, TheTimeOfAReactionIsMeasuredAtTheOutputs) {
    verifies("SWR-CYC-005");
    operate();
    set_present(Fault::kFast, true);
    step();
    EXPECT_EQ(sut_.get_longest_reaction(), Duration{0});

    step();
    EXPECT_EQ(sut_.get_longest_reaction(), kFrame);
    EXPECT_FALSE(is_latched(Fault::kLate));
}

TEST_F(SafetyCycleTest, AReactionAtItsBoundIsInTime) {
    verifies("SWR-CYC-005", Technique::kBoundaryValues);
    operate();
    is_obeying_ = false;
    set_present(Fault::kFast, true);
    step();
    step();
    is_obeying_ = true;
    sut_.inputs.applied = {};
    sut_.inputs.has_torque = false;

    step();
    EXPECT_EQ(sut_.get_longest_reaction(), 2_ms);
    EXPECT_FALSE(is_latched(Fault::kLate));
}

TEST_F(SafetyCycleTest, AReactionThatTheOutputsDoNotShowInTimeIsAFault) {
    verifies("SWR-CYC-005", Technique::kFaultInjection, Polarity::kViolation);
    latch_slip_that_is_not_obeyed();
    ASSERT_EQ(sut_.get_state(), SafeState::kProtectiveStopSs1);
    // Latched at 0 ms; bound 3 ms; found after it, in the frame that then reports it.
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(step(), SafeState::kProtectiveStopSs1) << i;
    }
    EXPECT_FALSE(is_latched(Fault::kLate));

    EXPECT_EQ(step(), SafeState::kSafe);
    EXPECT_TRUE(is_latched(Fault::kLate));
    EXPECT_FALSE(sut_.outputs.torque_enable);
}

TEST_F(SafetyCycleTest, AWorseFaultGivesAnEarlierOneNoMoreTime) {
    verifies("SWR-CYC-005", Technique::kFaultInjection, Polarity::kViolation);
    latch_slip_that_is_not_obeyed();
    // Latched at 0 ms with a bound of 3 ms. The worse one comes at 3 ms; alone it would have until 5 ms.
    for (int i = 0; i < 2; ++i) {
        step();
    }
    set_present(Fault::kFast, true);
    step();
    ASSERT_TRUE(is_latched(Fault::kFast));
    EXPECT_FALSE(is_latched(Fault::kLate));

    step();
    step();
    EXPECT_TRUE(is_latched(Fault::kLate));
}

TEST_F(SafetyCycleTest, AReactionWithoutAStopShowsInNoOutput) {
    verifies("SWR-CYC-005", Technique::kEquivalenceClasses);
    operate();
    is_obeying_ = false;
    set_present(Fault::kWarm, true);
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(step(), SafeState::kDegraded);
    }
    EXPECT_FALSE(is_latched(Fault::kLate));
}

TEST_F(SafetyCycleTest, EachKindOfStopShowsInTheOutputs) {
    verifies("SWR-CYC-005", Technique::kEquivalenceClasses, Polarity::kViolation);
    // SS2 and SS1 are begun by a stop or no torque; STO by no torque only.
    struct Case {
        Fault fault;
        StopOutputs applied;
        bool has_begun;
    };
    const std::array<Case, 8U> cases{Case{Fault::kSilent, {true, true, true, true}, true},
                                     Case{Fault::kSilent, {true, true, true, false}, true},
                                     Case{Fault::kSilent, {true, true, false, false}, false},
                                     Case{Fault::kSlip, {true, true, true, false}, true},
                                     Case{Fault::kSlip, {true, true, false, true}, false},
                                     Case{Fault::kSlip, {false, false, false, false}, true},
                                     Case{Fault::kFast, {true, true, true, true}, false},
                                     Case{Fault::kFast, {false, true, false, false}, true}};
    for (const Case& one : cases) {
        SafetyStorage<kSystem> storage;
        SafetyState state{storage, watchdog_};
        FakeMachine machine{state, &log_};
        ASSERT_EQ(machine.initialize(), Status::kOk);
        machine.inputs.applied = one.applied;
        machine.present[static_cast<std::size_t>(one.fault)] = true;
        bool is_late = false;
        for (int i = 0; i < 12; ++i) {
            now_ = now_ + kFrame;
            static_cast<void>(machine.on_execute({0, now_}));
            is_late = is_late || state.get_faults().is_latched(static_cast<FaultIndex>(Fault::kLate));
        }
        EXPECT_EQ(is_late, !one.has_begun) << static_cast<int>(one.fault);
    }
}

// ---- Confirmation of torque off ----

TEST_F(SafetyCycleTest, TorqueThatLastsAfterStoLocksOutAndStopsTheService) {
    verifies("SWR-CYC-007", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    set_present(Fault::kFast, true);
    step();
    is_obeying_ = false;
    sut_.inputs.applied = {};
    sut_.inputs.has_torque = true;
    for (std::int64_t i = 1; i <= kTorqueFeedback.ns / kFrame.ns; ++i) {
        ASSERT_EQ(step(), SafeState::kSafe) << i;
    }
    const int services = watchdog_.services;

    EXPECT_EQ(step(), SafeState::kLockedOut);
    EXPECT_EQ(watchdog_.services, services);
}

TEST_F(SafetyCycleTest, TorqueThatEndsInTimeConfirmsTheStop) {
    verifies("SWR-CYC-007", Technique::kBoundaryValues);
    operate();
    set_present(Fault::kFast, true);
    step();
    is_obeying_ = false;
    sut_.inputs.applied = {};
    sut_.inputs.has_torque = true;
    for (std::int64_t i = 1; i <= kTorqueFeedback.ns / kFrame.ns; ++i) {
        step();
    }
    sut_.inputs.has_torque = false;

    for (int i = 0; i < 20; ++i) {
        ASSERT_EQ(step(), SafeState::kSafe);
    }
}

// ---- Sources of confirmations ----

TEST_F(SafetyCycleTest, AHealthySourceConfirmsAStop) {
    verifies("SWR-CYC-013", Technique::kBoundaryValues);
    operate();
    set_present(Fault::kSilent, true);
    step();
    ASSERT_EQ(sut_.get_state(), SafeState::kProtectiveStopSs2);
    sut_.inputs.is_standing = true;
    is_sensor_running_ = false;

    EXPECT_EQ(step(), SafeState::kStandstillHold) << "one cycle without a run is not late";
}

TEST_F(SafetyCycleTest, ALateSourceConfirmsNoStandstill) {
    verifies("SWR-CYC-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    is_sensor_running_ = false;
    step();
    set_present(Fault::kSilent, true);
    sut_.inputs.is_standing = true;

    EXPECT_EQ(step(), SafeState::kProtectiveStopSs2);
    for (int i = 0; i < 19; ++i) {
        EXPECT_EQ(step(), SafeState::kProtectiveStopSs2) << i;
    }
    EXPECT_EQ(step(), SafeState::kProtectiveStopSs1) << "at its bound of 20 ms";
}

TEST_F(SafetyCycleTest, AnExpiredSourceConfirmsNoBrakesAndNoEndOfTorque) {
    verifies("SWR-CYC-013", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    set_present(Fault::kFast, true);
    step();
    is_sensor_running_ = false;
    ASSERT_EQ(step(), SafeState::kSafe);

    // Late from the second frame on; the time of torque is that since the frame before.
    for (std::int64_t i = 1; i <= kTorqueFeedback.ns / kFrame.ns; ++i) {
        ASSERT_EQ(step(), SafeState::kSafe) << i;
    }
    EXPECT_EQ(step(), SafeState::kLockedOut) << "torque may be on";
    for (int i = 0; i < 10; ++i) {
        step();
    }
    EXPECT_TRUE(is_latched(Fault::kBrake));
}

constexpr auto kWithoutSource = safety::system(
    frame(kFrame), window("all", 0_us, kFrame, budget(kFrame), run(g_sensor, g_guard)),
    connect(g_sensor.seen, g_guard.seen, any_age()), faults<Fault::kFast>(),
    react(Fault::kFast, Reaction::kSto, within(2_ms)), supervise(g_guard, alive(), deadline(100_us)),
    supervise(g_sensor, alive(), deadline(100_us)),
    confirmed_by(g_sensor.seen, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
    cycle(StopBounds{20_ms, 20_ms}, BrakeLimits{10_ms, true}, WatchdogWindow{500_us, 4_ms},
          torque_feedback(kTorqueFeedback), tolerated_lateness(50_us), on_late_reaction(raises(Fault::kFast)),
          on_failed_self_test(raises(Fault::kFast)), on_unconfirmed_brakes(raises(Fault::kFast))));
MAMORI_SAFETY_CHECK(kWithoutSource);

TEST_F(SafetyCycleTest, AConfirmationThatNoStopNeedsHasNoSource) {
    verifies("SWR-CYC-013", Technique::kEquivalenceClasses);
    SafetyStorage<kWithoutSource> storage;
    SafetyState state{storage, watchdog_};
    FakeMachine machine{state, nullptr};
    ASSERT_EQ(machine.initialize(), Status::kOk);
    machine.inputs = {true, true, false, false, false, true, {}, 0U, false};
    for (int i = 0; i < 4; ++i) {
        state.get_observer().get_records()[0U].note_run(now_, now_ + 10_us);
        state.get_observer().get_records()[1U].note_run(now_, now_ + 10_us);
        machine.inputs.start_button = i == 3;
        EXPECT_EQ(machine.on_execute({0, now_}), Status::kOk);
        now_ = now_ + kFrame;
    }
    EXPECT_EQ(machine.get_state(), SafeState::kOperational) << "it stands, as the machine reports";
}

TEST_F(SafetyCycleTest, AFlippedBitOfTheTimeWithTorqueLocksOut) {
    verifies("SWR-CYC-007", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    // The time is zero: eight bytes of zeros, and their complement behind them.
    std::array<unsigned char, 16U> forms{};
    std::memset(forms.data() + 8U, 0xFF, 8U);
    unsigned char* const place = find_once(forms);
    ASSERT_NE(place, nullptr);
    *place = 1U;

    EXPECT_EQ(step(), SafeState::kLockedOut);
}

TEST_F(SafetyCycleTest, AClockThatRunsBackwardsLocksOut) {
    verifies("SWR-CYC-007", Technique::kErrorGuessing, Polarity::kViolation);
    operate();
    now_ = now_ - 10_ms;

    EXPECT_EQ(step(), SafeState::kLockedOut);
}

TEST_F(SafetyCycleTest, TheCauseOfAnExpiryIsWrittenWithItsComponentAndKept) {
    verifies("SWR-CYC-010", Technique::kFaultInjection, Polarity::kViolation);
    operate();
    const auto find_events = [this]() {
        std::vector<std::pair<std::uint16_t, std::int64_t>> found;
        for (std::size_t i = 0U; i < log_.size(); ++i) {
            if (log_.get(i).code == static_cast<std::uint16_t>(CycleEvent::kComponentExpired)) {
                found.emplace_back(log_.get(i).source, log_.get(i).argument);
            }
        }
        return found;
    };
    EXPECT_EQ(sut_.get_last_expiry().component, kNoIndex);

    is_controller_running_ = false;
    step();
    step();
    EXPECT_EQ(find_events().size(), 0U) << "late, not expired";
    for (int i = 0; i < 20; ++i) {
        step();
    }
    using Found = std::vector<std::pair<std::uint16_t, std::int64_t>>;
    EXPECT_EQ(find_events(), (Found{{2U, static_cast<std::int64_t>(ExpiryCause::kSilent)}})) << "once";
    EXPECT_EQ(sut_.get_last_expiry().component, 1U);
    EXPECT_EQ(sut_.get_last_expiry().cause, ExpiryCause::kSilent);

    state_.get_observer().get_records()[0U].note_run(now_, now_ + 101_us);
    is_guard_running_ = false;
    step();
    EXPECT_EQ(find_events().back(),
              (Found::value_type{1U, static_cast<std::int64_t>(ExpiryCause::kDeadline)}));
    EXPECT_EQ(sut_.get_last_expiry().component, 0U);
    state_.get_observer().on_budget_overrun(0U, 2U, now_);
    step();
    EXPECT_EQ(find_events().back(),
              (Found::value_type{3U, static_cast<std::int64_t>(ExpiryCause::kBudgetOverrun)}));
    EXPECT_EQ(find_events().size(), 3U);
}

TEST_F(SafetyCycleTest, ASystemThatRunsHasNoExpiry) {
    verifies("SWR-CYC-010");
    operate();
    for (int i = 0; i < 20; ++i) {
        step();
    }
    EXPECT_EQ(sut_.get_last_expiry().component, kNoIndex);
    EXPECT_EQ(sut_.get_last_expiry().cause, ExpiryCause::kNone);
}

class Failing final : public Component {
  public:
    constexpr Failing() noexcept : Component("failing") {}
    Status on_execute(ContextHandle) noexcept override { return Status::kError; }
};
Failing g_failing;
constexpr auto kFailing = mamori::system(frame(1_ms), window("w", 0_us, 1_ms, budget(1_ms), run(g_failing)));

TEST(ExpiryCauseTest, AComponentInErrorIsNamedAsSuch) {
    verifies("SWR-CYC-010", Technique::kFaultInjection, Polarity::kViolation);
    ExecutionStorageFor<kFailing> storage;
    ExecutionSupervisor sut{storage, 1_ms};
    ASSERT_EQ(sut.watch(g_failing, {alive(1U, 1U), deadline(1_ms), SupervisionScope::kGlobal}), Status::kOk);
    EXPECT_EQ(sut.get_state(0U), LifecycleState::kCreated);
    ASSERT_EQ(g_failing.initialize(), Status::kOk);
    ExecutionContext context;
    ContextPlan plan{};
    plan.period = 1_ms;
    ASSERT_EQ(context.attach(0, kFailing.components, plan), Status::kOk);
    ASSERT_EQ(context.start(Instant{}), Status::kOk);
    ASSERT_EQ(context.activate_component(g_failing, Instant{}), Status::kOk);
    ASSERT_EQ(context.begin_cycle(Instant{}), Status::kOk);
    context.execute(0U);
    context.end_cycle();
    ASSERT_EQ(sut.get_state(0U), LifecycleState::kError);

    EXPECT_EQ(sut.step(Instant{}), GlobalStatus::kExpired);

    EXPECT_EQ(sut.get_cause(g_failing), ExpiryCause::kInError);
    EXPECT_TRUE(sut.has_just_expired(0U));
    EXPECT_EQ(sut.step(Instant{1}), GlobalStatus::kExpired);
    EXPECT_FALSE(sut.has_just_expired(0U));
    ASSERT_EQ(context.stop(Instant{}), Status::kOk);
    ASSERT_EQ(context.detach(), Status::kOk);
}

}  // namespace
}  // namespace mamori::safety::testing_of_cycle
