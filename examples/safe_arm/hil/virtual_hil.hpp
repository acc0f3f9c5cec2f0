// SPDX-License-Identifier: Apache-2.0
/// @file
/// Plant, kernel and controller in one process and in virtual time, with the messages, receivers and injected
/// errors of the three processes: the reference for their verdicts.
///
/// @satisfies SWR-HIL-006      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_VIRTUAL_HIL_HPP
#define EXAMPLES_SAFE_ARM_HIL_VIRTUAL_HIL_HPP

#include "hil_ends.hpp"
#include "hil_system.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"

namespace safe_arm {

/// Transport without loss or delay.
class DirectSink final : public mamori::ports::lcm::MessageSink {
  public:
    /// @param[in] inbox must outlive this object.
    explicit DirectSink(mamori::ports::lcm::MessageInbox& inbox) noexcept : inbox_(inbox) {}
    mamori::Status send(mamori::Span<const std::byte> message) noexcept override {
        inbox_.put(message);
        return mamori::Status::kOk;
    }

  private:
    mamori::ports::lcm::MessageInbox& inbox_;
};

/// Devices of a virtual machine of kHilSystem. One per process, since the kernel starts from the constants of
/// the program.
class VirtualHil final : public mamori::Devices {
  public:
    /// @param[in] fault with `at` on the time line. All references must outlive this object.
    VirtualHil(HilPlant& plant, HilController& controller, mamori::ports::virtual_time::VirtualHost& host,
               const mamori::sim::FaultPlan& fault, const LinkErrorPlan& error);

    void sample(std::uint64_t frame, mamori::Instant now) noexcept override;
    void apply(std::uint64_t frame, mamori::Instant now, mamori::Duration length) noexcept override;

    const PlantEnd& get_plant_end() const noexcept { return plant_end_; }
    const ControllerEnd& get_controller_end() const noexcept { return controller_end_; }

  private:
    /// The input of the controller arrives, and it replies at once.
    class ReplySink final : public mamori::ports::lcm::MessageSink {
      public:
        explicit ReplySink(VirtualHil& owner) noexcept : owner_(owner) {}
        mamori::Status send(mamori::Span<const std::byte> message) noexcept override {
            owner_.state_queue_.put(message);
            reply(owner_.controller_, owner_.controller_end_, owner_.fault_, owner_.now_);
            return mamori::Status::kOk;
        }

      private:
        VirtualHil& owner_;
    };

    HilPlant& plant_;
    HilController& controller_;
    mamori::ports::virtual_time::VirtualHost& host_;
    mamori::sim::FaultPlan fault_;
    mamori::Instant now_{};
    mamori::Duration silence_{};
    DriveQueue drive_queue_{};
    StateQueue state_queue_{};
    DirectSink to_plant_{drive_queue_};
    ReplySink to_controller_{*this};
    DirectSink to_kernel_devices_{hil::device_queue};
    DirectSink to_kernel_commands_{hil::command_queue};
    FaultySink device_sink_{Link::kDevice, kDeviceE2e};
    FaultySink command_sink_{Link::kCommand, kCommandE2e};
    PlantEnd plant_end_{drive_queue_, device_sink_};
    ControllerEnd controller_end_{state_queue_, command_sink_};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_VIRTUAL_HIL_HPP
