// SPDX-License-Identifier: Apache-2.0
// Samples of the manual that belong to no program of their own: they are compiled, not run.
// verification/checks/manual_samples.py compares each with its page.
#include <array>
#include <csignal>
#include <cstdio>
#include <string>

#include <pthread.h>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/safety/e2e/e2e.hpp"
#include "mamori/table_dump/table_dump.hpp"
#include "mamori/timing/cost_run.hpp"

namespace rt = mamori::ports::posix_rt;
using mamori::Status;
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
static std::array<rt::WindowThread, 1U> threads;
static const rt::FrameClock clock = rt::FrameClock::starting_in(50_ms);
static rt::GuardedHost host{threads, clock, {70, rt::ThreadPlace::kAnyProcessor}};

// clang-format off: lines as in the manual

namespace real_time {

static rt::CoreRunner runner{executive, host, clock};  // static: the handler uses it

extern "C" void on_signal(int) { runner.request_stop(); }

static void run_until_signal() {
    struct sigaction action {};
    action.sa_handler = &on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    runner.run_until_stopped();  // in place of runner.run(20U)
}

#include "mamori/ports/posix_rt/grid_watch.hpp"

static void close_outputs(void*) noexcept { /* remove the enable signal of the drives; do not wait */ }

static std::array<rt::GridBeat, 1U> beats{rt::GridBeat{executive.get_view(), 0U}};  // one per core
// Permitted lateness, time between two polls, time over which the clocks are compared, deviation 0.5 %.
constexpr rt::GridLimits kLimits{300_us, 200_us, {100_ms, 5000}};
static rt::GridWatch watch{
    beats,   clock,
    rt::get_raw_clock(),
    kLimits, {&close_outputs, nullptr},
    {85, rt::ThreadPlace::kAnyProcessor}};  // above the runner

static Status run_with_watch() {
    runner.set_observer(&beats[0]);
    beats[0].expect(mamori::Instant{0});  // from now on the first window must start in time
    const Status status = watch.open();
    if (status == Status::kOk) {
        runner.run_until_stopped();
    }
    beats[0].rest();  // the end is intended
    watch.close();
    return status;
}

static void init_with_priority_inheritance(pthread_mutex_t& mutex) {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);  // std::mutex has no such choice
    pthread_mutex_init(&mutex, &attributes);
}

}  // namespace real_time

namespace last_resort {

static Status run_with_device(rt::CoreRunner& runner, rt::SoftwareWatchdog& watchdog) {
    rt::WatchdogDevice device;
    if (const Status opened = device.open("/dev/watchdog", 10000_ms); opened != Status::kOk) {
        std::fprintf(stderr, "/dev/watchdog: %s\n", rt::describe(device.get_error()));
        return opened;
    }
    const Status status = watchdog.open({90, rt::ThreadPlace::kAnyProcessor}, &device);
    if (status == Status::kOk) {
        runner.run(20U);
    }
    const bool is_stopped = watchdog.close() == Status::kOk && device.disarm() == Status::kOk;
    return is_stopped ? status : Status::kError;  // an armed device resets the computer after the end of the program
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

namespace cost {

static mamori::timing::TimingResult count(bool is_paced, const std::uint64_t (&numbers)[3], const char* folder,
                                          mamori::ports::virtual_time::FrameDevices& devices) {
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
