// SPDX-License-Identifier: Apache-2.0
// Compiled by safety_system_compile_test.cpp with one defect at a time; without a defect it compiles.
#include <array>

#include "mamori/safety/cycle/safety_rules.hpp"
#include "mamori/safety/e2e/stamped.hpp"

namespace {

using namespace mamori::literals;
using namespace mamori::safety;

class Reader final : public mamori::Component {
  public:
    constexpr explicit Reader(const char* name) noexcept : Component(name) {}
    mamori::OutPort<std::uint32_t> seen{*this, "seen"};
    using Ports = mamori::Ports<&Reader::seen>;
};
class Decider final : public mamori::Component, public CycleComponent {
  public:
    constexpr Decider() noexcept : Component("decider") {}
    mamori::InPort<std::uint32_t, mamori::Need::kOptional> seen{*this, "seen"};
    using Ports = mamori::Ports<&Decider::seen>;
};
Reader reader{"reader"};
Reader stranger{"stranger"};
Decider decider;
Decider second_decider;
class Check final : public SelfTest {
  public:
    void begin() noexcept override {}
    SelfTestStatus step() noexcept override { return SelfTestStatus::kPassed; }
    std::size_t get_step_count() const noexcept override { return 1U; }
};
Check check;
#ifdef MAMORI_DEFECT_TESTED_TWICE
Check& second_check = check;
#else
Check second_check;
#endif

class FirstCheck final : public AssumptionCheck {
  public:
    SelfTestStatus check() noexcept override { return SelfTestStatus::kPassed; }
};
FirstCheck first_check;
enum class Assumption { kFirst, kSecond };
class Receiver : public mamori::Component, public ProtectedReceiver {
  public:
#ifdef MAMORI_DEFECT_PROTECTED_UNSTAMPED
    using Value = double;
#else
    using Value = Stamped<double>;
#endif
    static constexpr std::uint8_t kProfile = 4U;
#ifdef MAMORI_DEFECT_PROTECTED_LOSSES
    static constexpr std::uint32_t kMaxDelta = 4U;
#else
    static constexpr std::uint32_t kMaxDelta = 3U;
#endif
    constexpr explicit Receiver(const char* name) noexcept : Component(name) {}
};
class OtherReceiver final : public Receiver {
  public:
    using Receiver::Receiver;
};
Receiver receiver{"receiver"};
OtherReceiver other_receiver{"other"};
Receiver strange_receiver{"strange"};
#if defined(MAMORI_DEFECT_PROTECTED_TWICE)
Receiver& protected_receiver = receiver;
#elif defined(MAMORI_DEFECT_PROTECTED_STRANGER)
Receiver& protected_receiver = strange_receiver;
#else
OtherReceiver& protected_receiver = other_receiver;
#endif
#if defined(MAMORI_DEFECT_PROTECTED_TOO_YOUNG)
constexpr auto kFresh = mamori::fresh_within(1_ms - 1_ns);
#elif defined(MAMORI_DEFECT_PROTECTED_LEAD)
constexpr auto kFresh = mamori::fresh_within(1_ms, mamori::Duration{-1});
#else
constexpr auto kFresh = mamori::fresh_within(3_ms);
#endif

enum class Entity { kReader, kOther, kUnknown };
enum class Point { kBegin, kEnd, kOther };
constexpr std::array kEntities{supervise(Entity::kReader), supervise(Entity::kOther)};
constexpr std::array kPoints{checkpoint(Point::kBegin, Entity::kReader, CheckpointRole::kInitial),
                             checkpoint(Point::kEnd, Entity::kReader, CheckpointRole::kFinal),
                             checkpoint(Point::kOther, Entity::kOther, CheckpointRole::kInitialAndFinal)};
constexpr std::array kEdges{edge(Point::kBegin, Point::kEnd)};
constexpr std::array kNoEdges{edge(Point::kEnd, Point::kBegin)};
constexpr SupervisionTable kTable{kEntities, kPoints, {}, {}, kEdges};
constexpr SupervisionTable kUnsound{kEntities, kPoints, {}, {}, kNoEdges};
SupervisionStorage<kTable> storage;
ExpiryStorage expiry;
ExpiryMemory memory{expiry};
CheckpointSupervisor supervisor{storage, memory};
CheckpointSupervisor second_supervisor{storage, memory};
#if defined(MAMORI_DEFECT_CHECKPOINT_LIST)
constexpr auto kReaderPoints = checkpoints<kUnsound>(supervisor, Entity::kReader);
#elif defined(MAMORI_DEFECT_CHECKPOINT_ENTITY)
constexpr auto kReaderPoints = checkpoints<kTable>(supervisor, Entity::kUnknown);
#elif defined(MAMORI_DEFECT_CHECKPOINT_TWICE)
constexpr auto kReaderPoints = checkpoints<kTable>(supervisor, Entity::kOther);
#elif defined(MAMORI_DEFECT_CHECKPOINT_SUPERVISOR)
constexpr auto kReaderPoints = checkpoints<kTable>(second_supervisor, Entity::kReader);
#elif defined(MAMORI_DEFECT_CHECKPOINT_FORGOTTEN)
constexpr Checkpoints kReaderPoints{};
#else
constexpr auto kReaderPoints = checkpoints<kTable>(supervisor, Entity::kReader);
#endif

enum class Fault { kFast, kSilent, kLate, kSelfTest, kUndeclared };
enum class Stop { kGently = 1, kAtOnce = 5 };
enum class OtherFault { kFast };

#if defined(MAMORI_DEFECT_OTHER_REACTION)
constexpr auto kAnswer = Stop::kGently;
#elif defined(MAMORI_DEFECT_REACTION)
constexpr auto kAnswer = Stop::kAtOnce;
#else
constexpr auto kAnswer = Reaction::kSs1;
#endif
#ifdef MAMORI_DEFECT_NUMBERS
constexpr auto kFaults = mamori::faults<Fault::kSilent, Fault::kFast, Fault::kLate, Fault::kSelfTest>();
#else
constexpr auto kFaults = mamori::faults<Fault::kFast, Fault::kSilent, Fault::kLate, Fault::kSelfTest>();
#endif

constexpr StopBounds kStops{
#ifdef MAMORI_DEFECT_SS2
    0_ms,
#else
    1_ns,
#endif
#ifdef MAMORI_DEFECT_SS1
    0_ms
#else
    100_ms
#endif
};
constexpr BrakeLimits kBrakes{
#if defined(MAMORI_DEFECT_BRAKES_SLOW)
    100_ms,
#elif defined(MAMORI_DEFECT_BRAKES_WITHOUT_TIME)
    0_ms,
#else
    100_ms - 1_ns,
#endif
#if defined(MAMORI_DEFECT_BRAKES_FIRST_WITHOUT_CONTACTS)
    false};
#else
    true};
#endif
constexpr WatchdogWindow kWindow{
#if defined(MAMORI_DEFECT_WATCHDOG_NEGATIVE)
    mamori::Duration{-1},
#elif defined(MAMORI_DEFECT_WATCHDOG_EMPTY)
    4_ms,
#elif defined(MAMORI_DEFECT_WATCHDOG_LATE)
        1_ms + 1_ns,
#else
        0_ms,
#endif
    4_ms};
#ifdef MAMORI_DEFECT_FEEDBACK
constexpr auto kFeedback = torque_feedback(0_ms);
#else
constexpr auto kFeedback = torque_feedback(1_ns);
#endif
#ifdef MAMORI_DEFECT_LATENESS
constexpr auto kLateness = tolerated_lateness(mamori::Duration{-1});
#else
constexpr auto kLateness = tolerated_lateness(0_ms);
#endif
#if defined(MAMORI_DEFECT_LATE_OTHER_FAULT)
constexpr auto kOnLate = on_late_reaction(raises(OtherFault::kFast));
#elif defined(MAMORI_DEFECT_LATE_FAULT)
constexpr auto kOnLate = on_late_reaction(raises(Fault::kUndeclared));
#else
constexpr auto kOnLate = on_late_reaction(raises(Fault::kLate));
#endif
#if defined(MAMORI_DEFECT_SELF_TEST_OTHER_FAULT)
constexpr auto kOnFailed = on_failed_self_test(raises(OtherFault::kFast));
#elif defined(MAMORI_DEFECT_SELF_TEST_FAULT)
constexpr auto kOnFailed = on_failed_self_test(raises(Fault::kUndeclared));
#else
constexpr auto kOnFailed = on_failed_self_test(raises(Fault::kSelfTest));
#endif
#if defined(MAMORI_DEFECT_BRAKE_OTHER_FAULT)
constexpr auto kOnBrakes = on_unconfirmed_brakes(raises(OtherFault::kFast));
#elif defined(MAMORI_DEFECT_BRAKE_FAULT)
constexpr auto kOnBrakes = on_unconfirmed_brakes(raises(Fault::kUndeclared));
#else
constexpr auto kOnBrakes = on_unconfirmed_brakes(raises(Fault::kFast));
#endif
#if defined(MAMORI_DEFECT_NO_STOPS)
constexpr auto kCycle = cycle(kBrakes, kWindow, kFeedback, kLateness, kOnLate, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_BRAKES)
constexpr auto kCycle = cycle(kStops, kWindow, kFeedback, kLateness, kOnLate, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_WATCHDOG)
constexpr auto kCycle = cycle(kStops, kBrakes, kFeedback, kLateness, kOnLate, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_FEEDBACK)
constexpr auto kCycle = cycle(kStops, kBrakes, kWindow, kLateness, kOnLate, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_LATENESS)
constexpr auto kCycle = cycle(kStops, kBrakes, kWindow, kFeedback, kOnLate, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_LATE_FAULT)
constexpr auto kCycle = cycle(kStops, kBrakes, kWindow, kFeedback, kLateness, kOnFailed, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_SELF_TEST_FAULT)
constexpr auto kCycle = cycle(kStops, kBrakes, kWindow, kFeedback, kLateness, kOnLate, kOnBrakes);
#elif defined(MAMORI_DEFECT_NO_BRAKE_FAULT)
constexpr auto kCycle = cycle(kStops, kBrakes, kWindow, kFeedback, kLateness, kOnLate, kOnFailed);
#elif defined(MAMORI_DEFECT_BOUNDS_TWICE)
constexpr auto kCycle =
    cycle(kStops, kBrakes, kStops, kWindow, kFeedback, kLateness, kOnLate, kOnFailed, kOnBrakes);
#else
#if defined(MAMORI_DEFECT_BRAKES_FIRST_OTHER_FAULT)
constexpr auto kFirst = mamori::safety::brakes_first<OtherFault::kFast>();
#elif defined(MAMORI_DEFECT_BRAKES_FIRST_UNDECLARED)
constexpr auto kFirst = mamori::safety::brakes_first<Fault::kLate, Fault::kUndeclared>();
#else
constexpr auto kFirst = mamori::safety::brakes_first<Fault::kLate>();
#endif
constexpr auto kCycle =
    cycle(kStops, kBrakes, kWindow, kFeedback, kLateness, kOnLate, kOnFailed, kOnBrakes, kFirst);
#endif

constexpr auto kSystem = mamori::safety::system(
    mamori::frame(1_ms),
#if defined(MAMORI_DEFECT_OTHER_CORE)
    mamori::window("read", 0_us, 1_ms, mamori::core(1U), mamori::budget(1_ms), mamori::run(reader)),
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms), mamori::run(decider, receiver, other_receiver)),
    kFaults,
#elif defined(MAMORI_DEFECT_TWO_DECIDERS)
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms),
                   mamori::run(reader, decider, second_decider, receiver, other_receiver)),
    kFaults,
#elif defined(MAMORI_DEFECT_NO_MODE)
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms),
                   mamori::run(reader, decider, receiver, other_receiver)),
    mamori::safe_mode("halt", mamori::runs(decider)), kFaults,
#elif defined(MAMORI_DEFECT_SOURCE_LATER)
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms),
                   mamori::run(decider, reader, receiver, other_receiver)),
    kFaults,
#elif defined(MAMORI_DEFECT_PROTECTED_OTHER_CORE)
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms), mamori::run(reader, decider, receiver)),
    mamori::window("receive", 0_us, 1_ms, mamori::core(1U), mamori::budget(1_ms),
                   mamori::run(other_receiver)),
    kFaults,
#else
    mamori::window("all", 0_us, 1_ms, mamori::budget(1_ms),
                   mamori::run(reader, decider, receiver, other_receiver)),
    kFaults,
#endif
#if defined(MAMORI_DEFECT_SOURCE_LATER)
    mamori::connect(reader.seen, decider.seen, mamori::any_age(), mamori::delayed_by_a_frame()),
#elif !defined(MAMORI_DEFECT_SOURCE_UNCONNECTED) && !defined(MAMORI_DEFECT_OTHER_CORE)
    mamori::connect(reader.seen, decider.seen, mamori::any_age()),
#endif
#ifndef MAMORI_DEFECT_UNANSWERED
    mamori::react(Fault::kFast, kAnswer, mamori::within(1_ms)),
#endif
    mamori::react(Fault::kSilent, kAnswer, mamori::within(1_ms)),
#if defined(MAMORI_DEFECT_BRAKES_FIRST_BY_SS1) || defined(MAMORI_DEFECT_OTHER_REACTION)
    mamori::react(Fault::kLate, kAnswer, mamori::within(1_ms)),
#else
    mamori::react(Fault::kLate, Reaction::kSto, mamori::within(1_ms)),
#endif
    mamori::react(Fault::kSelfTest, kAnswer, mamori::within(1_ms)),
#ifdef MAMORI_DEFECT_STRANGER
    supervise(stranger, alive(), deadline(1_ms)),
#endif
#ifdef MAMORI_DEFECT_TWICE
    supervise(reader, alive(), deadline(1_ms)),
#endif
#if defined(MAMORI_DEFECT_ALIVE)
    supervise(reader, alive(3U, 2U), deadline(1_ms), raises(Fault::kSilent)),
#elif defined(MAMORI_DEFECT_DEADLINE)
    supervise(reader, alive(), deadline(0_ms), raises(Fault::kSilent)),
#elif defined(MAMORI_DEFECT_RAISED)
    supervise(reader, alive(), deadline(1_ms), raises(Fault::kUndeclared)),
#elif !defined(MAMORI_DEFECT_SOURCE_UNSUPERVISED)
    supervise(reader, alive(), deadline(1_ms), kReaderPoints, raises(Fault::kSilent)),
#endif
#ifdef MAMORI_DEFECT_NOTHING_PROVEN
    supervise(decider, alive(), deadline(1_ms), raises(Fault::kSilent)),
#elif defined(MAMORI_DEFECT_SOURCE_UNSUPERVISED)
    supervise(decider, alive(), deadline(1_ms)),
#else
    supervise(decider, alive(), deadline(1_ms), checkpoints<kTable>(supervisor, Entity::kOther)),
#endif
#if defined(MAMORI_DEFECT_NO_STANDSTILL)
    confirmed_by(reader.seen, StopConfirmation::kClosedBrakes, StopConfirmation::kTorqueOff),
#elif defined(MAMORI_DEFECT_NO_CLOSED_BRAKES)
    confirmed_by(reader.seen, StopConfirmation::kStandstill, StopConfirmation::kTorqueOff),
#elif defined(MAMORI_DEFECT_NO_TORQUE_OFF)
    confirmed_by(reader.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes),
#elif defined(MAMORI_DEFECT_SOURCE_STRANGER)
    confirmed_by(stranger.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
#else
    confirmed_by(reader.seen, StopConfirmation::kStandstill, StopConfirmation::kClosedBrakes,
                 StopConfirmation::kTorqueOff),
#endif
#ifdef MAMORI_DEFECT_SOURCE_TWICE
    confirmed_by(reader.seen, StopConfirmation::kTorqueOff),
#endif
#ifdef MAMORI_DEFECT_SOURCE_OF_NOTHING
    confirmed_by(reader.seen),
#endif
#ifdef MAMORI_DEFECT_CONFIRM_UNDECLARED
    confirm(Fault::kUndeclared, {2U}),
#endif
#ifdef MAMORI_DEFECT_CONFIRM_OTHER_FAULT
    confirm(OtherFault::kFast, {2U}),
#endif
#ifdef MAMORI_DEFECT_RAISE_OTHER_FAULT
    supervise(stranger, alive(), deadline(1_ms), raises(OtherFault::kFast)),
#endif
#ifdef MAMORI_DEFECT_CONFIRM_TWICE
    confirm(Fault::kFast, {2U}),
#endif
#if defined(MAMORI_DEFECT_CONFIRM_NEVER)
    confirm(Fault::kFast, {0U}),
#elif defined(MAMORI_DEFECT_HEALING)
    confirm(Fault::kFast, {2U}, {0U}),
#else
    confirm(Fault::kFast, {2U}, {3U}),
#endif
    self_test(check, found_within(2_ms), raises(Fault::kSelfTest)),
    protect(receiver, mamori::fresh_within(4_ms), raises(Fault::kSilent)),
#ifdef MAMORI_DEFECT_ASSUMPTION_ORDER
    assume(Assumption::kSecond, "second", first_check, 1_ns),
#else
    assume(Assumption::kFirst, "first", first_check, 1_ns),
#endif
#if defined(MAMORI_DEFECT_ASSUMPTION_TWICE)
    assume(Assumption::kFirst, "first again", first_check, 1_ns),
#elif defined(MAMORI_DEFECT_ASSUMPTION_TIME)
    assume(Assumption::kSecond, "second", first_check, 0_ms),
#else
    assume(Assumption::kSecond, "second", first_check, 1_ns),
#endif
#if defined(MAMORI_DEFECT_PROTECTED_OTHER_FAULT)
    protect(protected_receiver, kFresh, raises(OtherFault::kFast)),
#elif defined(MAMORI_DEFECT_PROTECTED_FAULT)
    protect(protected_receiver, kFresh, raises(Fault::kUndeclared)),
#elif defined(MAMORI_DEFECT_PROTECTED_UNANSWERED)
    protect(protected_receiver, kFresh),
#else
    protect(protected_receiver, kFresh, raises(Fault::kFast)),
#endif
#if defined(MAMORI_DEFECT_TESTED_OTHER_FAULT)
    self_test(second_check, found_within(2_ms), raises(OtherFault::kFast)),
#elif defined(MAMORI_DEFECT_TESTED_FAULT)
    self_test(second_check, found_within(2_ms), raises(Fault::kUndeclared)),
#elif defined(MAMORI_DEFECT_TESTED_TOO_OFTEN)
    self_test(second_check, found_within(2_ms - 1_ns), raises(Fault::kFast)),
#elif defined(MAMORI_DEFECT_TESTED_WITHOUT_TIME)
    self_test(second_check, raises(Fault::kFast)),
#else
    self_test(second_check, found_within(2_ms), raises(Fault::kFast)),
#endif
#ifdef MAMORI_DEFECT_CYCLE_TWICE
    kCycle,
#endif
#ifdef MAMORI_DEFECT_NO_CYCLE
    mamori::trace_hash()
#else
    kCycle
#endif
);
MAMORI_SAFETY_CHECK(kSystem);

}  // namespace
