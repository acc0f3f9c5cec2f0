// SPDX-License-Identifier: Apache-2.0
// Goal: what docs/manual/supervision.md shows compiles and does what the page says. Method: its blocks, run
// for some cycles, with and without a skipped checkpoint. verification/checks/manual_samples.py
// compares the two.
#include <array>
#include <cstdint>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/trace/verifies.hpp"

// clang-format off
#include "mamori/safety/supervision/challenge_gate.hpp"
#include "mamori/safety/supervision/checkpoint_supervisor.hpp"

#include "mamori/safety/cycle/safety_part.hpp"

namespace supervised {

using namespace mamori::literals;
using mamori::safety::CheckpointRole;

enum class Entity { kControl, kPlanner };
enum class Point { kRead, kCompute, kWrite, kPlan };
enum class Mode { kIdle, kWork };

constexpr std::array kEntities{
    mamori::safety::supervise(Entity::kControl),  // in every mode
    mamori::safety::supervise(Entity::kPlanner, mamori::safety::in_modes(Mode::kWork), 2),  // two wrong cycles
};
constexpr std::array kCheckpoints{
    mamori::safety::checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInitial),
    mamori::safety::checkpoint(Point::kCompute, Entity::kControl, CheckpointRole::kInner),
    mamori::safety::checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kFinal),
    mamori::safety::checkpoint(Point::kPlan, Entity::kPlanner),
};
constexpr std::array kAlives{
    mamori::safety::alive(Point::kRead, {1, 0, 0, 1}),    // once in each supervision cycle
    mamori::safety::alive(Point::kPlan, {10, 1, 1, 50}),  // 9 to 11 times in 50 cycles, evenly spread
};
constexpr std::array kDeadlines{mamori::safety::deadline(Point::kRead, Point::kWrite, {50_us, 400_us})};
constexpr std::array kEdges{
    mamori::safety::edge(Point::kRead, Point::kCompute),
    mamori::safety::edge(Point::kCompute, Point::kWrite),
};
constexpr mamori::safety::SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges,
                                                  2,    // modes
                                                  5};   // cycles from expired to stopped
static_assert(mamori::safety::is_sound<kTable>());

}  // namespace supervised

namespace supervised {

MAMORI_CONSTINIT mamori::safety::SupervisionStorage<kTable> storage;
mamori::safety::ExpiryStorage expiry_storage;  // on a controller: __attribute__((section(".noinit")))
MAMORI_CONSTINIT mamori::safety::ExpiryMemory expiry_memory{expiry_storage};
MAMORI_CONSTINIT mamori::safety::CheckpointSupervisor supervisor{storage, expiry_memory};

void control(mamori::Instant now) {
    storage.get_log(Entity::kControl).report(Point::kRead, now);
    // ...
    storage.get_log(Entity::kControl).report(Point::kCompute, now + 100_us);
    // ...
    storage.get_log(Entity::kControl).report(Point::kWrite, now + 200_us);
}

}  // namespace supervised

namespace supervised {

bool serve(mamori::safety::ChallengeGate& gate, mamori::Instant now) {
    mamori::safety::ProofChain chain{gate.ask(now)};
    const mamori::safety::SupervisionStatus status = supervisor.step(now, chain);
    const mamori::safety::ChallengeOutcome outcome =
        gate.step(now, mamori::safety::to_global_status(status), true, chain.get_value());
    return outcome == mamori::safety::ChallengeOutcome::kAnswered;
}

}  // namespace supervised

namespace supervised {

constexpr mamori::safety::Checkpoints kControlPoints =
    mamori::safety::checkpoints<kTable>(supervisor, Entity::kControl);
// In the table: supervise(control, alive(), deadline(400_us), kControlPoints, raises(Fault::kControl))

}  // namespace supervised

namespace supervised {

/// @return the entity that expired before this start; kNoEntity when none did, or nobody knows.
mamori::safety::EntityIndex take_last_words() {
    const mamori::safety::ExpiryNote note = expiry_memory.read();
    expiry_memory.clear();
    return note.state == mamori::safety::ExpiryState::kEntity ? note.entity : mamori::safety::kNoEntity;
}

}  // namespace supervised
// clang-format on

namespace supervised {
namespace {

using mamori::Instant;
using namespace mamori::verification;

class FakeChallenge final : public mamori::safety::ChallengeWatchdog {
  public:
    mamori::Result<std::uint32_t> get_question() noexcept override { return question_; }
    mamori::Status answer(Instant, std::uint32_t answer) noexcept override {
        const bool is_right = answer == mamori::safety::calc_sound_answer(kTable, question_);
        ++question_;
        return is_right ? mamori::Status::kOk : mamori::Status::kBadParameter;
    }

  private:
    std::uint32_t question_{0U};
};

TEST(SupervisionPageTest, ExampleServesWhileItIsHealthyAndTellsWhoWasNot) {
    verifies("SWR-SUP-033", Technique::kInterface);
    FakeChallenge watchdog;
    mamori::safety::ChallengeGate gate{watchdog, {500_us, 3_ms}};
    EXPECT_EQ(take_last_words(), mamori::safety::kNoEntity);

    for (std::int64_t cycle = 0; cycle < 100; ++cycle) {
        const Instant begin = Instant{0} + 1_ms * cycle;
        control(begin);
        ASSERT_TRUE(serve(gate, begin + 900_us)) << cycle;
    }
    const Instant begin = Instant{0} + 100_ms;
    storage.get_log(Entity::kControl).report(Point::kCompute, begin);
    EXPECT_FALSE(serve(gate, begin + 900_us));
    EXPECT_EQ(take_last_words(), 0U);
}

TEST(SupervisionPageTest, TheCheckpointsOfAComponentAreAnEntityOfTheTable) {
    verifies("SWR-CYC-014", Technique::kInterface);
    EXPECT_EQ(kControlPoints.supervisor, &supervisor);
    EXPECT_EQ(kControlPoints.table, &supervisor.get_table());
    EXPECT_EQ(kControlPoints.entity, 0U);
}

}  // namespace
}  // namespace supervised
