// SPDX-License-Identifier: Apache-2.0
// Goal: a protected message passes through a system table like any other message, and events on its path
// determine what the receiver gets.
// Method: two components and one connection in virtual time; faults in the memory of the connection between
// two windows, a sender that stops or overruns, and a transport in between that delays or loses messages.
#include "protected_speed.hpp"

#include <array>
#include <functional>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/ports/virtual_time/simulated_channel.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::protected_speed {
namespace {

using ports::virtual_time::FrameRunner;
using ports::virtual_time::SimulatedChannel;
using ports::virtual_time::SimulatedCore;
using ports::virtual_time::VirtualHost;
using safety::ChannelState;
using safety::E2eOutcome;
using safety::E2eWorth;
using safety::FrameCause;
using namespace verification;

/// A system that runs one major frame after another.
template <typename Table>
class Machine {
  public:
    explicit Machine(const Table& table) : table_(table), executive_(table_) {
        EXPECT_EQ(executive_.initialize(), Status::kOk);
        EXPECT_EQ(executive_.start(), Status::kOk);
    }
    void run(int frames) {
        for (int i = 0; i < frames; ++i) {
            runner_.run_frame();
        }
    }
    VirtualHost& get_host() { return host_; }

  private:
    const Table table_;
    ExecutiveFor<Table> executive_;
    ports::virtual_time::VirtualHostFor<Table> host_{table_};
    SimulatedCore core_{executive_, host_};
    NoDevices devices_;
    FrameRunner runner_{{&core_, 1U}, devices_};
};

auto make_speed_table(Planner& planner, Drive& drive) {
    return system(frame(10_ms), window("drive", 0_ms, 2_ms, budget(1_ms), mamori::run(drive)),
                  window("plan", 5_ms, 2_ms, budget(1_ms), mamori::run(planner)),
                  connect(planner.out, drive.in, any_age()));
}

/// The system of the page, with separate components for each test.
class ProtectedSpeedTest : public ::testing::Test {
  protected:
    void SetUp() override {
        machine_.run(10);
        ASSERT_EQ(drive_.worth, E2eWorth::kNew);
    }
    /// Runs one major frame; before it, a bit of the waiting message flips.
    void run_with_a_turned_bit(std::size_t bit) {
        auto& waiting = const_cast<SafeSpeed::Frame&>(planner_.out.get_published());
        waiting[bit / 8U] = static_cast<std::uint8_t>(waiting[bit / 8U] ^ (1U << (bit % 8U)));
        machine_.run(1);
    }
    const auto& get_protection() const { return drive_.get_protection(); }

    Planner planner_;
    Drive drive_;
    Machine<decltype(make_speed_table(planner_, drive_))> machine_{make_speed_table(planner_, drive_)};
};

TEST(ProtectedSpeedPageTest, TheSystemOfThePageDrives) {
    verifies("SWR-E2E-040");
    Machine<std::remove_const_t<decltype(kSystem)>> machine{kSystem};

    machine.run(5);
    EXPECT_EQ(drive.worth, E2eWorth::kNew);
    EXPECT_EQ(drive.setpoint_rad_s, 2.0);  // sent in the previous frame
    planner.is_silent = true;
    machine.run(2);
    EXPECT_EQ(drive.worth, E2eWorth::kHeld);
    machine.run(2);
    EXPECT_EQ(drive.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(drive.setpoint_rad_s, 0.0);
}

TEST_F(ProtectedSpeedTest, EachValueArrivesOnceAFrameLater) {
    verifies("SWR-E2E-031");
    for (int i = 0; i < 70000; ++i) {  // beyond the wrap of the counter
        const double sent = planner_.wanted_rad_s;
        machine_.run(1);
        ASSERT_EQ(drive_.worth, E2eWorth::kNew) << i;
        ASSERT_EQ(drive_.setpoint_rad_s, sent);
    }
    EXPECT_EQ(get_protection().get_count(E2eOutcome::kRefused), 2U);  // before the order was found
}

TEST_F(ProtectedSpeedTest, DamageInTheConnectionIsHeldOutAndThenForgotten) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    const double good = drive_.setpoint_rad_s;

    run_with_a_turned_bit(21U * 8U);
    EXPECT_EQ(drive_.worth, E2eWorth::kHeld);
    EXPECT_EQ(drive_.setpoint_rad_s, good);
    EXPECT_EQ(get_protection().get_checker().get_cause(), FrameCause::kChecksum);
    machine_.run(1);
    EXPECT_EQ(drive_.worth, E2eWorth::kNew);
}

TEST_F(ProtectedSpeedTest, ConnectionThatStaysDamagedEndsInTheSubstituteUntilItIsProvenAnew) {
    verifies("SWR-E2E-032", Technique::kFaultInjection, Polarity::kViolation);
    for (std::size_t bit : {0U, 100U, 200U}) {
        run_with_a_turned_bit(bit);
    }
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(drive_.setpoint_rad_s, 0.0);
    EXPECT_EQ(get_protection().get_state(), ChannelState::kInvalid);

    machine_.run(50);  // three messages are lost, and only a reset restores the order
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(get_protection().get_checker().get_cause(), FrameCause::kOutOfOrder);
}

TEST_F(ProtectedSpeedTest, SilentSenderIsSeenByTheReceiverAlone) {
    verifies("SWR-E2E-033", Technique::kFaultInjection, Polarity::kViolation);
    machine_.run(1);
    planner_.is_silent = true;
    machine_.run(1);  // the last message sent before
    ASSERT_EQ(drive_.worth, E2eWorth::kNew);

    machine_.run(2);  // 15 and 25 ms old
    EXPECT_EQ(drive_.worth, E2eWorth::kHeld);
    machine_.run(1);
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(get_protection().get_count(E2eOutcome::kSilent), 4U);  // one before the first frame
    EXPECT_EQ(get_protection().get_state(), ChannelState::kValid);
    machine_.run(5);
    EXPECT_EQ(get_protection().get_state(), ChannelState::kValid);  // two good messages among the last ten
    machine_.run(1);
    EXPECT_EQ(get_protection().get_state(), ChannelState::kInvalid);
}

TEST_F(ProtectedSpeedTest, FrameThatWasDiscardedWithItsWindowIsOneLoss) {
    verifies("SWR-E2E-038", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(machine_.get_host().set_duration(planner_, 2_ms), Status::kOk);  // over its budget
    machine_.run(1);
    ASSERT_EQ(machine_.get_host().set_duration(planner_, 0_ms), Status::kOk);
    machine_.run(1);
    EXPECT_EQ(drive_.worth, E2eWorth::kHeld);

    machine_.run(1);
    EXPECT_EQ(drive_.worth, E2eWorth::kNew);
    EXPECT_EQ(get_protection().get_checker().get_order().get_lost_count(), 1U);
}

using Way = SimulatedChannel<SafeSpeed::Frame, 8U>;

auto make_way_table(Planner& planner, Way& way, Drive& drive) {
    return system(frame(10_ms), window("drive", 0_ms, 2_ms, budget(1_ms), mamori::run(drive)),
                  window("plan", 5_ms, 2_ms, budget(1_ms), mamori::run(planner)),
                  window("way", 8_ms, 1_ms, budget(1_ms), mamori::run(way)),
                  connect(planner.out, way.in, any_age()), connect(way.out, drive.in, any_age()));
}

/// The same system with a transport between both components.
class ProtectedWayTest : public ::testing::Test {
  protected:
    void SetUp() override {
        machine_.run(10);
        ASSERT_EQ(drive_.worth, E2eWorth::kNew);
    }

    Planner planner_;
    Way way_{"way"};
    Drive drive_;
    Machine<decltype(make_way_table(planner_, way_, drive_))> machine_{
        make_way_table(planner_, way_, drive_)};
};

TEST_F(ProtectedWayTest, TransportThatIsLateWithinTheLimitIsForgiven) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues);
    way_.set_fault({false, 20_ms});  // each message is 25 ms old when it is read

    machine_.run(20);
    EXPECT_EQ(drive_.worth, E2eWorth::kNew);
}

TEST_F(ProtectedWayTest, TransportThatIsLateBeyondTheLimitIsSeenThoughItsFramesAreInOrder) {
    verifies("SWR-E2E-034", Technique::kFaultInjection, Polarity::kViolation);
    way_.set_fault({false, 30_ms});

    machine_.run(20);
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(drive_.setpoint_rad_s, 0.0);
    EXPECT_EQ(drive_.get_protection().get_outcome(), E2eOutcome::kLate);
    EXPECT_EQ(drive_.get_protection().get_checker().get_cause(), FrameCause::kGood);
}

TEST_F(ProtectedWayTest, LossesBeyondTheLimitEndInTheSubstitute) {
    verifies("SWR-E2E-031", Technique::kFaultInjection, Polarity::kViolation);
    way_.set_fault({true, 0_ms});
    machine_.run(2);
    way_.set_fault({false, 0_ms});

    machine_.run(20);
    EXPECT_EQ(drive_.worth, E2eWorth::kSubstitute);
    EXPECT_EQ(drive_.get_protection().get_checker().get_cause(), FrameCause::kOutOfOrder);
}

}  // namespace
}  // namespace mamori::protected_speed
