// SPDX-License-Identifier: Apache-2.0
/// @file
/// The kernel in virtual time, with the messages of a recorded run: `hil_kernel --replay LOG`.
///
/// @satisfies SWR-HIL-015      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_REPLAY_HPP
#define EXAMPLES_SAFE_ARM_HIL_REPLAY_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "hil_system.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/ports/lcm/log_player.hpp"
#include "virtual_hil.hpp"

namespace safe_arm {

/// Feeds the messages of plant and controller at their recorded instants, and compares each message to the
/// plant with the recorded one.
///
/// Thread safety: none. One per process, since the kernel starts from the constants of the program.
class Replay final : public mamori::Devices {
  public:
    Replay() = default;

    /// Before the run. Major frame 0 of the log is found by the frame number of its first DriveFrame.
    /// @return empty on success, else one line with the reason.
    std::string open(const std::string& log);

    void sample(std::uint64_t frame, mamori::Instant now) noexcept override;

    /// Messages to the plant; those with the recorded outputs; the first frame with other ones.
    std::uint64_t get_sent_count() const noexcept { return sent_count_; }
    std::uint64_t get_equal_count() const noexcept { return equal_count_; }
    std::optional<std::uint32_t> get_first_difference() const noexcept { return first_difference_; }
    /// Of all messages to the plant: the same log gives the same hash.
    std::uint64_t get_hash() const noexcept { return hash_.get(); }

  private:
    /// A message to the controller is not sent; the reply that was recorded arrives before the next window.
    class StateSink final : public mamori::ports::lcm::MessageSink {
      public:
        explicit StateSink(Replay& owner) noexcept : owner_(owner) {}
        mamori::Status send(mamori::Span<const std::byte> message) noexcept override;

      private:
        Replay& owner_;
    };
    /// A message to the plant is compared with the recorded one.
    class DriveSink final : public mamori::ports::lcm::MessageSink {
      public:
        explicit DriveSink(Replay& owner) noexcept : owner_(owner) {}
        mamori::Status send(mamori::Span<const std::byte> message) noexcept override;

      private:
        Replay& owner_;
    };
    /// FNV-1a.
    class Hash final {
      public:
        void add(mamori::Span<const std::byte> octets) noexcept;
        std::uint64_t get() const noexcept { return value_; }

      private:
        std::uint64_t value_{0xCBF29CE484222325U};
    };

    void deliver(mamori::Duration into_frame) noexcept;
    void compare(const DriveFrame& recorded) noexcept;

    mamori::ports::lcm::LogPlayer player_{};
    DriveQueue recorded_queue_{};
    DriveQueue replayed_queue_{};
    FaultySink no_sink_{Link::kDevice, kDeviceE2e};
    PlantEnd recorded_{recorded_queue_, no_sink_};
    PlantEnd replayed_{replayed_queue_, no_sink_};
    StateSink state_sink_{*this};
    DriveSink drive_sink_{*this};
    mamori::Instant start_{};  ///< of major frame 0, on the time line of the log
    mamori::Instant now_{};
    Hash hash_{};
    std::uint64_t sent_count_{0U};
    std::uint64_t equal_count_{0U};
    std::optional<std::uint32_t> first_difference_{};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_REPLAY_HPP
