// SPDX-License-Identifier: Apache-2.0
// Goal: a faulty row is found wherever it stands, and with whichever other row it clashes. Method: a sound
// table of four like entities; each row, and each pair of rows, of each kind is spoiled in turn.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mamori/safety/supervision/supervision_check.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Fault = SupervisionFault;

constexpr std::size_t kEntities = 4U;
constexpr std::size_t kCheckpointMax = 2U * kEntities;

/// Each entity is active in a mode of its own, and runs from a first checkpoint to a second one.
struct Rows {
    Rows() {
        for (std::uint16_t e = 0U; e < kEntities; ++e) {
            const auto first = static_cast<CheckpointIndex>(2U * e);
            const auto second = static_cast<CheckpointIndex>(first + 1U);
            entities.push_back({e, to_mask(e), 0U});
            checkpoints.push_back({first, e, CheckpointRole::kInitial});
            checkpoints.push_back({second, e, CheckpointRole::kFinal});
            alives.push_back({first, {1U, 0U, 0U, 1U}});
            deadlines.push_back({first, second, {Duration{1}, Duration{2}}});
            edges.push_back({first, second});
        }
    }

    SupervisionFinding find() const {
        SupervisionTable table{};
        table.entities = {entities.data(), entities.size()};
        table.checkpoints = {checkpoints.data(), checkpoints.size()};
        table.alives = {alives.data(), alives.size()};
        table.deadlines = {deadlines.data(), deadlines.size()};
        table.edges = {edges.data(), edges.size()};
        table.mode_count = kEntities;
        return find_fault<kCheckpointMax>(table);
    }

    std::vector<EntityRow> entities{};
    std::vector<CheckpointRow> checkpoints{};
    std::vector<AliveRow> alives{};
    std::vector<DeadlineRow> deadlines{};
    std::vector<EdgeRow> edges{};
};

void expect(const Rows& rows, Fault fault, std::size_t row = 0U, std::size_t other = 0U) {
    const SupervisionFinding finding = rows.find();
    EXPECT_EQ(static_cast<int>(finding.fault), static_cast<int>(fault)) << row << ' ' << other;
    EXPECT_EQ(finding.row, row);
    EXPECT_EQ(finding.other, other);
}

/// Each row takes the place of each later one of its list.
template <typename Row>
void expect_twice(std::vector<Row> Rows::* list, Fault fault) {
    const std::size_t count = (Rows{}.*list).size();
    for (std::size_t later = 1U; later < count; ++later) {
        for (std::size_t earlier = 0U; earlier < later; ++earlier) {
            Rows rows;
            (rows.*list)[later] = (rows.*list)[earlier];
            expect(rows, fault, later, earlier);
        }
    }
}

TEST(SupervisionRowsTest, LikeRowsOfSeveralEntitiesAreSound) {
    verifies("SWR-SUP-033", Technique::kEquivalenceClasses);

    expect(Rows{}, Fault::kNone);
}

TEST(SupervisionRowsTest, EachPairOfRowsThatAreListedTwiceIsFound) {
    verifies("SWR-SUP-033", Technique::kFaultInjection, Polarity::kViolation);

    expect_twice(&Rows::entities, Fault::kEntityTwice);
    expect_twice(&Rows::checkpoints, Fault::kCheckpointTwice);
    expect_twice(&Rows::alives, Fault::kAliveTwice);
    expect_twice(&Rows::deadlines, Fault::kDeadlineTwice);
    expect_twice(&Rows::edges, Fault::kEdgeTwice);
}

TEST(SupervisionRowsTest, EachFaultyRowIsFoundBehindSoundOnes) {
    verifies("SWR-SUP-033", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t e = 0U; e < kEntities; ++e) {
        Rows in_no_mode;
        in_no_mode.entities[e].modes = to_mask(kEntities);
        expect(in_no_mode, Fault::kEntityInNoMode, e);
        Rows without_count;
        without_count.alives[e].count.expected = 0U;
        expect(without_count, Fault::kAliveNothingExpected, e);
        Rows to_itself;
        to_itself.deadlines[e].finish = to_itself.deadlines[e].start;
        expect(to_itself, Fault::kDeadlineToItself, e);
        Rows to_nowhere;
        to_nowhere.edges[e].to = kCheckpointMax;
        expect(to_nowhere, Fault::kEdgeOfUnknownCheckpoint, e);
    }
}

TEST(SupervisionRowsTest, EachFaultyCheckpointIsFoundBehindSoundOnes) {
    verifies("SWR-SUP-033", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t c = 0U; c < kCheckpointMax; ++c) {
        Rows unknown_number;
        unknown_number.checkpoints[c].checkpoint = kCheckpointMax;
        expect(unknown_number, Fault::kCheckpointOutOfOrder, c);
        Rows of_nobody;
        of_nobody.checkpoints[c].entity = kEntities;
        expect(of_nobody, Fault::kCheckpointOfUnknownEntity, c);
    }
    for (std::size_t e = 0U; e < kEntities; ++e) {
        const std::size_t first = 2U * e;
        Rows unused;
        unused.checkpoints[first].role = CheckpointRole::kUnordered;
        unused.checkpoints[first + 1U].role = CheckpointRole::kInitialAndFinal;
        unused.alives.erase(unused.alives.begin() + static_cast<std::ptrdiff_t>(e));
        unused.deadlines.erase(unused.deadlines.begin() + static_cast<std::ptrdiff_t>(e));
        unused.edges.erase(unused.edges.begin() + static_cast<std::ptrdiff_t>(e));
        expect(unused, Fault::kCheckpointUnused, first);
        Rows unreachable;
        unreachable.checkpoints[first].role = CheckpointRole::kInner;
        unreachable.checkpoints[first + 1U].role = CheckpointRole::kInitialAndFinal;
        expect(unreachable, Fault::kCheckpointUnreachable, first);
        Rows dead_end;
        dead_end.checkpoints[first + 1U].role = CheckpointRole::kInner;
        expect(dead_end, Fault::kCheckpointIsDeadEnd, first + 1U);
    }
}

TEST(SupervisionRowsTest, DeadlineWithOneEndInTheGraphIsBypassedByNothing) {
    verifies("SWR-SUP-033", Technique::kEquivalenceClasses);
    for (const std::size_t unordered : {0U, 1U}) {
        Rows rows;
        rows.checkpoints[unordered].role = CheckpointRole::kUnordered;
        rows.checkpoints[1U - unordered].role = CheckpointRole::kInitialAndFinal;
        rows.edges.erase(rows.edges.begin());

        expect(rows, Fault::kNone);
    }
}

TEST(SupervisionRowsTest, WhatIsMissingIsFoundForEachEntityAndMode) {
    verifies("SWR-SUP-033", Technique::kFaultInjection, Polarity::kViolation);

    for (std::size_t e = 0U; e < kEntities; ++e) {
        const std::size_t next = (e + 1U) % kEntities;
        Rows unsupervised;
        unsupervised.checkpoints[2U * e].entity = static_cast<EntityIndex>(next);
        unsupervised.checkpoints[2U * e + 1U].entity = static_cast<EntityIndex>(next);
        expect(unsupervised, Fault::kEntityUnsupervised, e);
        Rows mode_without_entity;
        mode_without_entity.entities[e].modes = to_mask(next);
        expect(mode_without_entity, Fault::kModeUnsupervised, e);
        Rows without_initial;
        without_initial.checkpoints[2U * e].role = CheckpointRole::kInner;
        expect(without_initial, Fault::kGraphWithoutInitial, e);
        Rows bypassed;
        bypassed.checkpoints[2U * e + 1U].role = CheckpointRole::kInitialAndFinal;
        expect(bypassed, Fault::kDeadlineBypassed, e);
    }
}

}  // namespace
}  // namespace mamori::safety
