// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every transport has in common: where messages are sent to, and the queue between the thread that
/// receives messages and the window that reads them.
///
/// @satisfies SWR-LCM-006, SWR-LCM-007      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_MESSAGE_QUEUE_HPP
#define MAMORI_PORTS_LCM_MESSAGE_QUEUE_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/ports/lcm/codec.hpp"

namespace mamori::ports::lcm {

/// Sending end of a transport.
class MessageSink {
  public:
    /// Sends one message. @param[in] message fingerprint included; not kept.
    /// @return kOk (given to the transport, which may lose it); kPreconditionNotMet (not open);
    ///         kBadParameter (longer than the sender was made for); kOutOfResources (the transport is full:
    ///         this message is lost); kError (the transport reported an error: this message is lost).
    virtual Status send(Span<const std::byte> message) noexcept = 0;

  protected:
    MessageSink() noexcept = default;
    MessageSink(const MessageSink&) noexcept = default;
    MessageSink& operator=(const MessageSink&) noexcept = default;
    ~MessageSink() = default;
};

/// What messages of one type look like.
struct MessageLimits {
    std::uint64_t fingerprint{0U};
    std::size_t size_min{0U};  ///< fingerprint included [byte], at least kFingerprintSize
    std::size_t size_max{0U};  ///< [byte]
};
template <typename Message>
inline constexpr MessageLimits kLimitsOf{Message::kFingerprint, Message::kSizeMin, Message::kSizeMax};

/// What became of the messages that a transport received. Each counter stops at its largest value.
struct ReceptionCounts {
    std::uint32_t accepted{0U};     ///< given to the queue
    std::uint32_t foreign{0U};      ///< another fingerprint: a message of another type
    std::uint32_t truncated{0U};    ///< shorter than the shortest message of the type
    std::uint32_t oversized{0U};    ///< longer than the longest message of the type
    std::uint32_t damaged{0U};      ///< frames of a byte stream that are not well-formed; not of LCM
    std::uint32_t overwritten{0U};  ///< accepted, but overwritten before the window read them
};

/// Receiving end of a transport: sorts messages, and keeps each message of its type.
///
/// Thread safety: one thread calls put() and put_damaged(); get_counts() from anywhere.
/// Time:          wait-free, O(size_max). Memory: counters; no heap.
class MessageInbox {
  public:
    /// Takes one received message of any content. @param[in] message not kept.
    void put(Span<const std::byte> message) noexcept;
    /// Counts octets that are not a frame.
    void put_damaged() noexcept { count(damaged_); }
    /// Counts a message that was too long for the buffer of its transport.
    void put_oversized() noexcept { count(oversized_); }
    /// The counters so far; each is read on its own.
    ReceptionCounts get_counts() const noexcept;
    const MessageLimits& get_limits() const noexcept { return limits_; }

  protected:
    explicit constexpr MessageInbox(const MessageLimits& limits) noexcept : limits_(limits) {}
    MessageInbox(const MessageInbox&) = delete;
    MessageInbox& operator=(const MessageInbox&) = delete;
    ~MessageInbox() = default;

  private:
    using Counter = std::atomic<std::uint32_t>;

    virtual void store(Span<const std::byte> message) noexcept = 0;
    virtual std::uint32_t get_overwritten_count() const noexcept = 0;
    /// A load and a store count: the counter has one writer.
    static void count(Counter& counter) noexcept;

    MessageLimits limits_;
    Counter accepted_{0U};
    Counter foreign_{0U};
    Counter truncated_{0U};
    Counter oversized_{0U};
    Counter damaged_{0U};
};

/// Queue of up to kDepth messages; a newer message overwrites the oldest.
/// @tparam Message LcmMessage. @tparam kDepth 1 .. 254.
///
/// Thread safety: one thread calls the members of MessageInbox, one context take().
/// Time:          wait-free, O(size of a message). Memory: kDepth + 2 messages; no heap.
template <typename Message, std::size_t kDepth>
class MessageQueue final : public MessageInbox {
  public:
    static constexpr std::size_t kCapacity = kDepth;

    constexpr MessageQueue() noexcept : MessageInbox(kLimitsOf<Message>) {}

    /// Takes the oldest message. @param[out] message valid until the next call; unchanged when none waits.
    /// @return kOk; kPreconditionNotMet (none waits); kOutOfResources (the writer was faster: call again).
    Status take(Span<const std::byte>& message) noexcept {
        if (is_held_) {
            fifo_.drop();
            is_held_ = false;
        }
        const Status status = fifo_.peek();
        if (status == Status::kOk) {
            is_held_ = true;
            const Slot& slot = fifo_.get_front();
            message = {slot.octets.data(), slot.size};
        }
        return status;
    }

  private:
    struct Slot {
        std::size_t size{0U};
        std::array<std::byte, Message::kSizeMax> octets{};
    };

    void store(Span<const std::byte> message) noexcept override {
        Slot& slot = fifo_.get_write_slot();
        slot.size = message.size();
        __builtin_memcpy(slot.octets.data(), message.data(), message.size());
        static_cast<void>(fifo_.publish());
    }
    std::uint32_t get_overwritten_count() const noexcept override { return fifo_.get_overwritten_count(); }

    FifoBuffer<Slot, kDepth, FullPolicy::kOverwrite, EmptyPolicy::kDoNothing> fifo_;
    bool is_held_{false};
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_MESSAGE_QUEUE_HPP
