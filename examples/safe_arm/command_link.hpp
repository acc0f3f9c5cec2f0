// SPDX-License-Identifier: Apache-2.0
/// @file
/// Both ends of the connection from the controller to the safety partition. What lies between them is not
/// trusted: only an accepted command is forwarded.
///
/// @satisfies SWR-SAF-041      Design: docs/design/safe_arm.md#messages
#ifndef EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP
#define EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP

#include "arm_limits.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/e2e/in_port.hpp"
#include "mamori/safety/e2e/out_port.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "messages.hpp"

namespace safe_arm {

using CommandProfile = mamori::safety::E2eProfile04<>;
inline constexpr std::size_t kCommandLength =
    CommandProfile::kHeaderSize + mamori::max_encoded_size<TorqueCommand>();
inline constexpr mamori::safety::SentIdChannel kCommandChannelId{0x41524D01U, kCommandLength, kCommandLength,
                                                                 0U};
using CommandFrameMessage = mamori::safety::E2eMessage<TorqueCommand, CommandProfile, kCommandChannelId>;
using CommandFrame = CommandFrameMessage::Frame;

/// HARDENED. The monitor checks the age in the command itself; the channel is not trusted with it. After
/// more losses than tolerated, the fault CommandStale is latched, so the order may be found again without a
/// reset.
inline constexpr mamori::safety::E2eInLimits<mamori::safety::HardenedSequence> kCommandLimits{
    kFrame,
    {kCommandLossesMax + 1U, 2U, mamori::safety::Resynchronisation::kByRun},
    1U,
    {{1U, 0U}, {1U, 0U}, {1U, 0U}},
    mamori::safety::MappingRule::kSyncIsOk,
    {}};

/// Protects the commands of the controller. It runs in the partition of the controller.
class CommandSender final : public mamori::Component {
  public:
    constexpr CommandSender() noexcept : Component("command_sender") {}

    mamori::InPort<TorqueCommand> in{*this, "in"};
    mamori::OutPort<CommandFrame> out{*this, "out"};
    using Ports = mamori::Ports<&CommandSender::in, &CommandSender::out>;

    mamori::Status on_execute(mamori::ContextHandle) noexcept override {
        return in.is_new() ? protected_.write(in.read()) : mamori::Status::kOk;
    }

  private:
    mamori::safety::E2eOutPort<CommandFrameMessage> protected_{out};
};

/// Forwards accepted commands only.
class CommandReceiver final : public mamori::Component {
  public:
    constexpr CommandReceiver() noexcept : Component("command_receiver") {}

    mamori::InPort<CommandFrame> in{*this, "in"};
    mamori::OutPort<TorqueCommand> out{*this, "out"};
    using Ports = mamori::Ports<&CommandReceiver::in, &CommandReceiver::out>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override {
        TorqueCommand command{};
        if (protected_.read(context.now, command) == mamori::safety::E2eWorth::kNew) {
            out.write(command);
        }
        return mamori::Status::kOk;
    }
    std::uint32_t get_count(mamori::safety::E2eOutcome outcome) const noexcept {
        return protected_.get_count(outcome);
    }

  private:
    static constexpr TorqueCommand kNoCommand{};
    mamori::safety::E2eInPort<CommandFrameMessage, kCommandLimits> protected_{in, kNoCommand};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP
