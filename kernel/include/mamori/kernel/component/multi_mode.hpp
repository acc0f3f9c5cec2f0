// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component with modes: a fixed set of named objects, one of which is current. A mode change takes effect
/// in the next invocation of the component, or immediately when it cannot wait (fail-safe).
///
/// @satisfies SWR-RTC-007      Design: docs/design/rtc_semantics.md#modes
/// Source:   OMG RTC 1.0, Mode, ModeCapable, MultiModeComponentAction
#ifndef MAMORI_KERNEL_MULTI_MODE_HPP
#define MAMORI_KERNEL_MULTI_MODE_HPP

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"

namespace mamori {

class ExecutionContext;

/// One operating mode. Its address is its identity.
struct Mode {
    const char* name;  ///< static storage, not nullptr
};

/// The modes of one component, and the state of a mode change.
///
/// Thread safety: none. Time: O(modes). Memory: no heap; the modes must outlive it.
class ModeSwitch final {
  public:
    /// @param[in] modes at least one and none nullptr; otherwise a contract violation.
    constexpr explicit ModeSwitch(Span<const Mode* const> modes) noexcept
        : modes_(modes), current_(modes[0U]), told_(modes[0U]) {}

    const Mode& get_default() const noexcept { return *modes_[0U]; }
    /// @return current mode, never nullptr.
    const Mode* get_current() const noexcept { return current_; }
    /// @return pending mode; nullptr: no change is pending.
    const Mode* get_pending() const noexcept { return pending_; }
    /// True when `mode` is one of the modes.
    bool has(const Mode& mode) const noexcept;

    /// Requests a mode, which take_change() commits. Requesting the current mode cancels a pending request.
    void wish(const Mode& mode) noexcept { pending_ = &mode == current_ ? nullptr : &mode; }
    /// Commits a pending mode. @return true when the current mode differs from the last reported mode.
    bool take_change() noexcept;
    /// Commits a mode immediately; take_change() reports whether to notify the component.
    /// @param[in] mode one of the modes; neither commit() nor wish() checks it: see has().
    void commit(const Mode& mode) noexcept;

  private:
    Span<const Mode* const> modes_;
    const Mode* current_;
    const Mode* told_;
    const Mode* pending_{nullptr};
};

/// Component that switches between the modes given at construction.
///
/// A mode that is set with `immediate` false is pending until the next cycle of the component's context.
/// There it becomes current, and on_mode_changed is called before on_execute, in every state in which the
/// component is alive. With `immediate` true, the mode is current when set_mode() returns, and
/// on_mode_changed is called immediately. While the context is busy or the component is not alive,
/// on_mode_changed is called in the next invocation instead, because actions are never reentrant. A mode
/// remains set when on_mode_changed fails; see docs/design/rtc_semantics.md#failures.
///
/// Thread safety: none; call from the core that runs the component.
/// Time:          O(modes), plus on_mode_changed. Memory: no heap.
class MultiModeComponent : public Component {
  public:
    /// @return the first of the modes.
    const Mode& get_default_mode() const noexcept { return switch_.get_default(); }
    /// @return the last committed mode; initially the default mode.
    const Mode& get_current_mode() const noexcept { return *switch_.get_current(); }
    /// Same as get_current_mode(), because a component has one context.
    /// @return nullptr when the component does not participate in `context`.
    const Mode* get_current_mode_in_context(const ExecutionContext& context) const noexcept;
    /// @return the mode that was set last and is not committed yet; nullptr when there is none.
    const Mode* get_pending_mode() const noexcept { return switch_.get_pending(); }
    /// Same as get_pending_mode(). @return nullptr also when the component does not participate in `context`.
    const Mode* get_pending_mode_in_context(const ExecutionContext& context) const noexcept;

    /// Sets a mode. Setting the current mode cancels a pending mode. A change that is reversed before
    /// on_mode_changed is called is not reported. Without a context, every change is committed immediately
    /// and not reported.
    /// @param[in] mode      one of the modes given at construction.
    /// @param[in] immediate true: commit without waiting for the next cycle.
    /// @param[in] now       instant passed to on_mode_changed when it is called immediately.
    /// @return kOk; kBadParameter (unknown mode); otherwise the code of on_mode_changed; the mode is set
    ///         nevertheless.
    Status set_mode(const Mode& mode, bool immediate, Instant now) noexcept;

  protected:
    /// @param[in] name  instance name; static storage, not nullptr.
    /// @param[in] modes at least one and none nullptr; otherwise a contract violation; must outlive the
    ///                  component.
    constexpr MultiModeComponent(const char* name, Span<const Mode* const> modes) noexcept
        : Component(name), switch_(modes) {
        mode_switch_ = &switch_;
    }
    ~MultiModeComponent() = default;

  private:
    ModeSwitch switch_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_MULTI_MODE_HPP
