// SPDX-License-Identifier: Apache-2.0
/// @file
/// The connection to an LCM network: senders, and a receiving thread of its own that writes into the queues
/// of windows. It is the only part of Mamori that calls liblcm.
///
/// @satisfies SWR-LCM-007, SWR-LCM-010, SWR-LCM-011      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_LCM_LINK_HPP
#define MAMORI_PORTS_LCM_LCM_LINK_HPP

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/lcm/link_fault.hpp"
#include "mamori/ports/lcm/message_queue.hpp"

namespace mamori::ports::lcm {

/// Object of liblcm.
struct LcmHandle;

/// One connection to an LCM network. Without liblcm at build time, open() reports LinkFault::kUnsupported.
///
/// Thread safety: open, receive and close it from one thread. The receiving thread, and those that liblcm
///                starts, have the default priority and touch only the inboxes.
/// Memory:        a stack of 256 KiB, allocated by open(); liblcm allocates at any time, and its own threads
///                have stacks of the default size.
class LcmLink final {
  public:
    static constexpr std::size_t kChannelsMax = 16U;
    static constexpr std::size_t kChannelNameMax = 63U;  ///< characters

    LcmLink() noexcept = default;
    LcmLink(const LcmLink&) = delete;
    LcmLink& operator=(const LcmLink&) = delete;
    ~LcmLink() { close(); }

    /// Adds a channel to receive. Before open().
    /// @param[in] channel not copied; must outlive the link. @param[in] inbox likewise.
    /// @return kOk; kPreconditionNotMet (open); kBadParameter (name; get_fault());
    ///         kOutOfResources (kChannelsMax).
    Status receive(const char* channel, MessageInbox& inbox) noexcept;
    /// Opens the network and starts the receiving thread. @param[in] url of LCM, as
    /// `udpm://239.255.76.67:7667?ttl=0`.
    /// @return kOk; kPreconditionNotMet (open already); kError (get_fault() tells why; nothing is open);
    ///         kUnsupported (built without liblcm).
    Status open(const char* url) noexcept;
    /// Ends the thread and leaves the network; the channels stay.
    void close() noexcept;

    /// Sends one message. From any thread; liblcm waits while the buffer of its socket is full.
    /// @return as MessageSink::send().
    Status publish(const char* channel, Span<const std::byte> message) noexcept;

    bool is_open() const noexcept { return handle_ != nullptr; }
    /// False while closed, and after an error of the network.
    bool is_receiving() const noexcept { return is_receiving_.load(std::memory_order_relaxed); }
    /// Why the last call of receive() or open() failed.
    LinkFault get_fault() const noexcept { return fault_; }

  private:
    struct Channel {
        const char* name;
        MessageInbox* inbox;
    };

    static void* serve(void* link) noexcept;
    LinkFault connect() noexcept;
    void run() noexcept;

    std::array<Channel, kChannelsMax> channels_{};
    std::size_t channel_count_{0U};
    const char* url_{nullptr};
    LcmHandle* handle_{nullptr};
    pthread_t thread_{};
    pthread_barrier_t connected_{};
    std::atomic<bool> is_receiving_{false};
    int stop_{-1};
    LinkFault fault_{LinkFault::kNone};
};

/// Sends the messages of one channel.
///
/// Thread safety: as LcmLink::publish(). Time: as LcmLink::publish(). Memory: none of its own.
class LcmSender final : public MessageSink {
  public:
    /// @param[in] link, channel must outlive this object; the link is open before the first message.
    constexpr LcmSender(LcmLink& link, const char* channel) noexcept : link_(link), channel_(channel) {}

    /// Checks the name of the channel, before the first message. The link may be opened later.
    /// @return kOk, also when open already; kBadParameter (name; get_fault()).
    Status open() noexcept;

    Status send(Span<const std::byte> message) noexcept override;

    /// Why the last open() failed.
    LinkFault get_fault() const noexcept { return fault_; }

  private:
    LcmLink& link_;
    const char* channel_;
    bool is_open_{false};
    LinkFault fault_{LinkFault::kNone};
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_LCM_LINK_HPP
