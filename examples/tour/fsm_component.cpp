// SPDX-License-Identifier: Apache-2.0
// A state machine: a gripper that opens and closes on messages, and a lamp that acts on its state.
#include <array>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/component/fsm_component.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

enum State : mamori::FsmIndex { kOpen, kClosed };
enum Message : mamori::FsmIndex { kClose, kRelease };

/// The argument of `close` is the force [N].
static bool is_gentle(const mamori::FsmComponent&, const mamori::FsmEvent& event) noexcept {
    return event.argument <= 40;
}

static constexpr std::array<mamori::FsmState, 2U> kStates{{{"open"}, {"closed"}}};
static constexpr std::array<mamori::FsmMessage, 2U> kMessages{{{"close", "force [N]"}, {"release"}}};
static constexpr std::array<mamori::FsmTransition, 2U> kTransitions{{
    {kOpen, kClose, kClosed, &is_gentle},
    {kClosed, kRelease, kOpen},
}};
static constexpr mamori::FsmTable kGripper{"gripper", kStates, kMessages, kTransitions, kOpen};
MAMORI_CHECK_FSM(kGripper);

class Lamp final : public mamori::Component {
  public:
    constexpr Lamp() noexcept : Component("lamp") {}
    Status on_action(mamori::ContextHandle) noexcept override;
    bool is_on() const noexcept { return is_on_; }

  private:
    bool is_on_{false};
};

static Lamp lamp;
/// The lamp acts when the gripper enters and leaves the state `closed`.
static constexpr std::array<mamori::FsmBehavior, 1U> kProfile{
    {{&lamp, {mamori::FsmElement::Kind::kState, kClosed}}}};

class Gripper final : public mamori::FsmComponentFor<4U> {
  public:
    constexpr Gripper() noexcept : FsmComponentFor("gripper", kGripper, kProfile) {}
};

static Gripper gripper;

Status Lamp::on_action(mamori::ContextHandle) noexcept {
    is_on_ = gripper.get_step().phase == mamori::FsmStep::Phase::kEntry;
    return Status::kOk;
}

static constexpr auto kSystem =
    mamori::system(mamori::frame(10_ms),
                   mamori::window("grip", 0_ms, 2_ms, mamori::event_driven(2U), mamori::budget(1_ms),
                                  mamori::run(gripper, lamp)),
                   mamori::modelled_time(gripper, 100_us), mamori::modelled_time(lamp, 100_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

/// Sends a message before each major frame, and prints.
class Operator final : public mamori::Devices {
    void sample(std::uint64_t frame, mamori::Instant) noexcept override {
        constexpr std::array<mamori::FsmEvent, 4U> kSent{
            {{kClose, 90}, {kClose, 30}, {kClose, 30}, {kRelease}}};
        const mamori::FsmEvent& event = kSent[frame % kSent.size()];
        const Status status = gripper.send_stimulus(event.message, {}, event.argument);
        std::printf("%s %d: %s, ", kMessages[event.message].name, static_cast<int>(event.argument),
                    status == Status::kOk ? "queued" : "rejected");
    }
    void apply(std::uint64_t, mamori::Instant, mamori::Duration) noexcept override {
        std::printf("now %s, lamp %s, %u ignored\n", gripper.get_current_state_name(),
                    lamp.is_on() ? "on" : "off", gripper.get_ignored_count());
    }
};

int main() {
    Operator devices;
    return machine.run(4U, devices) == Status::kOk ? 0 : 1;
}
