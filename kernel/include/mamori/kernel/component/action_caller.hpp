// SPDX-License-Identifier: Apache-2.0
/// @file
/// Interface through which actions outside windows are called, so that a guard can limit their time.
///
/// @satisfies SWR-KRN-090      Design: docs/design/kernel.md#actions-outside-windows
#ifndef MAMORI_KERNEL_ACTION_CALLER_HPP
#define MAMORI_KERNEL_ACTION_CALLER_HPP

#include "mamori/kernel/component/action_failure.hpp"
#include "mamori/kernel/component/window_host.hpp"

namespace mamori {

/// Calling context: that of the operation which calls the actions; no window of the core runs meanwhile.
class ActionCaller {
  public:
    /// Calls one action of one component.
    /// @param[in] work   of one step, complete except for `component`; as for WindowHost::run_within().
    /// @param[in] action called by `work`.
    /// @return true: the work has returned. False: it has not returned in time; the context of its window is
    ///         abandoned.
    virtual bool call(const WindowHost::Work& work, ComponentAction action) noexcept = 0;

  protected:
    ~ActionCaller() = default;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_ACTION_CALLER_HPP
