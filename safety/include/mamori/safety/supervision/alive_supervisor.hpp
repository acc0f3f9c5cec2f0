// SPDX-License-Identifier: Apache-2.0
/// @file
/// Alive supervision: counts the supervision cycles in which an entity stayed silent and judges each against
/// its limits. An expired entity stays expired until somebody acknowledges it deliberately.
///
/// @satisfies SWR-SUP-001, SWR-SUP-002      Design: docs/design/supervision.md#alive-supervision
/// Source:   IEC 61508-2:2010 Table A.10 (monitoring of program sequence)
#ifndef MAMORI_SAFETY_ALIVE_SUPERVISOR_HPP
#define MAMORI_SAFETY_ALIVE_SUPERVISOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"

namespace mamori::safety {

/// Silence limits of one entity. Unit: supervision cycles. Range: 1 <= late <= expired.
struct AliveLimits {
    std::uint32_t late_cycles{0U};     ///< so many silent cycles in a row are late
    std::uint32_t expired_cycles{0U};  ///< so many silent cycles in a row are the end
};

/// True when the limits are inside their range.
constexpr bool is_valid(AliveLimits limits) noexcept {
    return limits.late_cycles >= 1U && limits.late_cycles <= limits.expired_cycles;
}

/// Judgement of one entity or of all of them; ordered, the worst is the largest.
enum class AliveVerdict : std::uint8_t { kHealthy, kLate, kExpired };

/// Storage of one supervised entity. Written by AliveSupervisor only.
struct AliveSlot {
    enum class State : std::uint8_t { kFree, kInactive, kActive, kExpired };
    AliveLimits limits{};
    std::uint32_t silent_cycles{0U};
    State state{State::kFree};
    bool has_reported{false};
};

/// Alive supervision of up to `slots.size()` entities, without any memory of its own.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          step() is O(capacity), the others are O(1). Nothing blocks.
/// Memory:        no heap, no growth after construction.
class AliveSupervisor final {
  public:
    /// @param[in] slots storage for the entities; must outlive this object; size 1 .. 65535.
    explicit constexpr AliveSupervisor(Span<AliveSlot> slots) noexcept : slots_(slots) {
        MAMORI_REQUIRE(1, slots.size() >= 1U && slots.size() <= 65535U);
    }

    /// Starts supervising slot `index`, active.
    /// @param[in] index  slot to use, 0 .. capacity - 1.
    /// @param[in] limits silence limits [cycles].
    /// @return kOk; kBadParameter (index or limits out of range); kPreconditionNotMet (slot in use).
    Status watch(std::size_t index, AliveLimits limits) noexcept;

    /// Entity `index` is meant to be silent from now on.
    /// @return kOk; kBadParameter (not watched); kPreconditionNotMet (not active: an expired entity cannot be
    ///         hidden by switching its supervision off).
    Status deactivate(std::size_t index) noexcept;

    /// Entity `index` is meant to report again; its silence is counted from zero.
    /// @return kOk; kBadParameter (not watched); kPreconditionNotMet (not inactive).
    Status activate(std::size_t index) noexcept;

    /// Notes a sign of life. It counts for the current cycle; an inactive or expired entity ignores it.
    /// @return kOk; kBadParameter (not watched).
    Status report_alive(std::size_t index) noexcept;

    /// Takes an expired entity back under supervision, active. Only for a deliberate reset.
    /// @return kOk; kBadParameter (not watched); kPreconditionNotMet (not expired).
    Status acknowledge(std::size_t index) noexcept;

    /// Ends one supervision cycle.
    /// @return the worst verdict over all slots in use; kHealthy when no slot is in use.
    [[nodiscard]] AliveVerdict step() noexcept;
    /// The same for entity `index` alone, 0 .. capacity - 1.
    void end_cycle(std::size_t index) noexcept {
        AliveSlot& slot = slots_[index];
        if (slot.state != AliveSlot::State::kActive) {
            return;
        }
        // The count cannot wrap: it stops when it reaches the limit.
        slot.silent_cycles = slot.has_reported ? 0U : slot.silent_cycles + 1U;
        slot.has_reported = false;
        if (slot.silent_cycles >= slot.limits.expired_cycles) {
            slot.state = AliveSlot::State::kExpired;
        }
    }

    /// @param[in] index 0 .. capacity - 1. @return verdict of the last step(); kHealthy when not supervised.
    AliveVerdict get_verdict(std::size_t index) const noexcept {
        const AliveSlot& slot = slots_[index];
        // The worst condition is judged first, so that equal limits give the severer answer.
        if (slot.state == AliveSlot::State::kExpired) {
            return AliveVerdict::kExpired;
        }
        const bool is_late =
            slot.state == AliveSlot::State::kActive && slot.silent_cycles >= slot.limits.late_cycles;
        return is_late ? AliveVerdict::kLate : AliveVerdict::kHealthy;
    }

    /// @param[in] index 0 .. capacity - 1. @return true while silence of this entity would be noticed.
    bool is_active(std::size_t index) const noexcept {
        return slots_[index].state == AliveSlot::State::kActive;
    }

    /// @return true from a successful watch() of entity `index` on.
    bool is_watched(std::size_t index) const noexcept;

  private:
    Span<AliveSlot> slots_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ALIVE_SUPERVISOR_HPP
