// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an execution context calls of a state machine. Virtual, so that a table without state machines does
/// not link their code. Not for users.
///
/// @satisfies SWR-KRN-071      Design: docs/design/kernel.md#parts-that-a-table-does-not-use
#ifndef MAMORI_KERNEL_EVENT_SERVER_HPP
#define MAMORI_KERNEL_EVENT_SERVER_HPP

#include <atomic>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/component/component.hpp"

namespace mamori {

class ExecutionContext;

/// Thread safety: get_context_id() from anywhere; the rest from the core that runs the component.
class EventServer {
  public:
    EventServer(const EventServer&) = delete;
    EventServer& operator=(const EventServer&) = delete;

    /// Id of the context that processes the events; -1: none. From any thread or interrupt.
    std::int32_t get_context_id() const noexcept { return context_id_.load(std::memory_order_relaxed); }

    void set_context_id(std::int32_t id) noexcept { context_id_.store(id, std::memory_order_relaxed); }

    /// Whether its table and profile suit the context, whose participants are known.
    /// @return kOk; kBadParameter (the table violates a rule, or the profile names a component outside the
    ///         context or an unknown element).
    virtual Status check_for(const ExecutionContext& context) const noexcept = 0;
    /// Resets to the initial state with an empty queue.
    virtual void restart() noexcept = 0;
    /// Processes waiting events, in a cycle of the context.
    virtual void serve(ExecutionContext& context, Component& component, ContextHandle handle) noexcept = 0;

  protected:
    constexpr EventServer() noexcept = default;
    ~EventServer() = default;

  private:
    /// Id of the context that the component is attached to, for senders on other threads.
    std::atomic<std::int32_t> context_id_{-1};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_EVENT_SERVER_HPP
