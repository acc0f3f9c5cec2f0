// SPDX-License-Identifier: Apache-2.0
/// @file
/// Marks an execution context as busy with an action of one participant during the lifetime of the object.
#ifndef MAMORI_KERNEL_SRC_ACTION_SCOPE_HPP
#define MAMORI_KERNEL_SRC_ACTION_SCOPE_HPP

#include "mamori/kernel/component/execution_context.hpp"

namespace mamori {

/// Thread safety: as the context. Time: O(1). Memory: one word.
class ExecutionContext::ActionScope final {
  public:
    ActionScope(ExecutionContext& context, std::size_t position) noexcept : context_(context) {
        context.move_to(position);
    }
    /// Last, with release order: a thread that finds the context idle sees all effects of the actions.
    ~ActionScope() { context_.acting_position_.store(kNoPosition, std::memory_order_release); }
    ActionScope(const ActionScope&) = delete;
    ActionScope& operator=(const ActionScope&) = delete;

  private:
    ExecutionContext& context_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_SRC_ACTION_SCOPE_HPP
