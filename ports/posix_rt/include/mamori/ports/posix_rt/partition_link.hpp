// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two ends of a connection between processes, as components of the two system tables: the sender writes
/// its input value into a message, and the receiver writes the value of the message to its output. The
/// connection is a black channel (IEC 61784-3): the receiving program must check age and content.
///
/// @satisfies SWR-PRT-013, SWR-PRT-014, SWR-PRT-018      Design: docs/design/posix_rt.md#partitions
#ifndef MAMORI_PORTS_POSIX_RT_PARTITION_LINK_HPP
#define MAMORI_PORTS_POSIX_RT_PARTITION_LINK_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/partition_news.hpp"
#include "mamori/ports/posix_rt/shared_frame.hpp"

namespace mamori::ports::posix_rt {

/// Byte order of each message.
inline constexpr ByteOrder kFrameOrder = ByteOrder::kLittle;

/// Sends each new input value with its publication instant. Run the sender in its own window: the executive
/// discards the values of a window that overruns, but it cannot withdraw a message that was sent.
///
/// Thread safety: none; runs in its window. Time: O(sizeof(T)). Memory: one encoded T.
template <typename T>
class PartitionSender final : public Component {
  public:
    static constexpr std::size_t kCapacity = max_encoded_size<T>();
    static_assert(kCapacity <= kFrameCapacityMax, "this payload does not fit into a message");

    /// @param[in] writer opened with kCapacity before the executive is initialised; must have static storage.
    constexpr PartitionSender(const char* name, FrameWriter& writer) noexcept
        : Component(name), writer_(writer) {}

    InPort<T> in{*this, "in"};
    using Ports = mamori::Ports<&PartitionSender::in>;

    /// @return kOk; kPreconditionNotMet (the writer is not open, or for another capacity).
    Status on_initialize() noexcept override {
        return writer_.get_capacity() == kCapacity ? Status::kOk : Status::kPreconditionNotMet;
    }
    /// @return kOk; kBadParameter (an enumeration of the value has a number that is not an enumerator; the
    ///         value is not sent).
    Status on_execute(ContextHandle) noexcept override {
        if (!in.is_new()) {
            return Status::kOk;
        }
        const Result<std::size_t> length = encode(in.read(), {buffer_.data(), buffer_.size()}, kFrameOrder);
        if (!length.has_value()) {
            return length.get_status();
        }
        return writer_.write({buffer_.data(), length.get_value()}, in.get_published_at());
    }

  private:
    FrameWriter& writer_;
    std::array<std::byte, kCapacity> buffer_{};
};

/// Receives the newest message. `out` is written for valid messages only, so without them the age of its last
/// value continues to grow for its readers. `news` is written in each cycle.
///
/// Thread safety: none; runs in its window. Time: O(sizeof(T)), bounded for any behaviour of the other
/// process, no system call. Memory: one T and one encoded T.
template <typename T>
class PartitionReceiver final : public Component {
  public:
    static constexpr std::size_t kCapacity = PartitionSender<T>::kCapacity;

    /// @param[in] reader   opened with kCapacity before the executive is initialised; must have static
    /// storage.
    /// @param[in] lead_max maximum time from now to the instant of a message, >= 0; a message with a later
    /// instant is malformed.
    constexpr PartitionReceiver(const char* name, FrameReader& reader, Duration lead_max = {}) noexcept
        : Component(name), reader_(reader), lead_max_(lead_max) {}

    OutPort<T> out{*this, "out"};
    OutPort<PartitionNews> news{*this, "news"};
    using Ports = mamori::Ports<&PartitionReceiver::out, &PartitionReceiver::news>;

    /// @return kOk; kPreconditionNotMet (the reader is not open, or for another capacity).
    Status on_initialize() noexcept override {
        return reader_.get_capacity() == kCapacity ? Status::kOk : Status::kPreconditionNotMet;
    }
    /// Discards a message of an earlier run, which would count as new. @return kOk.
    Status on_startup(ContextHandle) noexcept override {
        FrameFacts facts{};
        static_cast<void>(reader_.take({buffer_.data(), buffer_.size()}, facts));
        return Status::kOk;
    }
    /// @return kOk, for any message.
    Status on_execute(ContextHandle context) noexcept override {
        FrameFacts facts{};
        FrameOutcome outcome = reader_.take({buffer_.data(), buffer_.size()}, facts);
        state_.skipped = 0U;
        state_.age_ns = 0;
        if (outcome == FrameOutcome::kNew && !accept(facts, context.now)) {
            outcome = FrameOutcome::kMalformed;
        }
        const bool is_refused = outcome == FrameOutcome::kTorn || outcome == FrameOutcome::kMalformed;
        state_.refused += is_refused && state_.refused != kRefusedMax ? 1U : 0U;
        state_.outcome = outcome;
        news.write(state_);
        return Status::kOk;
    }

  private:
    static constexpr std::uint32_t kRefusedMax = 0xFFFFFFFFU;
    /// Instants beyond this limit (73 years) are invalid. The difference of two valid instants cannot
    /// overflow.
    static constexpr std::int64_t kFarthest = std::int64_t{1} << 61U;

    bool accept(const FrameFacts& facts, Instant now) noexcept {
        const std::int64_t at = facts.published_at.ns;
        const bool is_instant = at > -kFarthest && at < kFarthest && facts.published_at - now <= lead_max_;
        if (!is_instant || decode({buffer_.data(), facts.length}, kFrameOrder, value_) != Status::kOk) {
            return false;
        }
        state_.skipped = state_.number == 0U ? 0U : facts.number - state_.number - 1U;
        state_.number = facts.number;
        state_.age_ns = (now - facts.published_at).ns;
        out.write(value_);
        return true;
    }

    FrameReader& reader_;
    Duration lead_max_;
    std::array<std::byte, kCapacity> buffer_{};
    T value_{};
    PartitionNews state_{};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_PARTITION_LINK_HPP
