// SPDX-License-Identifier: Apache-2.0
/// @file
/// The system of docs/manual/table_with_modes.md, whose code blocks are parts of this file.
#ifndef MAMORI_TABLE_DUMP_TESTS_ROBOT_WITH_MODES_HPP
#define MAMORI_TABLE_DUMP_TESTS_ROBOT_WITH_MODES_HPP

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/table_dump/table_dump.hpp"

namespace mamori::table_dump::robot {

class Encoder final : public mamori::Component {
  public:
    constexpr Encoder() noexcept : Component("encoder") {}
    mamori::OutPort<double> angle{*this, "angle"};
    using Ports = mamori::Ports<&Encoder::angle>;
};

class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double> angle{*this, "angle"};
    using Ports = mamori::Ports<&Monitor::angle>;
    mamori::Parameter<double> limit{*this, "limit_rad_s", 1.0, mamori::between(0.1, 3.0)};
    using Parameters = mamori::Parameters<&Monitor::limit>;
};

/// Writes a setpoint: as planner in one mode, as hand guidance of a teaching user in the other.
class Guide final : public mamori::Component {
  public:
    constexpr explicit Guide(const char* name) noexcept : Component(name) {}
    mamori::InPort<double> angle{*this, "angle"};
    mamori::OutPort<double> setpoint{*this, "setpoint"};
    using Ports = mamori::Ports<&Guide::angle, &Guide::setpoint>;
};

class Drive final : public mamori::Component {
  public:
    constexpr Drive() noexcept : Component("drive") {}
    mamori::InPort<double> setpoint{*this, "setpoint"};
    using Ports = mamori::Ports<&Drive::setpoint>;
    mamori::Parameter<std::int32_t> gain{*this, "gain", 10, mamori::between(1, 40)};
    using Parameters = mamori::Parameters<&Drive::gain>;
};

MAMORI_CONSTINIT static Encoder encoder;
MAMORI_CONSTINIT static Monitor monitor;
MAMORI_CONSTINIT static Guide planner{"planner"};
MAMORI_CONSTINIT static Guide hand{"hand"};
MAMORI_CONSTINIT static Drive drive;

enum class Command { kStart, kTeach, kStop };

static constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 300_us, mamori::budget(200_us), mamori::run(encoder, monitor)),
    mamori::window("guide", 300_us, 300_us, mamori::budget(200_us), mamori::run(planner, hand)),
    mamori::window("drive", 600_us, 300_us, mamori::budget(200_us), mamori::run(drive)),
    mamori::connect(encoder.angle, monitor.angle, mamori::any_age()),
    mamori::connect(encoder.angle, planner.angle, mamori::any_age()),
    mamori::connect(encoder.angle, hand.angle, mamori::any_age()),
    mamori::connect(planner.setpoint, drive.setpoint, mamori::only_in("work"), mamori::any_age()),
    mamori::connect(hand.setpoint, drive.setpoint, mamori::any_age()),
    mamori::configuration_set("fast", mamori::assign(monitor.limit, 2.0), mamori::assign(drive.gain, 25)),
    mamori::configuration_set("slow", mamori::assign(monitor.limit, 0.25), mamori::assign(drive.gain, 5)),
    mamori::system_mode("idle", mamori::runs(encoder, monitor)),
    mamori::system_mode("work", mamori::runs(encoder, monitor, planner, drive), mamori::parameters("fast")),
    mamori::system_mode("teach", mamori::runs(encoder, monitor, hand, drive), mamori::parameters("slow")),
    mamori::safe_mode("halt", mamori::runs(encoder, monitor)),
    mamori::mode_transition("idle", Command::kStart, "work"),
    mamori::mode_transition("idle", Command::kTeach, "teach"),
    mamori::mode_transition("work", Command::kStop, "idle"),
    mamori::mode_transition("teach", Command::kStop, "idle"));

MAMORI_CHECK(kSystem);
MAMORI_CONSTINIT static mamori::SystemModes modes{mamori::make_view(kSystem)};
MAMORI_CONSTINIT static mamori::ExecutiveFor executive{kSystem, modes};

/// @return kOk: "work" begins in seven major frames.
inline mamori::Status begin_work() {
    return modes.request(Command::kStart);
}
/// @return kOk: in effect from the next major frame.
inline mamori::Status limit_speed() {
    return modes.get_configuration().set_value(monitor.limit, 0.5);
}
/// @return kOk: "halt" begins, until reset() of the stopped system.
inline mamori::Status halt() {
    return modes.request_safe_mode();
}

inline std::string save_table(const std::string& path) {
    const mamori::table_dump::Names names{{}, {}, {"Start", "Teach", "Stop"}};
    return mamori::table_dump::save_json(path, mamori::make_view(kSystem), names);
}

}  // namespace mamori::table_dump::robot

#endif  // MAMORI_TABLE_DUMP_TESTS_ROBOT_WITH_MODES_HPP
