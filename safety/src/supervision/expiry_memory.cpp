// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/supervision/expiry_memory.hpp"

#include <atomic>

namespace mamori::safety {
namespace {

/// Volatile, so that the compiler keeps each store and their order: nobody in this program reads them.
template <typename T>
void store(T& place, T value) noexcept {
    volatile T& stored = place;
    stored = value;
}

template <typename T>
T load(const T& place) noexcept {
    const volatile T& stored = place;
    return stored;
}

/// The order of the steps in the memory too.
void end_step() noexcept {
    std::atomic_thread_fence(std::memory_order_release);
}

}  // namespace

ExpiryNote ExpiryMemory::read() const noexcept {
    const std::uint64_t at_ns = load(storage_.at_ns);
    const std::uint32_t violation = load(storage_.violation);
    const std::uint32_t entity = load(storage_.entity);
    // Bits in which a value and its complement agree: there must be none.
    const std::uint64_t wrong_bits =
        ~(at_ns ^ load(storage_.at_ns_complement)) |
        static_cast<std::uint32_t>(~(violation ^ load(storage_.violation_complement))) |
        static_cast<std::uint32_t>(~(entity ^ load(storage_.entity_complement)));
    const bool is_empty = entity == kNoEntity && violation == 0U;
    const bool is_note = entity < kNoEntity && violation >= 1U && violation <= kCheckpointViolationMax;
    if (wrong_bits != 0U || (!is_empty && !is_note)) {
        return {};
    }
    if (is_empty) {
        return {ExpiryState::kNone};
    }
    return {ExpiryState::kEntity, static_cast<EntityIndex>(entity),
            static_cast<CheckpointViolation>(violation), Instant{static_cast<std::int64_t>(at_ns)}};
}

Status ExpiryMemory::keep(EntityIndex entity, CheckpointViolation violation, Instant at) noexcept {
    if (entity == kNoEntity || violation == CheckpointViolation::kNone) {
        return Status::kBadParameter;
    }
    if (read().state == ExpiryState::kEntity) {
        return Status::kPreconditionNotMet;
    }
    write(entity, static_cast<std::uint32_t>(violation), at.ns);
    return Status::kOk;
}

void ExpiryMemory::clear() noexcept {
    write(kNoEntity, 0U, 0);
}

void ExpiryMemory::write(std::uint32_t entity, std::uint32_t violation, std::int64_t at_ns) noexcept {
    // First a complement that is wrong, last the one that is right: in between nothing can be read.
    store(storage_.entity_complement, load(storage_.entity));
    end_step();
    const auto time = static_cast<std::uint64_t>(at_ns);
    store(storage_.at_ns, time);
    store(storage_.at_ns_complement, ~time);
    store(storage_.violation, violation);
    store(storage_.violation_complement, ~violation);
    end_step();
    store(storage_.entity, entity);
    end_step();
    store(storage_.entity_complement, ~entity);
}

}  // namespace mamori::safety
