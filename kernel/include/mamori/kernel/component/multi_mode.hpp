// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component with modes: a fixed set of named objects, one of which is current. A change waits for the
/// component's next turn, or is committed at once when it cannot wait (fail-safe).
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

/// One way of working. Its identity is its address.
struct Mode {
    const char* name;  ///< static storage, not nullptr
};

/// The modes of one component, and how far a change has come.
///
/// Thread safety: none. Time: O(modes). Memory: no heap; the modes must outlive it.
class ModeSwitch final {
  public:
    /// @param[in] modes at least one and none of them nullptr, else an own bug.
    constexpr explicit ModeSwitch(Span<const Mode* const> modes) noexcept
        : modes_(modes), current_(modes[0U]), told_(modes[0U]) {}

    const Mode& get_default() const noexcept { return *modes_[0U]; }
    /// @return never nullptr.
    const Mode* get_current() const noexcept { return current_; }
    /// @return nullptr: no change waits.
    const Mode* get_pending() const noexcept { return pending_; }
    /// Is it one of them?
    bool has(const Mode& mode) const noexcept;

    /// Wishes for a mode, which take_change() commits; the current one takes an earlier wish back.
    void wish(const Mode& mode) noexcept { pending_ = &mode == current_ ? nullptr : &mode; }
    /// Commits a pending mode. @return true when it differs from the one that the component was told last.
    bool take_change() noexcept;
    /// Commits a mode now; whether the component must be told is left to take_change(). @param[in] mode one
    /// of its own, which is not checked, here as in wish(): see has().
    void commit(const Mode& mode) noexcept;

  private:
    Span<const Mode* const> modes_;
    const Mode* current_;
    const Mode* told_;
    const Mode* pending_{nullptr};
};

/// Component that switches between the modes it was built with.
///
/// A mode that is set with `immediate` false is pending until the next cycle of the component's context,
/// where it becomes current and on_mode_changed is called before on_execute; the states of the component do
/// not matter for that. With `immediate` true it is current when set_mode() returns; on_mode_changed is
/// called at once too, or, while the context is busy or the component not alive, in its next turn, since
/// actions are never reentrant. A mode stays set when on_mode_changed fails; see
/// docs/design/rtc_semantics.md#failures.
///
/// Thread safety: none; call from the core that runs the component.
/// Time:          O(modes), and that of on_mode_changed. Memory: no heap.
class MultiModeComponent : public Component {
  public:
    /// @return the first of its modes.
    const Mode& get_default_mode() const noexcept { return switch_.get_default(); }
    /// @return the last mode that was committed; at first the default one.
    const Mode& get_current_mode() const noexcept { return *switch_.get_current(); }
    /// The same, since a component has one context.
    /// @return nullptr when it does not participate in `context`.
    const Mode* get_current_mode_in_context(const ExecutionContext& context) const noexcept;
    /// @return the mode that was set last and is not committed yet; nullptr when there is none.
    const Mode* get_pending_mode() const noexcept { return switch_.get_pending(); }
    /// The same. @return nullptr also when it does not participate in `context`.
    const Mode* get_pending_mode_in_context(const ExecutionContext& context) const noexcept;

    /// Sets a mode. The current one takes a pending one back; what changes back before on_mode_changed was
    /// called is not told. Without a context every change is committed at once and not told.
    /// @param[in] mode      one of those that the component was built with.
    /// @param[in] immediate commit without waiting for the next cycle.
    /// @param[in] now       instant given to on_mode_changed when it is called at once.
    /// @return kOk; kBadParameter (a foreign mode); else the code of on_mode_changed: the mode is set anyway.
    Status set_mode(const Mode& mode, bool immediate, Instant now) noexcept;

  protected:
    /// @param[in] name  instance name; must have static storage and not be nullptr.
    /// @param[in] modes at least one and none of them nullptr, else an own bug; must outlive the component.
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
