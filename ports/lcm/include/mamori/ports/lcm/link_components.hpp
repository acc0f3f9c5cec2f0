// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two ends of a connection to another program, as components of a system table. Other components use
/// their ports and do not know the transport; what arrives is used only after E2E accepted it.
///
/// @satisfies SWR-LCM-006, SWR-LCM-008      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_LINK_COMPONENTS_HPP
#define MAMORI_PORTS_LCM_LINK_COMPONENTS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/lcm/message_queue.hpp"
#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/e2e/protected_receiver.hpp"
#include "mamori/safety/e2e/protector.hpp"

namespace mamori::ports::lcm {

/// What became of the messages of one receiver so far. Each counter stops at its largest value.
struct LinkNews {
    std::uint32_t used{0U};     ///< accepted by E2E and decoded
    std::uint32_t lost{0U};     ///< by the counter, missing before an accepted message
    std::uint32_t damaged{0U};  ///< refused by E2E or by the decoder, or a frame that is not well-formed
    /// Intact, but repeated, old or beyond the limit: of a second sender or a replay.
    std::uint32_t unordered{0U};
    std::uint32_t initial{0U};  ///< intact, with which the receiver found the order; not used
    std::uint32_t foreign{0U};  ///< of another type
    std::uint32_t truncated{0U};
    std::uint32_t oversized{0U};
    std::uint32_t overwritten{0U};  ///< overwritten in the queue; also counted as lost
    bool is_closed{false};  ///< more messages in a row were lost than allowed; restart() opens it again
};

}  // namespace mamori::ports::lcm

MAMORI_FIELDS(mamori::ports::lcm::LinkNews, used, lost, damaged, unordered, initial, foreign, truncated,
              oversized, overwritten, is_closed)

namespace mamori::ports::lcm {

/// Sends what is new at its input. @tparam Message LcmMessage.
///
/// Thread safety: none; runs in its window. Time: O(size of a message), and that of the sink.
/// Memory: one message.
template <typename Message>
class LinkSender final : public Component {
  public:
    /// @param[in] sink opened before the executive is initialised; must have static storage.
    constexpr LinkSender(const char* name, MessageSink& sink) noexcept : Component(name), sink_(sink) {}

    InPort<typename Message::Value> in{*this, "in"};
    using Ports = mamori::Ports<&LinkSender::in>;

    /// @return kOk, also when the transport lost the message, which get_failed_count() counts and the
    ///         receiver detects; kBadParameter (an enumeration of the value holds none of its enumerators);
    ///         kPreconditionNotMet (the protector rejects the channel of Message).
    Status on_execute(ContextHandle) noexcept override {
        if (!in.is_new()) {
            return Status::kOk;
        }
        const Span<std::byte> buffer(buffer_.data(), buffer_.size());
        const Result<std::size_t> size = encode_protected<Message>(in.read(), protector_, buffer);
        if (!size.has_value()) {
            return size.get_status();
        }
        if (sink_.send({buffer_.data(), size.get_value()}) != Status::kOk &&
            failed_count_ != std::numeric_limits<std::uint32_t>::max()) {
            ++failed_count_;
        }
        return Status::kOk;
    }
    /// Messages that the transport did not take.
    constexpr std::uint32_t get_failed_count() const noexcept { return failed_count_; }

  private:
    MessageSink& sink_;
    safety::E2eProtector<typename Message::Profile> protector_{Message::kChannel};
    std::array<std::byte, Message::kSizeMax> buffer_{};
    std::uint32_t failed_count_{0U};
};

/// Reads all waiting messages and gives the newest accepted value to `out`; `out` gets nothing when none was
/// accepted. `news` tells about every cycle. @tparam Queue MessageQueue of the message.
///
/// Thread safety: none; runs in its window. Time: O(size of kDepth messages), no system call.
/// Memory: one value.
template <typename Message, typename Queue>
class LinkReceiver final : public Component, public safety::ProtectedReceiver {
  public:
    using Value = typename Message::Value;
    static constexpr std::uint8_t kProfile = Message::Profile::kNumber;
    static constexpr std::uint32_t kMaxDelta = 0U;  ///< stated at run time

    /// @param[in] queue  of the transport; must have static storage.
    /// @param[in] limits of HardenedSequence, which never accepts an older message.
    constexpr LinkReceiver(const char* name, Queue& queue, const safety::HardenedLimits& limits) noexcept
        : Component(name), queue_(queue), checker_(Message::kChannel, limits) {}

    OutPort<Value> out{*this, "out"};
    OutPort<LinkNews> news{*this, "news"};
    using Ports = mamori::Ports<&LinkReceiver::out, &LinkReceiver::news>;

    /// Drops the messages of an earlier run. @return kOk.
    Status on_startup(ContextHandle) noexcept override {
        Span<const std::byte> message;
        for (std::size_t i = 0U; i < Queue::kCapacity && queue_.take(message) != Status::kPreconditionNotMet;
             ++i) {
        }
        return Status::kOk;
    }
    /// @return kOk, with any content of the messages.
    Status on_execute(ContextHandle) noexcept override {
        bool has_value = false;
        bool is_silent = true;
        Span<const std::byte> message;
        for (std::size_t i = 0U; i < Queue::kCapacity; ++i) {
            const Status status = queue_.take(message);
            if (status == Status::kPreconditionNotMet) {
                break;
            }
            is_silent = false;
            // With kOutOfResources, the writer was faster: messages wait.
            has_value = (status == Status::kOk && accept(message)) || has_value;
        }
        if (is_silent) {
            static_cast<void>(checker_.check_silence());
        }
        if (has_value) {
            out.write(value_);
        }
        news.write(get_news());
        return Status::kOk;
    }

    /// Finds the order of messages again. Only for a deliberate reset, for example after the sender
    /// restarted.
    void restart() noexcept { checker_.restart(); }

    /// The state that the last cycle wrote to `news`, with the present counters of the queue.
    LinkNews get_news() const noexcept {
        const ReceptionCounts counts = queue_.get_counts();
        LinkNews now = state_;
        now.damaged = add(state_.damaged, counts.damaged);
        now.foreign = counts.foreign;
        now.truncated = counts.truncated;
        now.oversized = counts.oversized;
        now.overwritten = counts.overwritten;
        now.is_closed = checker_.get_order().is_closed();
        return now;
    }

  private:
    static constexpr std::uint32_t add(std::uint32_t a, std::uint32_t b) noexcept {
        const std::uint32_t max = std::numeric_limits<std::uint32_t>::max();
        return b > max - a ? max : a + b;
    }
    bool accept(Span<const std::byte> message) noexcept {
        const bool is_synchronised = checker_.get_order().is_synchronised();
        const bool is_closed = checker_.get_order().is_closed();
        const safety::CheckStatus status = checker_.check(get_protected_part(message));
        if (!is_usable(status)) {
            const bool is_intact = status != safety::CheckStatus::kError;
            std::uint32_t& count = !is_intact                     ? state_.damaged
                                   : is_synchronised || is_closed ? state_.unordered
                                                                  : state_.initial;
            count = add(count, 1U);
            return false;
        }
        state_.lost = add(state_.lost, checker_.get_order().get_lost_count());
        if (decode_protected<Message>(message, value_) != Status::kOk) {
            state_.damaged = add(state_.damaged, 1U);
            return false;
        }
        record_accepted(value_);
        state_.used = add(state_.used, 1U);
        return true;
    }

    Queue& queue_;
    safety::HardenedE2eChecker<typename Message::Profile> checker_;
    Value value_{};
    LinkNews state_{};
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_LINK_COMPONENTS_HPP
