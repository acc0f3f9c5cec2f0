// SPDX-License-Identifier: Apache-2.0
/// @file
/// Common part of all ports: the name and the link in the port list of the component. A port registers with
/// its component at construction. Therefore, the table check finds a port that `Ports<...>` omits.
///
/// @satisfies SWR-KRN-045      Design: docs/design/kernel.md#ports
#ifndef MAMORI_KERNEL_PORT_BASE_HPP
#define MAMORI_KERNEL_PORT_BASE_HPP

#include "mamori/kernel/component/component.hpp"

namespace mamori {

/// Replaces the owner of a port that belongs to no component, for example in a test of a driver.
struct NoOwner {};
inline constexpr NoOwner kNoOwner{};

/// Thread safety: reading from anywhere. Time: O(1). Memory: no heap.
class PortBase {
  public:
    PortBase(const PortBase&) = delete;
    PortBase& operator=(const PortBase&) = delete;

    /// Name given at construction; static storage, never nullptr.
    constexpr const char* get_name() const noexcept { return name_; }
    /// The port that was constructed with the same component before this one; nullptr: this is the first.
    constexpr const PortBase* get_next() const noexcept { return next_; }

  protected:
    /// @param[in] owner component that has this port as a member; the port must not be destroyed before it.
    /// @param[in] name  static storage, not nullptr.
    constexpr PortBase(PortOwner& owner, const char* name) noexcept : name_(name), next_(owner.first_port_) {
        owner.first_port_ = this;
    }
    constexpr PortBase(NoOwner, const char* name) noexcept : name_(name) {}
    ~PortBase() = default;

  private:
    const char* name_;
    const PortBase* next_{nullptr};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_PORT_BASE_HPP
