// SPDX-License-Identifier: Apache-2.0
/// @file
/// Turns the process image of the arm into physical units, evaluates the operator panel, and requests the
/// mode that its selector shows. First component of the protecting window.
///
/// @satisfies SWR-SAF-004, SWR-SAF-061      Design: docs/design/safe_arm.md#components
#ifndef EXAMPLES_SAFE_ARM_ARM_READER_HPP
#define EXAMPLES_SAFE_ARM_ARM_READER_HPP

#include "mamori/kernel/run/system_modes.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/arm/arm_device.hpp"
#include "messages.hpp"
#include "operator_panel.hpp"

namespace safe_arm {

/// Resolution of the encoders [counts per rad of the joint].
struct EncoderScale {
    JointVector a_counts_per_rad{};
    JointVector b_counts_per_rad{};
};

class ArmReader final : public mamori::Component {
  public:
    /// @param[in] inputs image that the device layer fills before each frame; static storage.
    constexpr explicit ArmReader(const mamori::safety::ArmInputs& inputs) noexcept
        : Component("arm_reader"), inputs_(inputs) {}

    mamori::OutPort<JointReading> reading{*this, "reading"};
    using Ports = mamori::Ports<&ArmReader::reading>;

    /// @return kOk; kBadParameter (a resolution that is not positive: nothing is taken over).
    mamori::Status configure(const EncoderScale& scale) noexcept;

    /// Before the start. @param[in] modes of the table that runs this component; static storage.
    void set_modes(mamori::SystemModes& modes) noexcept { modes_ = &modes; }

    /// @return kOk; kPreconditionNotMet (not configured, or without modes), which keeps the system from
    /// starting.
    mamori::Status on_activated(mamori::ContextHandle context) noexcept override;
    mamori::Status on_execute(mamori::ContextHandle context) noexcept override;

  private:
    const mamori::safety::ArmInputs& inputs_;
    EncoderScale scale_{};
    OperatorPanel panel_{};
    mamori::SystemModes* modes_{nullptr};
    OperatingMode requested_{OperatingMode::kHoldToRun};  ///< accepted by `modes_`
    bool is_configured_{false};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_ARM_READER_HPP
