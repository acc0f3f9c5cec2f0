// SPDX-License-Identifier: Apache-2.0
/// @file
/// Plant and controller with their ends of the links, for any transport.
///
/// @satisfies SWR-HIL-001      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_ENDS_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_ENDS_HPP

#include <cstdint>

#include "hil_controller.hpp"
#include "hil_messages.hpp"
#include "hil_plant.hpp"
#include "link_errors.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"

namespace safe_arm {

using DriveQueue = mamori::ports::lcm::MessageQueue<DriveMessage, kHilQueueDepth>;
using StateQueue = mamori::ports::lcm::MessageQueue<StateMessage, kHilQueueDepth>;

/// The longest time between two messages, as evidence of a disturbed host. Thread safety: none.
class GapWatch final {
  public:
    void note(mamori::Instant now) noexcept {
        const mamori::Duration gap = now - last_;
        longest_ = has_last_ && gap > longest_ ? gap : longest_;
        last_ = now;
        has_last_ = true;
    }
    mamori::Duration get_longest() const noexcept { return longest_; }

  private:
    mamori::Instant last_{};
    mamori::Duration longest_{};
    bool has_last_{false};
};

/// Receives messages of one link and sends on another, outside of any system table.
///
/// Thread safety: none. Memory: one value of each type.
template <typename InMessage, typename Queue, typename OutMessage>
class LinkEnd final {
  public:
    /// All must outlive this object.
    LinkEnd(Queue& queue, FaultySink& sink)
        : receiver_("receiver", queue, {kHilMaxDelta}), sender_("sender", sink), sink_(sink) {}

    /// Takes the waiting messages. @return true when one of them is valid and new: get_received().
    bool receive(mamori::Instant now) noexcept {
        static_cast<void>(receiver_.on_execute({0, now}));
        const bool is_new = receiver_.out.publish(now);
        if (is_new) {
            received_.note(now);
        }
        return is_new;
    }
    const typename InMessage::Value& get_received() const noexcept { return receiver_.out.get_published(); }
    /// @param[in] frame major frame of the message, for planned errors.
    void send(const typename OutMessage::Value& value, std::uint64_t frame, mamori::Instant now) noexcept {
        if (frame > 0U) {
            sent_.note(now);
        }
        sink_.set_frame(frame);
        source_.write(value);
        sender_.in.take(source_.get_staged_sample(now));
        static_cast<void>(sender_.on_execute({0, now}));
    }
    mamori::ports::lcm::LinkNews get_news() const noexcept { return receiver_.get_news(); }
    mamori::Duration get_longest_received_gap() const noexcept { return received_.get_longest(); }
    mamori::Duration get_longest_sent_gap() const noexcept { return sent_.get_longest(); }

  private:
    mamori::ports::lcm::LinkReceiver<InMessage, Queue> receiver_;
    mamori::ports::lcm::LinkSender<OutMessage> sender_;
    mamori::OutPort<typename OutMessage::Value> source_{mamori::kNoOwner, "source"};
    FaultySink& sink_;
    GapWatch received_{};
    GapWatch sent_{};
};

using PlantEnd = LinkEnd<DriveMessage, DriveQueue, DeviceMessage>;
using ControllerEnd = LinkEnd<StateMessage, StateQueue, CommandMessage>;

/// Sends the answer of the plant.
inline void send_answer(HilPlant& plant, PlantEnd& end, mamori::Instant now) {
    const std::uint64_t frames = plant.get_frame_count();
    end.send(plant.answer(), frames == 0U ? 0U : frames - 1U, now);
}

/// Replies to the newest input, if there is one, and the controller does not hang by `fault`.
inline void reply(HilController& controller, ControllerEnd& end, const mamori::sim::FaultPlan& fault,
                  mamori::Instant now) noexcept {
    if (!end.receive(now)) {
        return;
    }
    const ControllerInput& input = end.get_received();
    const bool is_hanging = fault.kind == mamori::sim::FaultKind::kControllerHang &&
                            is_active(fault, mamori::Instant{input.sent_at_ns});
    if (!is_hanging) {
        controller.follow(fault, mamori::Instant{input.sent_at_ns});
        end.send(controller.reply(input), static_cast<std::uint64_t>(input.sent_at_ns / kFrame.ns), now);
    }
}

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_ENDS_HPP
