// SPDX-License-Identifier: Apache-2.0
/// @file
/// A supervisor of a table with all that it needs, and shorthand for what the tests do to it.
#ifndef MAMORI_SAFETY_TESTS_SUPERVISION_SUPERVISION_RIG_HPP
#define MAMORI_SAFETY_TESTS_SUPERVISION_SUPERVISION_RIG_HPP

#include <array>
#include <cstdint>

#include "mamori/safety/supervision/checkpoint_supervisor.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {

/// Entity and checkpoint numbers of tables with a single entity.
enum class Only : EntityIndex { kEntity };

template <const auto& kTable>
struct SupervisionRig {
    SupervisionRig() noexcept { memory.clear(); }

    template <typename Entity, typename Point>
    void report_as(Entity entity, Point point, std::int64_t at_ns) noexcept {
        storage.get_log(entity).report(point, Instant{at_ns});
    }
    template <typename Point>
    void report(Point point, std::int64_t at_ns) noexcept {
        report_as(Only::kEntity, point, at_ns);
    }
    SupervisionStatus step(std::int64_t at_ns) noexcept { return sut.step(Instant{at_ns}); }
    EntityStatus get_status() const noexcept { return sut.get_entity_status(0U); }
    CheckpointViolation get_violation() const noexcept { return sut.get_violation(0U); }

    SupervisionStorage<kTable> storage{};
    ExpiryStorage expiry{};
    ExpiryMemory memory{expiry};
    CheckpointSupervisor sut{storage, memory};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_TESTS_SUPERVISION_SUPERVISION_RIG_HPP
