// SPDX-License-Identifier: Apache-2.0
/// @file
/// Messages as frames over UDP or a serial line: a sender, and a receiver with a thread of its own that
/// writes into the queue of a window.
///
/// @satisfies SWR-LCM-007, SWR-LCM-009, SWR-LCM-010      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_FRAME_LINK_HPP
#define MAMORI_PORTS_LCM_FRAME_LINK_HPP

#include <pthread.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/lcm/byte_frame.hpp"
#include "mamori/ports/lcm/link_fault.hpp"
#include "mamori/ports/lcm/message_queue.hpp"

namespace mamori::ports::lcm {

namespace detail {
/// As first base class it exists longer than the sender or receiver that uses it.
template <std::size_t kSize>
struct FrameStorage {
    std::array<std::byte, kSize> octets{};
};
}  // namespace detail

/// Sends frames. Use FrameSenderFor, which has the storage.
///
/// Thread safety: none; open and close it outside of windows. Time: send() O(size), and a system call that
/// does not wait. Memory: the storage; no heap.
class FrameSender : public MessageSink {
  public:
    FrameSender(const FrameSender&) = delete;
    FrameSender& operator=(const FrameSender&) = delete;

    /// Sends each frame as one datagram. @param[in] address of the receiver, IPv4 in digits.
    /// @return kOk; kPreconditionNotMet (open already); kError (get_fault() tells why).
    Status open_udp(const char* address, std::uint16_t port) noexcept;
    /// Writes frames to a serial device: 8 bits, no parity, 1 stop bit, no flow control.
    /// @param[in] speed 9600 .. 921600 [bit/s].
    /// @return as open_udp().
    Status open_serial(const char* path, std::uint32_t speed) noexcept;
    void close() noexcept;

    Status send(Span<const std::byte> message) noexcept override;

    /// Why the last open failed.
    LinkFault get_fault() const noexcept { return fault_; }

  protected:
    /// @param[in] storage for the longest frame.
    constexpr explicit FrameSender(Span<std::byte> storage) noexcept : storage_(storage) {}
    ~FrameSender() { close(); }

  private:
    Span<std::byte> storage_;
    int file_{-1};
    LinkFault fault_{LinkFault::kNone};
};

/// FrameSender for messages of one type. @tparam Message LcmMessage.
template <typename Message>
class FrameSenderFor final : private detail::FrameStorage<calc_frame_size_max(Message::kSizeMax)>,
                             public FrameSender {
  public:
    constexpr FrameSenderFor() noexcept : FrameSender({this->octets.data(), this->octets.size()}) {}
};

/// Receives frames. Use FrameReceiverFor, which has the storage.
///
/// Thread safety: open and close it from one thread. The receiving thread has the default priority and
///                touches only the inbox.
/// Memory:        the storage and the stack of the thread, 256 KiB, allocated by the open call; no heap.
class FrameReceiver {
  public:
    FrameReceiver(const FrameReceiver&) = delete;
    FrameReceiver& operator=(const FrameReceiver&) = delete;

    /// Receives the datagrams that arrive at an address and port of this host.
    /// @param[in] port 0: a free one, see get_port().
    /// @return as FrameSender::open_udp().
    Status open_udp(const char* address, std::uint16_t port) noexcept;
    /// Reads a serial device, without the octets that arrived before. @return as FrameSender::open_serial().
    Status open_serial(const char* path, std::uint32_t speed) noexcept;
    /// Ends the thread. The queue keeps its messages.
    void close() noexcept;

    /// False while closed, and after an error of the device, for example an unplugged adapter.
    bool is_receiving() const noexcept { return is_receiving_.load(std::memory_order_relaxed); }
    /// UDP port on which it receives; 0 while it receives none.
    std::uint16_t get_port() const noexcept { return port_; }
    LinkFault get_fault() const noexcept { return fault_; }

  protected:
    static constexpr std::size_t kChunk = 2048U;  ///< octets of one read

    /// @param[in] storage for the longest message and its checksum.
    FrameReceiver(MessageInbox& inbox, Span<std::byte> storage) noexcept : inbox_(inbox), decoder_(storage) {}
    ~FrameReceiver() { close(); }

  private:
    static void* serve(void* receiver) noexcept;
    Status start() noexcept;
    void receive() noexcept;

    MessageInbox& inbox_;
    FrameDecoder decoder_;
    std::array<std::byte, kChunk> chunk_{};
    std::atomic<bool> is_receiving_{false};
    pthread_t thread_{};
    int file_{-1};
    int stop_{-1};
    std::uint16_t port_{0U};
    LinkFault fault_{LinkFault::kNone};
};

/// FrameReceiver for messages of one type. @tparam Message LcmMessage; one frame fits into a datagram.
template <typename Message>
class FrameReceiverFor final : private detail::FrameStorage<Message::kSizeMax + kFrameChecksumSize>,
                               public FrameReceiver {
    static_assert(calc_frame_size_max(Message::kSizeMax) <= kChunk,
                  "a datagram has at most 2048 octets: send larger messages over LCM");

  public:
    explicit FrameReceiverFor(MessageInbox& inbox) noexcept
        : FrameReceiver(inbox, {this->octets.data(), this->octets.size()}) {}
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_FRAME_LINK_HPP
