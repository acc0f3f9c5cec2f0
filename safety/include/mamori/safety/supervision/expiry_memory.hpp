// SPDX-License-Identifier: Apache-2.0
/// @file
/// Keeps which entity expired first, why and when, in memory that outlives a reset, so that the next start
/// can tell why the watchdog bit.
///
/// @satisfies SWR-SUP-036, SWR-SUP-037, SWR-SUP-038
/// Design:   docs/design/supervision.md#first-expired-entity
#ifndef MAMORI_SAFETY_SUPERVISION_EXPIRY_MEMORY_HPP
#define MAMORI_SAFETY_SUPERVISION_EXPIRY_MEMORY_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/supervision/supervision_status.hpp"
#include "mamori/safety/supervision/supervision_table.hpp"

namespace mamori::safety {

/// Each value with its complement. Without initialisers on purpose: a start must not write to it. On a bare
/// machine it is placed in a section that the start-up code leaves alone, and that no cache delays:
///
///     __attribute__((section(".noinit"))) mamori::safety::ExpiryStorage expiry_storage;
///
/// On Linux it lies in memory that the caller maps from a file.
struct ExpiryStorage {
    std::uint64_t at_ns;
    std::uint64_t at_ns_complement;
    std::uint32_t violation;
    std::uint32_t violation_complement;
    std::uint32_t entity;
    std::uint32_t entity_complement;
};
static_assert(std::is_trivial_v<ExpiryStorage>, "an initialiser would wipe what it has to keep");
static_assert(sizeof(ExpiryStorage) == 32U, "a byte between the values would have no complement");

/// What the storage tells.
enum class ExpiryState : std::uint8_t {
    kNone,       ///< nothing has expired since clear()
    kEntity,     ///< the note names the entity that expired first
    kCorrupted,  ///< a value and its complement disagree: never written, cut off in mid-write, or spoiled
};
struct ExpiryNote {
    ExpiryState state{ExpiryState::kCorrupted};
    EntityIndex entity{kNoEntity};                              ///< kNoEntity unless state is kEntity
    CheckpointViolation violation{CheckpointViolation::kNone};  ///< kNone unless state is kEntity
    Instant at{};  ///< by the clock of the run that ended, 0 unless state is kEntity
};

/// Reader and writer of one storage.
///
/// Thread safety: none; call every member from the same execution context.
/// Time:          O(1). Memory: no heap. A reset at any instant of keep() or clear() leaves the old note, the
///                new one, or one that reads as kCorrupted.
class ExpiryMemory final {
  public:
    /// @param[in] storage must outlive this object; it is not written here.
    explicit constexpr ExpiryMemory(ExpiryStorage& storage) noexcept : storage_(storage) {}

    /// @return what is stored; it trusts no value without its complement.
    ExpiryNote read() const noexcept;

    /// Stores the first expiry. A note that nobody has cleared yet is kept, over any number of resets; a
    /// corrupted one is replaced.
    /// @param[in] entity not kNoEntity. @param[in] violation not kNone.
    /// @return kOk; kBadParameter; kPreconditionNotMet (it has a note).
    Status keep(EntityIndex entity, CheckpointViolation violation, Instant at) noexcept;

    /// Makes it read kNone: at the first start ever, and once the note was read and passed on.
    void clear() noexcept;

  private:
    void write(std::uint32_t entity, std::uint32_t violation, std::int64_t at_ns) noexcept;

    ExpiryStorage& storage_;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SUPERVISION_EXPIRY_MEMORY_HPP
