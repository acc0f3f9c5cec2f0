// SPDX-License-Identifier: Apache-2.0
/// @file
/// Register of faults: each is confirmed over some cycles, latched, and cleared by a deliberate
/// acknowledgement once it is gone, never by healing.
///
/// @satisfies SWR-FLT-001, SWR-FLT-002, SWR-FLT-003      Design: docs/design/faults.md#register
#ifndef MAMORI_SAFETY_FAULT_REGISTER_HPP
#define MAMORI_SAFETY_FAULT_REGISTER_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/span.hpp"
#include "mamori/kernel/status.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori::safety {

/// Number of a fault, 0 .. count - 1 of the application's enumeration.
using FaultIndex = std::uint16_t;

/// "No fault".
inline constexpr FaultIndex kNoFault = 0xFFFFU;

/// What is known about one fault; also its storage. Written by FaultRegister only.
struct FaultRecord {
    std::uint32_t confirm_cycles{1U};  ///< cycles in a row that the fault must be present to be latched
    std::uint32_t present_cycles{0U};  ///< cycles in a row that it has been present, held at confirm_cycles
    std::uint32_t occurrences{0U};     ///< times it was confirmed since start, held at the largest number
    std::uint32_t order{0U};           ///< rank among the latched faults, 1 = first; 0 while not latched
    Instant seen_at{};                 ///< first cycle of the presence that was latched
    Instant latched_at{};              ///< when it was confirmed
    bool is_present{false};
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

    /// Sets the debouncing of a fault; without it a fault is latched in the first cycle.
    /// @param[in] confirm_cycles cycles in a row, >= 1.
    /// @return kOk; kBadParameter (fault or cycles out of range); kPreconditionNotMet (fault is present or
    ///         latched).
    Status set_confirmation(FaultIndex fault, std::uint32_t confirm_cycles) noexcept;

    /// Tells whether a fault is present. Call it once per cycle for each fault.
    void report(FaultIndex fault, bool is_present, Instant now) noexcept;

    /// Clears a latched fault that is no longer present. Only for a deliberate act of a person.
    /// @return kOk; kBadParameter (fault out of range); kPreconditionNotMet (not latched, or still present).
    Status acknowledge(FaultIndex fault) noexcept;

    /// Clears every latched fault that is no longer present.
    /// @return kOk (no fault is latched now); kPreconditionNotMet (some are still present and stay latched).
    Status acknowledge_all() noexcept;

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
    void latch(FaultRecord& record, Instant now) noexcept;

    Span<FaultRecord> records_;
    std::size_t latched_count_{0U};
    std::uint32_t next_order_{1U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_FAULT_REGISTER_HPP
