// SPDX-License-Identifier: Apache-2.0
/// @file
/// Register of faults: each is confirmed by count or by time, latched, and cleared by a deliberate
/// acknowledgement once it has been gone for long enough, never by healing.
///
/// @satisfies SWR-FLT-001, SWR-FLT-002, SWR-FLT-003, SWR-FLT-007, SWR-FLT-008, SWR-FLT-009
/// @satisfies SWR-FLT-012
/// Design:   docs/design/supervision.md#fault-register
#ifndef MAMORI_SAFETY_FAULT_REGISTER_HPP
#define MAMORI_SAFETY_FAULT_REGISTER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/reaction/reaction.hpp"

namespace mamori::safety {

/// When a fault that is reported as present is believed: at the first of the two that is reached. A fault
/// needs one of them.
struct Confirmation {
    std::uint32_t cycles{0U};  ///< count at which it is latched; 0: not judged by count
    std::uint32_t decay{0U};   ///< what a cycle without it takes off the count; 0: all of it
    Duration time{0};          ///< unbroken presence at which it is latched; 0: not judged by time
};

/// True when the fault can be confirmed at all: by count, or by a time and then without a decay. No time is
/// negative.
constexpr bool is_valid(Confirmation confirmation) noexcept {
    if (confirmation.cycles == 0U) {
        return confirmation.time > Duration{0} && confirmation.decay == 0U;
    }
    return confirmation.time >= Duration{0};
}

/// How long a latched fault must have been gone, without a break, before it may be acknowledged: both.
struct Healing {
    std::uint32_t cycles{1U};  ///< cycles in a row without it, >= 1
    Duration time{0};          ///< from the first of these to the last, >= 0
};

/// True when the limits are inside their range.
constexpr bool is_valid(Healing healing) noexcept {
    return healing.cycles >= 1U && healing.time >= Duration{0};
}

/// What is known about one fault; also its storage. Written by FaultRegister only.
struct FaultRecord {
    Confirmation confirmation{1U, 0U, Duration{0}};
    Healing healing{};
    std::uint32_t count{0U};          ///< cycles with it less the decay of those without it
    std::uint32_t absent_cycles{0U};  ///< cycles in a row without it, held at the largest number
    std::uint32_t occurrences{0U};    ///< times it was confirmed since start, held at the largest number
    std::uint32_t order{0U};          ///< rank among the latched faults, 1 = first; 0 while not latched
    Instant changed_at{};             ///< first cycle of the presence, or of the absence, that still lasts
    Instant judged_at{};              ///< last report
    Instant seen_at{};                ///< first cycle of what was latched
    Instant latched_at{};             ///< when it was confirmed
    ReactionDemand demand{};          ///< worst one since it was latched; none while not latched
    bool is_present{false};
    bool is_confirmed{false};  ///< in this presence, so that one presence is one occurrence
    bool is_latched{false};
};

/// Faults 0 .. `records.size()` - 1. An index beyond is an own bug and ends in the assertion handler: a fault
/// must never be lost in a status that nobody reads.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          get_first() and acknowledge_all() are O(capacity), the others are O(1). Nothing blocks.
/// Memory:        no heap, no growth after construction.
class FaultRegister final {
  public:
    /// @param[in] records storage, default constructed; must outlive this object; size 1 .. 65535.
    explicit constexpr FaultRegister(Span<FaultRecord> records) noexcept : records_(records) {
        MAMORI_REQUIRE(1, records.size() >= 1U && records.size() <= kNoFault);
    }

    /// Sets when a fault is believed; without it a fault is latched in the first cycle.
    /// @return kOk; kBadParameter (fault out of range, or nothing that could confirm it); kPreconditionNotMet
    ///         (fault is present, counted or latched).
    Status set_confirmation(FaultIndex fault, Confirmation confirmation) noexcept;

    /// Sets how long a fault must be gone before it may be acknowledged; without it one cycle.
    /// @return kOk; kBadParameter (fault or limits out of range); kPreconditionNotMet (fault is present,
    ///         counted or latched).
    Status set_healing(FaultIndex fault, Healing healing) noexcept;

    /// Tells whether a fault is present. Call it once per cycle for each fault. A clock that ran backwards
    /// confirms a fault that is judged by time, and begins the time of healing anew; before the first report
    /// it stands at 0.
    void report(FaultIndex fault, bool is_present, Instant now) noexcept;

    /// Clears a latched fault that has healed. Only for a deliberate act of a person.
    /// @return kOk; kBadParameter (fault out of range); kPreconditionNotMet (not latched, still present, or
    /// not
    ///         gone for long enough).
    Status acknowledge(FaultIndex fault) noexcept;

    /// Clears every latched fault that has healed.
    /// @return kOk (no fault is latched now); kPreconditionNotMet (some have not healed and stay latched).
    Status acknowledge_all() noexcept;

    /// Keeps a demand of a latched fault until it is acknowledged, unless it already has a worse one.
    /// @param[in] demand of a fault of this register; ignored unless that fault is latched.
    /// @return the worst demand of that fault since it was latched.
    const ReactionDemand& raise(const ReactionDemand& demand) noexcept;

    bool is_present(FaultIndex fault) const noexcept { return records_[fault].is_present; }
    bool is_latched(FaultIndex fault) const noexcept { return records_[fault].is_latched; }
    const FaultRecord& get_record(FaultIndex fault) const noexcept { return records_[fault]; }

    /// @return the fault that was latched first of those still latched, in the order of reporting within one
    ///         cycle; kNoFault when none is latched.
    FaultIndex get_first() const noexcept;

    /// @return number of latched faults, 0 .. capacity.
    std::size_t get_latched_count() const noexcept { return latched_count_; }
    std::size_t get_capacity() const noexcept { return records_.size(); }

  private:
    static bool is_to_be_latched(const FaultRecord& record, Instant now) noexcept;
    static bool has_healed(const FaultRecord& record) noexcept;
    static void note_absence(FaultRecord& record, Instant now) noexcept;
    void note_presence(FaultRecord& record, Instant now) noexcept;
    void latch(FaultRecord& record, Instant now) noexcept;

    Span<FaultRecord> records_;
    std::size_t latched_count_{0U};
    std::uint32_t next_order_{1U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_FAULT_REGISTER_HPP
