// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sensors and actuators around a system. A simulated plant and real devices implement the same interface, so
/// a program attaches them in the same way in virtual and in real time.
///
/// @satisfies SWR-KRN-073      Design: docs/design/kernel.md#machine
#ifndef MAMORI_KERNEL_DEVICES_HPP
#define MAMORI_KERNEL_DEVICES_HPP

#include <cstdint>

#include "mamori/kernel/base/time.hpp"

namespace mamori {

/// A machine calls both functions once per major frame, outside each window and its budget.
///
/// Calling context: the context that runs the windows of the first core, the lowest one with a window.
///                  Functions must not block. They may access components of the first core, and components of
///                  other cores only in virtual time.
class Devices {
  public:
    /// Called before the first window of the major frame, in real time of the first core: read sensors, apply
    /// faults that are due.
    /// @param[in] frame number of the major frame, 0, 1, ... @param[in] start its planned start.
    virtual void sample(std::uint64_t frame, Instant start) noexcept {
        static_cast<void>(frame);
        static_cast<void>(start);
    }
    /// Called after the last window of the major frame, in real time of the first core: forward outputs,
    /// advance a simulated plant.
    /// @param[in] length of the major frame.
    virtual void apply(std::uint64_t frame, Instant start, Duration length) noexcept {
        static_cast<void>(frame);
        static_cast<void>(start);
        static_cast<void>(length);
    }

  protected:
    ~Devices() = default;
};

/// Devices of a system without any.
class NoDevices final : public Devices {};

/// Devices that only call a function after each major frame, for example one that prints:
///
///     machine.run(20U, [](std::uint64_t frame) { ... });
///
/// @tparam Action callable with the number of the major frame.
template <typename Action>
class AfterFrame final : public Devices {
  public:
    /// @param[in] action must outlive this object.
    constexpr explicit AfterFrame(Action& action) noexcept : action_(action) {}
    void apply(std::uint64_t frame, Instant, Duration) noexcept override { action_(frame); }

  private:
    Action& action_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_DEVICES_HPP
