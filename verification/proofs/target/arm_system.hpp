// SPDX-License-Identifier: Apache-2.0
/// @file
/// A small but complete system: the protective components of the safe arm, a controller that holds the arm,
/// the channel between them, and simple devices. It needs no plant and no heap, and thus runs on a bare
/// controller.
///
/// @satisfies SWR-PRF-024      Design: docs/design/proofs.md#watermark
#ifndef VERIFICATION_PROOFS_TARGET_ARM_SYSTEM_HPP
#define VERIFICATION_PROOFS_TARGET_ARM_SYSTEM_HPP

#include <cstdint>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"

namespace proof {

/// Runs the static table, which is in arm_system.cpp.
extern mamori::Executive& executive;
/// Simulates the table; only the controller takes time.
extern mamori::ports::virtual_time::VirtualHost& virtual_host;

/// Creates all objects that must exist before the executive is initialised.
/// @return kOk; otherwise the status of the component or the supervision that rejected its setup.
mamori::Status prepare() noexcept;

/// Devices that follow immediately, an operator who starts and resets, and two faults in sequence: an encoder
/// jump, then a hang of the controller.
class ObedientDevices final : public mamori::Devices {
  public:
    explicit ObedientDevices(mamori::ports::virtual_time::VirtualHost& host) noexcept : host_(host) {}

    void sample(std::uint64_t frame, mamori::Instant now) noexcept override;
    void apply(std::uint64_t frame, mamori::Instant now, mamori::Duration length) noexcept override;

  private:
    mamori::ports::virtual_time::VirtualHost& host_;
};

/// Results of the run.
struct Facts {
    std::uint32_t latched_count{0U};       ///< events of a latched fault
    std::uint32_t operational_frames{0U};  ///< frames with torque on
};
Facts get_facts() noexcept;

}  // namespace proof

#endif  // VERIFICATION_PROOFS_TARGET_ARM_SYSTEM_HPP
