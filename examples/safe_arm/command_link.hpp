// SPDX-License-Identifier: Apache-2.0
/// @file
/// Both ends of the connection from the controller to the safety partition. What lies between them is not
/// trusted: only an accepted command is forwarded.
///
/// @satisfies SWR-SAF-008, SWR-SAF-041      Design: docs/design/safe_arm.md#messages
#ifndef EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP
#define EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP

#include "arm_limits.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/protected_link.hpp"
#include "messages.hpp"

namespace safe_arm {

using CommandProfile = mamori::safety::E2eProfile04<>;
inline constexpr std::size_t kCommandLength =
    CommandProfile::kHeaderSize + mamori::max_encoded_size<TorqueCommand>();
inline constexpr mamori::safety::SentIdChannel kCommandChannelId{0x41524D01U, kCommandLength, kCommandLength,
                                                                 0U};
using CommandFrameMessage = mamori::safety::E2eMessage<TorqueCommand, CommandProfile, kCommandChannelId>;
using CommandFrame = CommandFrameMessage::Frame;

/// HARDENED. The table checks the age of the command itself; the channel is not trusted with it. After
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
using CommandSender = mamori::safety::E2eSender<CommandFrameMessage>;
using CommandReceiver = mamori::safety::E2eReceiver<CommandFrameMessage, kCommandLimits>;

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_COMMAND_LINK_HPP
