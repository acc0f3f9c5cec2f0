// SPDX-License-Identifier: Apache-2.0
/// @file
/// Communication errors on one link, injected by its sender at planned major frames: the eight of IEC
/// 61784-3.
///
/// @satisfies SWR-HIL-004      Design: docs/design/safe_arm.md#hardware-in-the-loop
/// Source:   IEC 61784-3:2021, 5.3 (communication errors)
#ifndef EXAMPLES_SAFE_ARM_HIL_LINK_ERRORS_HPP
#define EXAMPLES_SAFE_ARM_HIL_LINK_ERRORS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>

#include "mamori/ports/lcm/message_queue.hpp"
#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/safety/e2e/profile_04.hpp"

namespace safe_arm {

/// Numbers are positions in kLinkErrorNames.
enum class LinkError : std::uint8_t {
    kCorruption,  ///< up to three bits of each message are inverted
    kRepetition,  ///< each message is sent twice
    kSequence,    ///< two messages change places
    kLoss,        ///< no message is sent
    kDelay,       ///< messages are sent `delay_frames` later, in order
    kInsertion,   ///< before each message, one of an unknown source is sent
    kMasquerade,  ///< after each message, a non-safety sender imitates it: right identifier, no valid
                  ///< checksum
    kAddressing,  ///< instead of each message, one for another receiver is sent
};
inline constexpr std::array<const char*, 8U> kLinkErrorNames{
    "corruption", "repetition", "sequence", "loss", "delay", "insertion", "masquerade", "addressing"};

/// Numbers are positions in kLinkNames.
enum class Link : std::uint8_t {
    kDevice,   ///< plant to kernel
    kDrive,    ///< kernel to plant
    kState,    ///< kernel to controller
    kCommand,  ///< controller to kernel
};
inline constexpr std::array<const char*, 4U> kLinkNames{"device", "drive", "state", "command"};

/// @return position of `name`; empty when it is not in the list.
template <std::size_t kCount>
std::optional<std::size_t> find_name(const std::array<const char*, kCount>& names, std::string_view name) {
    for (std::size_t i = 0U; i < kCount; ++i) {
        if (name == names[i]) {
            return i;
        }
    }
    return std::nullopt;
}

/// One error on one link. Default: none.
struct LinkErrorPlan {
    Link link{Link::kCommand};
    LinkError error{LinkError::kLoss};
    std::uint64_t first_frame{0U};
    std::uint64_t frame_count{0U};  ///< major frames; 0: no error
    std::uint64_t delay_frames{0U};
    std::uint64_t seed{1U};

    /// Pure.
    bool is_active(Link where, std::uint64_t frame) const noexcept {
        return where == link && frame >= first_frame && frame - first_frame < frame_count;
    }
};

/// Sends messages to a transport, damaged as planned. Host only.
///
/// Thread safety: none. Time: O(octets), and that of the transport. Memory: kHeld messages.
class FaultySink final : public mamori::ports::lcm::MessageSink {
  public:
    static constexpr std::size_t kHeld = 64U;
    static constexpr std::size_t kMessageMax = 512U;

    /// @param[in] channel of the link; static storage.
    FaultySink(Link link, const mamori::safety::SentIdChannel& channel) noexcept
        : link_(link), channel_(channel) {}

    /// Before the first message. @param[in] target must outlive this object.
    void configure(const LinkErrorPlan& plan, mamori::ports::lcm::MessageSink& target) noexcept {
        plan_ = plan;
        target_ = &target;
        random_.seed(plan.seed);
    }
    /// Before the messages of major frame `frame`.
    void set_frame(std::uint64_t frame) noexcept { frame_ = frame; }

    /// @return that of the transport; kPreconditionNotMet without one; kBadParameter (longer than
    ///         kMessageMax).
    mamori::Status send(mamori::Span<const std::byte> message) noexcept override;

    /// Messages that were affected by an error.
    std::uint64_t get_injected_count() const noexcept { return injected_count_; }

  private:
    struct Message {
        std::array<std::byte, kMessageMax> octets{};
        std::size_t size{0U};
        std::uint64_t due_frame{0U};
        mamori::Span<std::byte> get() noexcept { return {octets.data(), size}; }
    };

    mamori::Status forward(const Message& message) noexcept;
    mamori::Status send_with_error(Message& message) noexcept;
    mamori::Status send_delayed(const Message& message) noexcept;
    void corrupt(Message& message) noexcept;
    /// The message as a sender with another data identifier would protect it.
    Message readdress(const Message& message, std::uint32_t offset) const noexcept;

    Link link_;
    const mamori::safety::SentIdChannel& channel_;
    mamori::ports::lcm::MessageSink* target_{nullptr};
    LinkErrorPlan plan_{};
    std::uint64_t frame_{0U};
    std::uint64_t injected_count_{0U};
    std::mt19937_64 random_;
    std::array<Message, kHeld> held_{};  ///< the oldest at first_
    std::size_t first_{0U};
    std::size_t held_count_{0U};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_LINK_ERRORS_HPP
