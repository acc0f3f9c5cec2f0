// SPDX-License-Identifier: Apache-2.0
/// @file
/// Replays the log of an LCM network (lcm-logger) into the queues of windows, at the instants of the caller:
/// in virtual time, a replay gives the same outputs each time. Needs no liblcm.
///
/// @satisfies SWR-LCM-010, SWR-LCM-012      Design: docs/design/lcm.md#transports
/// Source:   LCM documentation, "LCM Log File format"
#ifndef MAMORI_PORTS_LCM_LOG_PLAYER_HPP
#define MAMORI_PORTS_LCM_LOG_PLAYER_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/ports/lcm/link_fault.hpp"
#include "mamori/ports/lcm/message_queue.hpp"

namespace mamori::ports::lcm {

/// Reads one log from begin to end. The first event is at Instant 0.
///
/// Thread safety: none; call it between windows, since it reads a file. Time: O(octets of the events).
/// Memory:        one event; no heap.
class LogPlayer final {
  public:
    static constexpr std::size_t kChannelsMax = 16U;
    static constexpr std::size_t kChannelNameMax = 63U;  ///< characters
    static constexpr std::size_t kMessageMax = 65536U;   ///< a longer message is counted as oversized [byte]

    LogPlayer() noexcept = default;
    LogPlayer(const LogPlayer&) = delete;
    LogPlayer& operator=(const LogPlayer&) = delete;
    ~LogPlayer() { close(); }

    /// Adds a channel; events of other channels are skipped.
    /// @param[in] channel, inbox must outlive the player.
    /// @return kOk; kBadParameter (name; get_fault()); kOutOfResources (kChannelsMax; get_fault()).
    Status receive(const char* channel, MessageInbox& inbox) noexcept;
    /// Opens a log and reads its first event.
    /// @return kOk; kPreconditionNotMet (open already); kError (cannot be read, or does not begin with an
    ///         event of LCM).
    Status open(const char* path) noexcept;
    void close() noexcept;

    /// Delivers the events up to and including `now`. An event that is earlier than the one before it is
    /// delivered with that one.
    /// @return kOk; kPreconditionNotMet (the log has ended, all events are delivered);
    ///         kError (the log is damaged at get_offset(); the events before it are delivered).
    Status deliver_until(Instant now) noexcept;

    /// Events that were delivered or skipped.
    std::uint64_t get_event_count() const noexcept { return event_count_; }
    /// Where the event begins that is read next or cannot be read [byte].
    std::uint64_t get_offset() const noexcept { return offset_; }
    /// Why the last call of receive() failed.
    LinkFault get_fault() const noexcept { return fault_; }

  private:
    struct Channel {
        const char* name;
        MessageInbox* inbox;
    };
    enum class State : std::uint8_t { kPending, kEnd, kDamaged };

    State read_event() noexcept;
    void deliver() noexcept;

    std::array<Channel, kChannelsMax> channels_{};
    std::size_t channel_count_{0U};
    std::array<char, kChannelNameMax + 1U> name_{};  ///< of the pending event
    std::array<std::byte, kMessageMax> message_{};
    std::size_t size_{0U};  ///< of the message in the log, also above kMessageMax
    std::int64_t first_us_{0};
    std::int64_t due_us_{0};  ///< of the pending event, relative to the first
    std::uint64_t offset_{0U};
    std::uint64_t end_{0U};  ///< of the pending event
    std::uint64_t event_count_{0U};
    int file_{-1};
    State state_{State::kEnd};
    LinkFault fault_{LinkFault::kNone};
};

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_LOG_PLAYER_HPP
