// SPDX-License-Identifier: Apache-2.0
// A system that is linked to measure its size: two components, plus one feature for each macro SIZE_...
// SIZE_EIGHT selects a chain of eight supervised components; the last one checks protected messages.
#include <array>

#include "board.hpp"
#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"

#if defined(SIZE_EIGHT)
#define SIZE_SUPERVISION
#define SIZE_E2E
#endif
#if defined(SIZE_FLIGHT_RECORDER)
#define SIZE_EVENT_LOG
#endif

// Headers of features that an image lacks would only increase compile time.
#if defined(SIZE_FSM)
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#endif
#if defined(SIZE_EVENT_LOG)
#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#endif
#if defined(SIZE_INTROSPECTION)
#include "mamori/kernel/run/introspection.hpp"
#endif
#if defined(SIZE_E2E)
#include "mamori/safety/e2e/e2e.hpp"
#endif
#if defined(SIZE_SUPERVISION)
#include "mamori/safety/supervision/execution_supervisor.hpp"
#endif

namespace proof {
namespace {

using namespace mamori::literals;  // NOLINT: units of the table
using mamori::Status;

#if defined(SIZE_EVENT_LOG)
MAMORI_CONSTINIT std::array<mamori::Event, 8U> event_storage;
MAMORI_CONSTINIT mamori::EventLog event_log{event_storage};
#endif
#if defined(SIZE_FLIGHT_RECORDER)
MAMORI_CONSTINIT std::array<std::byte, 512U> recorder_region;
MAMORI_CONSTINIT mamori::FlightRecorder recorder;
#endif

#if defined(SIZE_E2E)
using Profile = mamori::safety::E2eProfile04<0U>;  // the smallest CRC table
constexpr std::size_t kFrameLength = Profile::kHeaderSize + sizeof(std::int32_t);
constexpr mamori::safety::SentIdChannel kChannel{0x0A0B0C0DU, kFrameLength, kFrameLength};
constexpr mamori::safety::E2eInLimits<mamori::safety::HardenedSequence> kLimits{
    30_ms, {1U}, 4U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};
using Protected = mamori::safety::E2eMessage<std::int32_t, Profile, kChannel>;
using Payload = Protected::Frame;
#else
using Payload = std::int32_t;
#endif

#if defined(SIZE_SUPERVISION)
#if defined(SIZE_EIGHT)
constexpr std::size_t kComponentCount = 8U;
#else
constexpr std::size_t kComponentCount = 2U;
#endif
MAMORI_CONSTINIT mamori::safety::ExecutionStorage<kComponentCount> supervision_storage;
MAMORI_CONSTINIT mamori::safety::ExecutionSupervisor supervision{supervision_storage, 1_ms};
constexpr mamori::safety::ComponentLimits kSupervised{{2U, 4U}, {0_ms, 1_ms}};
#endif

#if defined(SIZE_FSM)
enum : mamori::FsmIndex { kClosed, kOpen };
constexpr std::array<mamori::FsmState, 2U> kStates{{{"closed"}, {"open"}}};
constexpr std::array<mamori::FsmMessage, 1U> kMessages{{{"push"}}};
constexpr std::array<mamori::FsmTransition, 2U> kTransitions{{{kClosed, 0U, kOpen}, {kOpen, 0U, kClosed}}};
constexpr mamori::FsmTable kDoorTable{"door", kStates, kMessages, kTransitions, kClosed};
MAMORI_CHECK_FSM(kDoorTable);

class Door final : public mamori::FsmComponentFor<4U> {
  public:
    constexpr Door() noexcept : FsmComponentFor("door", kDoorTable) {}
};
#endif

// ---- The two components of every image.
class Wheel final : public mamori::Component {
  public:
    constexpr Wheel() noexcept : Component("wheel") {}

    mamori::InPort<bool, mamori::Need::kOptional> brake{*this, "brake"};
    mamori::OutPort<Payload> speed{*this, "speed"};
    using Ports = mamori::Ports<&Wheel::brake, &Wheel::speed>;
#if defined(SIZE_PARAMETERS)
    mamori::Parameter<std::int32_t> step{*this, "step", 1, mamori::between(1, 4)};
    using Parameters = mamori::Parameters<&Wheel::step>;
#endif

    Status on_execute(mamori::ContextHandle) noexcept override {
#if defined(SIZE_PARAMETERS)
        speed_ += brake.read() ? -step.get() : step.get();
#else
        speed_ += brake.read() ? -1 : 1;
#endif
#if defined(SIZE_E2E)
        return sender_.write(speed_);
#else
        speed.write(speed_);
        return Status::kOk;
#endif
    }

  private:
#if defined(SIZE_E2E)
    mamori::safety::E2eOutPort<Protected> sender_{speed};
#endif
    std::int32_t speed_{0};
};

class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}

    mamori::InPort<Payload> speed{*this, "speed"};
    mamori::OutPort<bool> brake{*this, "brake"};
    using Ports = mamori::Ports<&Monitor::speed, &Monitor::brake>;

    Status on_execute([[maybe_unused]] mamori::ContextHandle context) noexcept override {
        std::int32_t now = 0;
#if defined(SIZE_E2E)
        static_cast<void>(receiver_.read(context.now, now));
#else
        now = speed.read();
#endif
#if defined(SIZE_SUPERVISION)
        if (supervision.step(context.now) != mamori::safety::GlobalStatus::kOk) {
            return Status::kError;
        }
#endif
#if defined(SIZE_EVENT_LOG)
        event_log.write(context.now, mamori::Severity::kInfo, 1U, 1U, now);
#endif
        brake.write(now >= (brake.get_published() ? 4 : 8));
        return Status::kOk;
    }

#if defined(SIZE_E2E)
  private:
    mamori::safety::E2eInPort<Protected, kLimits> receiver_{speed, 0};
#endif
};

/// Writes its input to its output.
class Stage final : public mamori::Component {
  public:
    constexpr explicit Stage(const char* name) noexcept : Component(name) {}

    mamori::InPort<Payload> in{*this, "in"};
    mamori::OutPort<Payload> out{*this, "out"};
    using Ports = mamori::Ports<&Stage::in, &Stage::out>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        out.write(in.read());
        return Status::kOk;
    }
};

MAMORI_CONSTINIT Wheel wheel;
MAMORI_CONSTINIT Monitor monitor;
#if defined(SIZE_EIGHT)
MAMORI_CONSTINIT std::array<Stage, 6U> stages{Stage{"a"}, Stage{"b"}, Stage{"c"},
                                              Stage{"d"}, Stage{"e"}, Stage{"f"}};
#endif
#if defined(SIZE_FSM)
MAMORI_CONSTINIT Door door;
#endif
#if defined(SIZE_TWO_CORES)
MAMORI_CONSTINIT mamori::Crossing<Payload> speed_crossing;
MAMORI_CONSTINIT mamori::Crossing<bool> brake_crossing;
#endif
enum class Command { kGo, kStop };

constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms),
#if defined(SIZE_TRACE_HASH)
    mamori::trace_hash(),
#endif
#if defined(SIZE_PARAMETERS)
    mamori::configuration_set("fast", mamori::assign(wheel.step, 2)),
#endif
#if defined(SIZE_MODES)
    mamori::system_mode("rest", mamori::runs(wheel)),
    mamori::system_mode("drive", mamori::runs(wheel, monitor)),
    mamori::safe_mode("halt", mamori::runs(wheel)), mamori::mode_transition("rest", Command::kGo, "drive"),
    mamori::mode_transition("drive", Command::kStop, "rest"),
#endif
#if defined(SIZE_FSM)
    mamori::window("serve", 6_ms, 1_ms, mamori::budget(1_ms), mamori::event_driven(2U), mamori::run(door)),
#endif
#if defined(SIZE_RATES)
    mamori::window("drive", 0_ms, 2_ms, mamori::budget(1_ms), mamori::rate(100_hz, 50_hz),
                   mamori::run(wheel)),
#else
    mamori::window("drive", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(wheel)),
#endif
#if defined(SIZE_EIGHT)
    mamori::window("pass", 4_ms, 2_ms, mamori::budget(1_ms),
                   mamori::run(stages[0], stages[1], stages[2], stages[3], stages[4], stages[5])),
    mamori::window("watch", 6_ms, 2_ms, mamori::budget(1_ms), mamori::run(monitor)),
    mamori::connect(wheel.speed, stages[0].in, mamori::any_age()),
    mamori::connect(stages[0].out, stages[1].in, mamori::any_age()),
    mamori::connect(stages[1].out, stages[2].in, mamori::any_age()),
    mamori::connect(stages[2].out, stages[3].in, mamori::any_age()),
    mamori::connect(stages[3].out, stages[4].in, mamori::any_age()),
    mamori::connect(stages[4].out, stages[5].in, mamori::any_age()),
    mamori::connect(stages[5].out, monitor.speed, mamori::any_age()),
    mamori::connect(monitor.brake, wheel.brake, mamori::any_age()));
#elif defined(SIZE_TWO_CORES)
    mamori::window("watch", 3_ms, 2_ms, mamori::core(1), mamori::budget(1_ms), mamori::run(monitor)),
    mamori::connect(wheel.speed, monitor.speed, mamori::through(speed_crossing), mamori::any_age()),
    mamori::connect(monitor.brake, wheel.brake, mamori::through(brake_crossing), mamori::any_age()));
#else
    mamori::window("watch", 3_ms, 2_ms, mamori::budget(1_ms), mamori::run(monitor)),
    mamori::connect(wheel.speed, monitor.speed, mamori::any_age()),
    mamori::connect(monitor.brake, wheel.brake, mamori::any_age()));
#endif

#if defined(SIZE_MODES) || defined(SIZE_PARAMETERS)
MAMORI_CONSTINIT mamori::SystemModes modes{mamori::make_view(kSystem)};
MAMORI_CONSTINIT mamori::ExecutiveFor executive{mamori::kChecked<kSystem>, modes};
#else
MAMORI_CONSTINIT mamori::ExecutiveFor executive{mamori::kChecked<kSystem>};
#endif
#if defined(SIZE_TWO_CORES)
MAMORI_CONSTINIT mamori::ExecutiveFor second{mamori::kChecked<kSystem>, 1U};
#endif
#if defined(SIZE_INTROSPECTION)
MAMORI_CONSTINIT mamori::IntrospectionFor introspection{kSystem};
#endif

/// The cheapest possible platform host, so that the image measures the kernel and not a port.
class Host final : public mamori::WindowHost {
  public:
    mamori::Instant now{};

    mamori::Instant get_now() const noexcept override { return now; }
    mamori::Instant get_step_end() const noexcept override { return now; }
    std::size_t run_within(const Work& work, mamori::Instant) noexcept override {
        work.run(work.argument, work.first, work.first + work.count);
        return work.count;
    }
    bool has_returned(std::size_t) const noexcept override { return true; }
};
Host host;

/// Setup of the feature before the start.
Status prepare() noexcept {
    Status result = Status::kOk;
#if defined(SIZE_SUPERVISION)
    executive.set_observer(&supervision);
    for (std::size_t i = 0U; i < kComponentCount && result == Status::kOk; ++i) {
        result = supervision.watch(i, kSupervised);
    }
#endif
#if defined(SIZE_INTROSPECTION)
    executive.set_introspection(&introspection);
#endif
#if defined(SIZE_FLIGHT_RECORDER)
    result = recorder.open(recorder_region);
    if (result == Status::kOk) {
        result = event_log.attach(recorder);
    }
#endif
#if defined(SIZE_TWO_CORES)
    result = second.initialize();
#endif
    return result;
}

/// Work of the feature while the system runs.
Status use_feature() noexcept {
#if defined(SIZE_RATES)
    return executive.get_context(0U).set_rate(50.0);
#elif defined(SIZE_PARAMETERS)
    return modes.get_configuration().activate_configuration_set(0U);
#elif defined(SIZE_MODES)
    return modes.request(Command::kGo);
#elif defined(SIZE_FSM)
    return door.send_stimulus(0U);
#elif defined(SIZE_TRACE_HASH)
    return executive.get_trace_hash() != 0U ? Status::kOk : Status::kError;
#elif defined(SIZE_INTROSPECTION)
    mamori::WindowSnapshot window{};
    return introspection.read_window(0U, window);
#elif defined(SIZE_EVENT_LOG)
    return event_log.get(0U).code == 1U ? Status::kOk : Status::kError;
#elif defined(SIZE_TWO_CORES)
    return second.stop();
#else
    return Status::kOk;
#endif
}

void run_frame(std::int64_t frame) noexcept {
    for (std::size_t w = 0U; w < kSystem.windows.size(); ++w) {
        const mamori::WindowRow& row = kSystem.windows[w];
        host.now = mamori::Instant{frame * kSystem.frame.ns + row.offset.ns};
#if defined(SIZE_TWO_CORES)
        static_cast<void>(
            (row.core == 0U ? static_cast<mamori::Executive&>(executive) : second).run_window(w, host));
#else
        static_cast<void>(executive.run_window(w, host));
#endif
    }
}

Status run_system() noexcept {
    Status result = prepare();
    if (result == Status::kOk) {
        result = executive.initialize();
    }
    if (result == Status::kOk) {
        result = executive.start();
    }
#if defined(SIZE_TWO_CORES)
    if (result == Status::kOk) {
        result = second.start();
    }
#endif
    for (std::int64_t frame = 0; result == Status::kOk && frame < 20; ++frame) {
        run_frame(frame);
        if (frame == 9) {
            result = use_feature();
        }
    }
    return result == Status::kOk ? executive.stop() : result;
}

}  // namespace

int run_program() noexcept {
    return run_system() == Status::kOk ? kEnded : kNotStarted;
}

}  // namespace proof
