// SPDX-License-Identifier: Apache-2.0
// Samples of the manual that belong to no program of their own: they are compiled, not run.
// verification/checks/manual_samples.py compares each with its page.
#include <cstdio>
#include <string>

#include <pthread.h>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/safety/cycle/safety_state.hpp"
#include "mamori/safety/e2e/e2e.hpp"
#include "mamori/safety/notice/node_monitor.hpp"
#include "mamori/safety/notice/survival_notifier.hpp"
#include "mamori/safety/self_test/region_crc.hpp"
#include "mamori/table_dump/fault_names.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "mamori/timing/cost_run.hpp"

namespace rt = mamori::ports::posix_rt;
using namespace mamori::literals;  // NOLINT: units of the times below

namespace manual {

class Idle final : public mamori::Component {
  public:
    constexpr Idle() noexcept : Component("idle") {}
};

static Idle idle;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("idle", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(idle)));
MAMORI_CHECK(kSystem);
static mamori::ExecutiveFor executive{kSystem};
// clang-format off: lines as in the manual

namespace real_time {

#include "mamori/ports/posix_rt/machine.hpp"

static mamori::ports::posix_rt::Machine<kSystem> machine;

class Valve final : public mamori::Component {
  public:
    constexpr Valve() noexcept : Component("valve") {}
    mamori::Status on_startup(mamori::ContextHandle) noexcept override { return mamori::Status::kOk; /* opens a device */ }
};

static Valve valve;
static constexpr auto kValveSystem =
    mamori::system(mamori::frame(10_ms), mamori::action_budget(200_ms),
                   mamori::window("valve", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(valve)));
MAMORI_CHECK(kValveSystem);

}  // namespace real_time

namespace background {

class Wheel final : public mamori::Component {
  public:
    constexpr Wheel() noexcept : Component("wheel") {}
    mamori::InPort<double> setpoint{*this, "setpoint"};
    mamori::OutPort<double> speed{*this, "speed"};
    using Ports = mamori::Ports<&Wheel::setpoint, &Wheel::speed>;
};
class Mapper final : public mamori::Component {
  public:
    constexpr Mapper() noexcept : Component("mapper") {}
    mamori::InPort<double> speed{*this, "speed"};
    mamori::OutPort<double> setpoint{*this, "setpoint"};
    using Ports = mamori::Ports<&Mapper::speed, &Mapper::setpoint>;
};
static Wheel wheel;
static Mapper mapper;

static mamori::Crossing<double> to_map;
static mamori::Crossing<double> to_drive;
static constexpr auto kMapped = mamori::system(
    mamori::frame(50_ms), mamori::publication_margin(200_us),
    mamori::window("drive", 0_us, 300_us, mamori::every(1_ms), mamori::budget(250_us), mamori::run(wheel)),
    mamori::window("map", 600_us, 49_ms, mamori::background(), mamori::budget(30_ms), mamori::run(mapper)),
    mamori::connect(wheel.speed, mapper.speed, mamori::through(to_map), mamori::any_age()),
    mamori::connect(mapper.setpoint, wheel.setpoint, mamori::through(to_drive), mamori::any_age()));

MAMORI_CHECK(kMapped);
static mamori::ports::posix_rt::Machine<kMapped> machine;

}  // namespace background

namespace real_time {

class Drive final : public mamori::Devices {
    void sample(std::uint64_t, mamori::Instant) noexcept override { /* read the encoders */ }
    void apply(std::uint64_t, mamori::Instant, mamori::Duration) noexcept override { /* send the torques */ }
};

static mamori::Status run_drive() {
    Drive drive;
    return machine.run(drive);  // until SIGINT, SIGTERM or machine.request_stop()
}

static void close_outputs(void*) noexcept { /* remove the enable signal of the drives; do not wait */ }

static mamori::ports::posix_rt::MachineOptions make_options() {
    mamori::ports::posix_rt::MachineOptions options;
    options.outputs = {&close_outputs, nullptr};
    options.watch.lateness = 2_ms;      // a window that starts or ends later closes the outputs
    options.watch.period = 1_ms;        // time between two polls of the schedule watch
    options.watchdog_timeout = 100_ms;
    options.recorder = "run.rec";
    return options;
}

static mamori::ports::posix_rt::Machine<kSystem> guarded{make_options()};

static void init_with_priority_inheritance(pthread_mutex_t& mutex) {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);  // std::mutex has no such choice
    pthread_mutex_init(&mutex, &attributes);
}

}  // namespace real_time

namespace safety_module {

using namespace mamori::safety;  // NOLINT: the words of a row
enum class Fault : FaultIndex { kMemory };
static constexpr std::array<double, 7U> kSpeedLimits{};
static RegionCrc constants{kSpeedLimits, 8U};

static constexpr auto kRows = mamori::parts(
    self_test(constants, found_within(500_ms), raises(Fault::kMemory)),
    confirm(Fault::kMemory, {1U}));
static constexpr auto kModule = mamori::safety::system(
    mamori::frame(10_ms), mamori::window("idle", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(idle)), kRows);
extern SafetyState state;

#include "mamori/table_dump/fault_names.hpp"
#include "mamori/table_dump/table_dump.hpp"

static std::string save_table() {
    return mamori::table_dump::save_json("table.json", make_view(kModule),
                                         {mamori::table_dump::list_fault_names(kModule)}, &state.get_table());
}

}  // namespace safety_module

namespace last_resort {

static mamori::Status run_with_device() {
    static rt::WatchdogDevice device;
    if (const mamori::Status opened = device.open("/dev/watchdog", 10000_ms); opened != mamori::Status::kOk) {
        std::fprintf(stderr, "/dev/watchdog: %s\n", rt::describe(device.get_error()));
        return opened;
    }
    rt::MachineOptions options;
    options.device = &device;
    static rt::Machine<kSystem> supervised{options};
    const mamori::Status status = supervised.run();
    return device.disarm() == mamori::Status::kOk ? status : mamori::Status::kError;  // an armed device resets the computer
}

}  // namespace last_resort

namespace first_system {

#include "mamori/table_dump/table_dump.hpp"

static std::string save_table() { return mamori::table_dump::save_json("table.json", mamori::make_view(kSystem)); }

}  // namespace first_system

namespace e2e {

// Data id, shortest and longest message [bytes].
constexpr mamori::safety::SentIdChannel kChannel{0x0A0B0C0DU, 64U, 64U};
// Steps of the counter that are accepted, messages for a baseline.
constexpr mamori::safety::HardenedLimits kLimits{2U, 3U};
using Profile = mamori::safety::E2eProfile04<>;
static_assert(mamori::safety::is_sound<Profile, kChannel>());  // an unsuitable channel does not compile
static_assert(mamori::safety::are_sound<Profile, mamori::safety::HardenedSequence, kLimits>());

MAMORI_CONSTINIT mamori::safety::E2eProtector<Profile> sender{kChannel};
MAMORI_CONSTINIT mamori::safety::HardenedE2eChecker<Profile> receiver{kChannel, kLimits};

// Messages [1/s], bit error probability; one receiver, budget of SIL 3.
constexpr mamori::safety::ChannelUse kUse{1000.0, 1e-4};
static_assert(mamori::safety::is_within_budget<Profile, kChannel, kUse>());

}  // namespace e2e

namespace survival_notice {

using namespace mamori::literals;

// Shared by both programs: data id, major frame, a notice in each tenth frame, components in table order.
constexpr mamori::safety::NoticeNode kArm{0xA4A1U, 1_ms, 10U, std::array{"reader", "guard", "supervisor", "notifier"}};

// Node "arm": runs after the supervision, in its window or a later one; supervision has the storage of the table.
extern mamori::safety::ExecutionSupervisor supervision;
mamori::safety::SurvivalNotifier<kArm> notifier{"notifier", supervision};

// Other node: tolerance, late after two periods, silent after three, ten periods to the first notice.
constexpr mamori::safety::NoticeLimits kLimits{5_ms, 2U, 3U, 10U};
mamori::safety::NodeMonitor<kArm, kLimits> arm_monitor{"arm"};

mamori::Status step_supervision(mamori::safety::ExecutionSupervisor& all, mamori::ContextHandle context) noexcept {
    static_cast<void>(all.step(context.now));
    return mamori::Status::kOk;  // any other result: not called again until it is reset
}
mamori::SystemFunction<&step_supervision> supervisor{"supervisor", supervision};
constexpr auto kSupervise = mamori::system_window("supervise", 300_us, 50_us, mamori::budget(40_us), supervisor);

bool is_arm_safe() {
    return arm_monitor.get_status().is_proven;  // else status.first and status.component name the cause
}

}  // namespace survival_notice

namespace cost {

static mamori::timing::TimingResult count(bool is_paced, const std::uint64_t (&numbers)[3], const char* folder,
                                          mamori::Devices& devices) {
    mamori::ports::virtual_time::VirtualHostFor clock{kSystem};
    mamori::timing::CostOptions options;
    options.is_paced = is_paced;                   // --by clock
    options.cycles = numbers[0];                   // --cycles
    options.counted = {numbers[1], numbers[2]};    // --first, --every
    options.out = folder;                          // --out
    return mamori::timing::run_cost({{executive, clock}}, devices, options);
}

}  // namespace cost

}  // namespace manual
