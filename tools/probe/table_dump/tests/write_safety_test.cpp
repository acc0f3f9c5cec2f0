// SPDX-License-Identifier: Apache-2.0
// Goal: the JSON of a table contains the rows of its safety layer, and the names of its faults are those of
// their enumeration. Method: a JSON library reads the text, and the test compares each value.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mamori/safety/cycle/safety_rules.hpp"
#include "mamori/safety/e2e/stamped.hpp"
#include "mamori/table_dump/fault_names.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::table_dump {
namespace {

using nlohmann::json;
using namespace verification;
using namespace literals;

enum class Alarm : std::uint16_t { kFast, kSilent, kTest, k2Late };

class Sensor final : public Component {
  public:
    constexpr explicit Sensor(const char* name) noexcept : Component(name) {}
    OutPort<double> seen{*this, "seen"};
    using Ports = mamori::Ports<&Sensor::seen>;
};
class Decider final : public Component, public safety::CycleComponent {
  public:
    constexpr explicit Decider(const char* name) noexcept : Component(name) {}
    InPort<double> seen{*this, "seen"};
    using Ports = mamori::Ports<&Decider::seen>;
};
class Receiver final : public Component, public safety::ProtectedReceiver {
  public:
    using Value = safety::Stamped<double>;
    static constexpr std::uint8_t kProfile = 44U;
    static constexpr std::uint32_t kMaxDelta = 3U;
    constexpr explicit Receiver(const char* name) noexcept : Component(name) {}
};
class NoTest final : public safety::SelfTest {
  public:
    void begin() noexcept override {}
    safety::SelfTestStatus step() noexcept override { return safety::SelfTestStatus::kPassed; }
    std::size_t get_step_count() const noexcept override { return 1U; }
};

class NoCheck final : public safety::AssumptionCheck {
  public:
    safety::SelfTestStatus check() noexcept override { return safety::SelfTestStatus::kPassed; }
};
enum class Assumption : safety::AssumptionIndex { kClock };

enum class Entity { kSensor };
enum class Point { kRead, kWritten };
constexpr std::array kEntities{safety::supervise(Entity::kSensor)};
constexpr std::array kPoints{
    safety::checkpoint(Point::kRead, Entity::kSensor, safety::CheckpointRole::kInitial),
    safety::checkpoint(Point::kWritten, Entity::kSensor, safety::CheckpointRole::kFinal)};
constexpr std::array kAlives{safety::alive(Point::kWritten, {1U, 0U, 0U, 1U})};
constexpr std::array kEdges{safety::edge(Point::kRead, Point::kWritten)};
constexpr safety::SupervisionTable kCheckpoints{kEntities, kPoints, kAlives, {}, kEdges, 1U, 0U};

Sensor g_sensor{"sensor"};
Decider g_decider{"decider"};
NoTest g_test;
NoCheck g_check;
Receiver g_receiver{"receiver"};
safety::ExpiryStorage g_expiry;
safety::ExpiryMemory g_memory{g_expiry};
safety::SupervisionStorage<kCheckpoints> g_storage;
safety::CheckpointSupervisor g_supervisor{g_storage, g_memory};

constexpr auto kFaults = parts(faults<Alarm::kFast, Alarm::kSilent, Alarm::kTest, Alarm::k2Late>());
constexpr auto kSystem = safety::system(
    frame(1_ms), kFaults, window("all", 0_us, 900_us, budget(900_us), run(g_sensor, g_decider, g_receiver)),
    connect(g_sensor.seen, g_decider.seen, any_age()),
    react(Alarm::kFast, safety::Reaction::kSto, within(2_ms)),
    react(Alarm::kSilent, safety::Reaction::kSs1, within(3_ms)),
    react(Alarm::kTest, safety::Reaction::kNone, within(2_ms)),
    react(Alarm::k2Late, safety::Reaction::kSto, within(2_ms)),
    safety::confirm(Alarm::kFast, {3U, 1U, 0_ms}, {5U, 7_ms}),
    safety::supervise(g_decider, safety::alive(2U, 4U), safety::deadline(100_us)),
    safety::supervise(g_sensor, safety::alive(), safety::deadline(50_us, 5_us),
                      safety::checkpoints<kCheckpoints>(g_supervisor, Entity::kSensor),
                      safety::raises(Alarm::kSilent)),
    safety::confirmed_by(g_sensor.seen, safety::StopConfirmation::kStandstill,
                         safety::StopConfirmation::kTorqueOff),
    safety::confirmed_by(g_sensor.seen, safety::StopConfirmation::kClosedBrakes),
    safety::self_test(g_test, safety::found_within(10_s), safety::raises(Alarm::kTest)),
    safety::assume(Assumption::kClock, "clock", g_check, 100_ms),
    safety::protect(g_receiver, fresh_within(4_ms, 1_us), safety::raises(Alarm::kSilent)),
    safety::cycle(safety::StopBounds{20_ms, 30_ms}, safety::BrakeLimits{10_ms, true},
                  safety::WatchdogWindow{500_us, 4_ms}, safety::torque_feedback(5_ms),
                  safety::tolerated_lateness(50_us), safety::on_late_reaction(safety::raises(Alarm::k2Late)),
                  safety::on_failed_self_test(safety::raises(Alarm::kTest)),
                  safety::on_unconfirmed_brakes(safety::raises(Alarm::kSilent)),
                  safety::brakes_first<Alarm::kFast>()));
MAMORI_SAFETY_CHECK(kSystem);

json dump(const SystemView& view, const safety::SafetyView* rows) {
    std::ostringstream out;
    write_json(out, view, {list_fault_names(kSystem), {"unused"}, {}}, rows);
    return json::parse(out.str());
}

TEST(WriteSafetyTest, EachRowOfTheSafetyLayerIsWritten) {
    verifies("SWR-CYC-032");
    constexpr safety::SafetyView kRows = safety::make_safety_view(kSystem);

    const json table = dump(make_view(kSystem), &kRows);

    EXPECT_EQ(table["reactions"][1]["reaction"], "Ss1");
    EXPECT_EQ(table["safety"], json::parse(R"({
        "cycle": {"ss2_within_ns": 20000000, "ss1_within_ns": 30000000, "brakes_close_within_ns": 10000000,
                  "brakes_have_contacts": true, "watchdog_shortest_ns": 500000, "watchdog_longest_ns": 4000000,
                  "torque_feedback_ns": 5000000, "lateness_max_ns": 50000, "late_reaction_fault": 3,
                  "self_test_fault": 2, "unconfirmed_brakes_fault": 1, "brakes_first": [0]},
        "supervised": [
            {"component": 1, "late_cycles": 2, "expired_cycles": 4, "shortest_ns": 0, "longest_ns": 100000,
             "checkpoints": 0, "fault": null},
            {"component": 0, "late_cycles": 2, "expired_cycles": 3, "shortest_ns": 5000, "longest_ns": 50000,
             "checkpoints": 2, "fault": 1}],
        "confirmations": [{"fault": 0, "cycles": 3, "decay": 1, "time_ns": 0, "healing_cycles": 5,
                           "healing_ns": 7000000}],
        "stop_sources": [{"component": 0, "port": "seen", "confirms": ["standstill", "torque_off"]},
                         {"component": 0, "port": "seen", "confirms": ["closed_brakes"]}],
        "self_tests": [{"found_within_ns": 10000000000, "fault": 2}],
        "protections": [{"component": 2, "profile": 44, "fresh_within_ns": 4000000, "lead_ns": 1000,
                         "max_delta": 3, "fault": 1}],
        "assumptions": [{"name": "clock", "within_ns": 100000000}]})"));
}

TEST(WriteSafetyTest, ATableOfTheKernelAloneHasNone) {
    verifies("SWR-CYC-032");
    EXPECT_TRUE(dump(make_view(kSystem), nullptr)["safety"].is_null());
}

TEST(WriteSafetyTest, RowsThatNameNothingAreShownAsSuch) {
    verifies("SWR-CYC-032", Technique::kErrorGuessing, Polarity::kViolation);
    const std::array<safety::SuperviseRow, 1U> supervised{};
    const std::array<safety::StopSourceRow, 1U> sources{};
    const std::array<safety::ProtectRow, 1U> protections{};
    const safety::CycleRow cycle{};
    const safety::SafetyView rows{supervised, {}, sources, {}, protections, {}, cycle};

    const json table = dump(SystemView{}, &rows)["safety"];

    EXPECT_TRUE(table["supervised"][0]["component"].is_null());
    EXPECT_TRUE(table["supervised"][0]["fault"].is_null());
    EXPECT_TRUE(table["stop_sources"][0]["component"].is_null());
    EXPECT_EQ(table["stop_sources"][0]["port"], "?");
    EXPECT_TRUE(table["cycle"]["late_reaction_fault"].is_null());
    EXPECT_TRUE(table["protections"][0]["component"].is_null());
    EXPECT_TRUE(table["protections"][0]["max_delta"].is_null());
    EXPECT_EQ(table["self_tests"], json::array());
}

TEST(WriteSafetyTest, NamesOfFaultsAreThoseOfTheEnumeration) {
    verifies("SWR-CYC-032", Technique::kBoundaryValues);
    enum class Other : std::uint32_t { kSecond = 2U, kLast = 0xFFFFU, kBeyond = 0x10000U };

    const std::vector<std::string> few = list_fault_names(faults<Other::kSecond>());
    const std::vector<std::string> many = list_fault_names(faults<Other::kLast, Other::kBeyond>());

    EXPECT_EQ(list_fault_names(kFaults), (std::vector<std::string>{"Fast", "Silent", "Test", "k2Late"}));
    EXPECT_EQ(few, (std::vector<std::string>{"0", "1", "Second"}));
    EXPECT_TRUE(list_fault_names(faults<>()).empty());
    EXPECT_EQ(many.size(), 0x10000U);
    EXPECT_EQ(many.back(), "Last");
}

}  // namespace
}  // namespace mamori::table_dump
