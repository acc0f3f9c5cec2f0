// SPDX-License-Identifier: Apache-2.0
/// @file
/// Components that connect the safety components of the arm to its plant and controller in other processes.
///
/// @satisfies SWR-HIL-002      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_COMPONENTS_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_COMPONENTS_HPP

#include <atomic>
#include <cstdint>

#include "hil_messages.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/simbody_sim/fault_plan.hpp"
#include "safety_supervisor.hpp"

namespace safe_arm {

/// Copies the newest answer of the plant into the process image.
class DeviceImage final : public mamori::Component {
  public:
    /// @param[in,out] image must have static storage.
    constexpr explicit DeviceImage(mamori::safety::ArmInputs& image) noexcept
        : Component("device_image"), image_(image) {}

    mamori::InPort<DeviceFrame> device{*this, "device"};
    using Ports = mamori::Ports<&DeviceImage::device>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    mamori::safety::ArmInputs& image_;
};

/// Forwards a reading while the answer of the plant that it was made of is not older than kDeviceAgeMax.
/// Without a reading, the supervisor latches kMeasurementStale.
class ReadingFilter final : public mamori::Component {
  public:
    constexpr ReadingFilter() noexcept : Component("reading_filter") {}

    mamori::InPort<DeviceFrame> device{*this, "device"};
    mamori::InPort<JointReading> in{*this, "in"};
    mamori::OutPort<JointReading> out{*this, "out"};
    using Ports = mamori::Ports<&ReadingFilter::device, &ReadingFilter::in, &ReadingFilter::out>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;
};

/// Hangs in place of the supervisor while the fault supervisor_hang is active: the window exceeds its budget
/// before the supervisor runs.
class HangPoint final : public mamori::Component {
  public:
    constexpr HangPoint() noexcept : Component("hang_point") {}
    using Ports = mamori::Ports<>;

    /// Before the start. @param[in] fault with `at` on the time line of the kernel.
    void configure(const mamori::sim::FaultPlan& fault) noexcept { fault_ = fault; }
    /// Lets a hanging cycle return, at the end of a run. From any thread.
    void release() noexcept { is_released_.store(true); }

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    mamori::sim::FaultPlan fault_{};
    std::atomic<bool> is_released_{false};
};

/// Makes the input of the controller.
class ControllerView final : public mamori::Component {
  public:
    constexpr ControllerView() noexcept : Component("controller_view") {}

    mamori::InPort<JointState> state{*this, "state"};
    mamori::InPort<StopCommand> stop{*this, "stop"};
    mamori::OutPort<ControllerInput> out{*this, "out"};
    using Ports = mamori::Ports<&ControllerView::state, &ControllerView::stop, &ControllerView::out>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;
};

/// Watchdog behind a link: counts the services for the plant, whose hardware expires without them.
class LinkWatchdog final : public mamori::safety::Watchdog {
  public:
    /// @param[in,out] mirror expires when the hardware does; must have static storage.
    constexpr explicit LinkWatchdog(mamori::ports::virtual_time::VirtualWatchdog& mirror) noexcept
        : mirror_(mirror) {}

    /// @return that of VirtualWatchdog::service(); a rejected service is not counted.
    mamori::Status service(mamori::Instant now) noexcept override;
    std::uint32_t get_service_count() const noexcept { return service_count_; }

  private:
    mamori::ports::virtual_time::VirtualWatchdog& mirror_;
    std::uint32_t service_count_{0U};
};

/// Makes the message to the plant of the outputs that the drive gate wrote.
class DriveEncoder final : public mamori::Component {
  public:
    /// All must have static storage. @param[in] supervisor, safety of the same table, for the report.
    constexpr DriveEncoder(const mamori::safety::ArmOutputs& outputs, const LinkWatchdog& watchdog,
                           const SafetySupervisor& supervisor,
                           const mamori::safety::SafetyState& safety) noexcept
        : Component("drive_encoder"),
          outputs_(outputs),
          watchdog_(watchdog),
          supervisor_(supervisor),
          safety_(safety) {}

    mamori::InPort<StopCommand> stop{*this, "stop"};
    mamori::InPort<TorqueCommand> command{*this, "command"};
    mamori::OutPort<DriveFrame> out{*this, "out"};
    using Ports = mamori::Ports<&DriveEncoder::stop, &DriveEncoder::command, &DriveEncoder::out>;

    /// From now on the outputs are safe. Async-signal-safe, for MachineOptions::outputs.
    void close() noexcept { is_closed_.store(true); }

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    const mamori::safety::ArmOutputs& outputs_;
    const LinkWatchdog& watchdog_;
    const SafetySupervisor& supervisor_;
    const mamori::safety::SafetyState& safety_;
    std::atomic<bool> is_closed_{false};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_COMPONENTS_HPP
