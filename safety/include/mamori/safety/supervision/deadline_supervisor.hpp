// SPDX-License-Identifier: Apache-2.0
/// @file
/// Deadline supervision: every run of an entity must take at least its shortest and at most its longest time.
/// A run that never finishes is found too, and no later legal checkpoint hides a violation.
///
/// @satisfies SWR-SUP-003, SWR-SUP-004, SWR-SUP-005, SWR-SUP-006
/// Design:   docs/design/supervision.md#deadline-supervision
/// Source:   IEC 61508-2:2010 Table A.10 (temporal monitoring of program sequence)
#ifndef MAMORI_SAFETY_DEADLINE_SUPERVISOR_HPP
#define MAMORI_SAFETY_DEADLINE_SUPERVISOR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/base/elapsed.hpp"

namespace mamori::safety {

/// Allowed duration of one run, both ends included. Range: 0 <= shortest <= longest, 0 < longest.
struct DeadlineLimits {
    Duration shortest{0};
    Duration longest{0};
};

/// True when the limits are inside their range.
constexpr bool is_valid(DeadlineLimits limits) noexcept {
    return limits.shortest >= Duration{0} && limits.shortest <= limits.longest &&
           limits.longest > Duration{0};
}

/// What was wrong. The first violation of an entity is kept.
enum class DeadlineViolation : std::uint8_t {
    kNone,
    kTooShort,       ///< finished before its shortest time, or the clock ran backwards
    kTooLong,        ///< finished after its longest time
    kMissingFinish,  ///< still running after its longest time, or started anew without having finished
    kMissingStart,   ///< finished without having started
};

/// Storage of one supervised entity. Written by DeadlineSupervisor only.
struct DeadlineSlot {
    DeadlineLimits limits{};
    Instant started_at{};
    bool is_watched{false};
    bool is_running{false};  ///< a flag of its own: every instant is legal, tick 0 too
    DeadlineViolation violation{DeadlineViolation::kNone};
    bool is_expired{false};  ///< the violation was seen by a step()
};

/// Deadline supervision of up to `slots.size()` entities, without any memory of its own.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          step() is O(capacity), the others are O(1). Nothing blocks.
/// Memory:        no heap, no growth after construction.
class DeadlineSupervisor final {
  public:
    /// @param[in] slots storage for the entities; must outlive this object; size 1 .. 65535.
    explicit constexpr DeadlineSupervisor(Span<DeadlineSlot> slots) noexcept : slots_(slots) {
        MAMORI_REQUIRE(1, slots.size() >= 1U && slots.size() <= 65535U);
    }

    /// Starts supervising slot `index`; it is taken as not running.
    /// @return kOk; kBadParameter (index or limits out of range); kPreconditionNotMet (slot in use).
    Status watch(std::size_t index, DeadlineLimits limits) noexcept;

    /// A run of entity `index` begins. @return kOk; kBadParameter (not watched).
    Status start(std::size_t index, Instant now) noexcept;

    /// A run of entity `index` has ended. @return kOk; kBadParameter (not watched).
    Status finish(std::size_t index, Instant now) noexcept;

    /// Clears the violation of an expired entity and takes it as not running. Only for a deliberate reset.
    /// @return kOk; kBadParameter (not watched); kPreconditionNotMet (not expired).
    Status acknowledge(std::size_t index) noexcept;

    /// Judges all entities: what was violated since the last step, and runs that are overdue at `now`.
    /// @return true while any entity is expired.
    [[nodiscard]] bool step(Instant now) noexcept;

    /// @param[in] index 0 .. capacity - 1. @return true from the step() that saw a violation on.
    bool is_expired(std::size_t index) const noexcept { return slots_[index].is_expired; }

    /// @param[in] index 0 .. capacity - 1. @return the first violation since the last acknowledgement.
    DeadlineViolation get_violation(std::size_t index) const noexcept { return slots_[index].violation; }

  private:
    bool is_watched(std::size_t index) const noexcept {
        return index < slots_.size() && slots_[index].is_watched;
    }
    static void judge(DeadlineSlot& slot, Instant now) noexcept;

    Span<DeadlineSlot> slots_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_DEADLINE_SUPERVISOR_HPP
