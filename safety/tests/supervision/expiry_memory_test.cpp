// SPDX-License-Identifier: Apache-2.0
// Goal: the first expired entity is known after a reset, and nothing that was spoiled is believed.
// Method: every single bit of several notes is flipped; values without a meaning; a memory that goes on
// through several "resets", which are new objects over the same storage; a write that is cut off behind each
// of its instructions.
#include "mamori/safety/supervision/expiry_memory.hpp"

#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;
using Violation = CheckpointViolation;

constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();

constexpr std::array kEntities{supervise(Only::kEntity)};
enum class Point : CheckpointIndex { kBegin, kEnd };
constexpr std::array kCheckpoints{checkpoint(Point::kBegin, Only::kEntity, CheckpointRole::kInitial),
                                  checkpoint(Point::kEnd, Only::kEntity, CheckpointRole::kFinal)};
constexpr std::array kEdges{edge(Point::kBegin, Point::kEnd)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, {}, {}, kEdges, 1U, 100U};

class ExpiryMemoryTest : public ::testing::Test {
  protected:
    void SetUp() override { sut_.clear(); }

    void expect_note(EntityIndex entity, Violation violation, std::int64_t at_ns) {
        const ExpiryNote note = sut_.read();
        EXPECT_EQ(note.state, ExpiryState::kEntity);
        EXPECT_EQ(note.entity, entity);
        EXPECT_EQ(note.violation, violation);
        EXPECT_EQ(note.at.ns, at_ns);
    }
    void expect_nothing(ExpiryState state) {
        const ExpiryNote note = sut_.read();
        EXPECT_EQ(note.state, state);
        EXPECT_EQ(note.entity, kNoEntity);
        EXPECT_EQ(note.violation, Violation::kNone);
        EXPECT_EQ(note.at.ns, 0);
    }
    void set_entity(std::uint32_t entity) {
        storage_.entity = entity;
        storage_.entity_complement = ~entity;
    }
    void set_violation(std::uint32_t violation) {
        storage_.violation = violation;
        storage_.violation_complement = ~violation;
    }
    /// @return single flipped bits that were not seen.
    std::size_t count_unseen_flips() {
        std::array<unsigned char, sizeof(ExpiryStorage)> bytes{};
        std::memcpy(bytes.data(), &storage_, sizeof(storage_));
        std::size_t unseen = 0U;
        for (unsigned char& byte : bytes) {
            for (unsigned bit = 0U; bit < 8U; ++bit) {
                byte = static_cast<unsigned char>(byte ^ (1U << bit));
                std::memcpy(&storage_, bytes.data(), sizeof(storage_));
                unseen += sut_.read().state == ExpiryState::kCorrupted ? 0U : 1U;
                byte = static_cast<unsigned char>(byte ^ (1U << bit));
            }
        }
        std::memcpy(&storage_, bytes.data(), sizeof(storage_));
        return unseen;
    }

    ExpiryStorage storage_{};
    ExpiryMemory sut_{storage_};
};

TEST_F(ExpiryMemoryTest, ClearedMemoryHasNoNote) {
    verifies("SWR-SUP-036");

    expect_nothing(ExpiryState::kNone);
}

TEST_F(ExpiryMemoryTest, NoteHasEntityCauseAndTime) {
    verifies("SWR-SUP-036", Technique::kBoundaryValues);

    ASSERT_EQ(sut_.keep(0U, Violation::kLostReport, Instant{kFirst}), Status::kOk);
    expect_note(0U, Violation::kLostReport, kFirst);
    sut_.clear();
    ASSERT_EQ(sut_.keep(kNoEntity - 1U, Violation::kAlive, Instant{kLast}), Status::kOk);
    expect_note(kNoEntity - 1U, Violation::kAlive, kLast);
}

TEST_F(ExpiryMemoryTest, SupervisorNotesTheFirstEntityInTheCycleInWhichItExpires) {
    verifies("SWR-SUP-036");
    SupervisionRig<kTable> rig;
    ASSERT_EQ(rig.step(10), SupervisionStatus::kOk);
    ASSERT_EQ(rig.memory.read().state, ExpiryState::kNone);
    rig.report(Point::kEnd, 15);
    ASSERT_EQ(rig.step(20), SupervisionStatus::kExpired);
    ASSERT_EQ(rig.step(30), SupervisionStatus::kExpired);

    const ExpiryNote note = ExpiryMemory{rig.expiry}.read();
    EXPECT_EQ(note.state, ExpiryState::kEntity);
    EXPECT_EQ(note.entity, 0U);
    EXPECT_EQ(note.violation, Violation::kOrder);
    EXPECT_EQ(note.at.ns, 20);
}

TEST_F(ExpiryMemoryTest, SupervisorNotesOverACorruptedNote) {
    verifies("SWR-SUP-036", Technique::kFaultInjection, Polarity::kViolation);
    SupervisionRig<kTable> rig;
    std::memset(&rig.expiry, 0x5A, sizeof(rig.expiry));
    ASSERT_EQ(rig.memory.read().state, ExpiryState::kCorrupted);
    rig.report(Point::kEnd, 15);
    ASSERT_EQ(rig.step(20), SupervisionStatus::kExpired);

    EXPECT_EQ(rig.memory.read().state, ExpiryState::kEntity);
}

TEST_F(ExpiryMemoryTest, MemoryThatWasNeverWrittenIsCorrupted) {
    verifies("SWR-SUP-037", Technique::kErrorGuessing, Polarity::kViolation);

    for (const int byte : {0x00, 0xFF, 0x55, 0xA5}) {
        std::memset(&storage_, byte, sizeof(storage_));
        expect_nothing(ExpiryState::kCorrupted);
    }
}

TEST_F(ExpiryMemoryTest, EverySingleFlippedBitIsFound) {
    verifies("SWR-SUP-037", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(count_unseen_flips(), 0U) << "of the empty note";
    for (const std::int64_t at_ns :
         {kFirst, std::int64_t{-1}, std::int64_t{0}, std::int64_t{123456789}, kLast}) {
        for (std::uint32_t violation = 1U; violation <= kCheckpointViolationMax; ++violation) {
            for (const EntityIndex entity : {EntityIndex{0U}, EntityIndex{1U}, EntityIndex{0xFFFEU}}) {
                sut_.clear();
                ASSERT_EQ(sut_.keep(entity, static_cast<Violation>(violation), Instant{at_ns}), Status::kOk);
                ASSERT_EQ(count_unseen_flips(), 0U) << entity << ' ' << violation << ' ' << at_ns;
                expect_note(entity, static_cast<Violation>(violation), at_ns);
            }
        }
    }
}

TEST_F(ExpiryMemoryTest, ValuesWithoutAMeaningAreNotBelievedWithTheirComplementEither) {
    verifies("SWR-SUP-037", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(sut_.keep(3U, Violation::kAlive, Instant{5}), Status::kOk);

    set_violation(0U);
    expect_nothing(ExpiryState::kCorrupted);
    set_violation(kCheckpointViolationMax + 1U);
    expect_nothing(ExpiryState::kCorrupted);
    set_violation(1U);
    expect_note(3U, Violation::kLostReport, 5);
    set_entity(kNoEntity);
    expect_nothing(ExpiryState::kCorrupted);
    set_entity(kNoEntity + std::uint32_t{1U});
    expect_nothing(ExpiryState::kCorrupted);
}

TEST_F(ExpiryMemoryTest, EachCauseIsBelievedWithItsComplement) {
    verifies("SWR-SUP-037", Technique::kEquivalenceClasses);

    for (std::uint32_t violation = 1U; violation <= kCheckpointViolationMax; ++violation) {
        sut_.clear();
        ASSERT_EQ(sut_.keep(7U, static_cast<Violation>(violation), Instant{-1}), Status::kOk);
        expect_note(7U, static_cast<Violation>(violation), -1);
    }
}

/// A storage that two processes share.
class SharedStorage final {
  public:
    SharedStorage()
        : memory_(mmap(nullptr, sizeof(ExpiryStorage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                       0)) {}
    ~SharedStorage() { munmap(memory_, sizeof(ExpiryStorage)); }
    SharedStorage(const SharedStorage&) = delete;
    SharedStorage& operator=(const SharedStorage&) = delete;
    bool is_open() const { return memory_ != MAP_FAILED; }
    ExpiryStorage& get() const { return *static_cast<ExpiryStorage*>(memory_); }

  private:
    void* memory_;
};

/// What was read behind the instructions of another process, in the order of its first occurrence.
struct Readings {
    std::vector<ExpiryNote> notes{};
    bool is_complete{false};  ///< we have seen all of it
};

bool is_same(const ExpiryNote& a, const ExpiryNote& b) {
    return a.state == b.state && a.entity == b.entity && a.violation == b.violation && a.at == b.at;
}

/// Runs `write` in a process of its own, instruction by instruction, and reads the storage behind each.
template <typename Write>
Readings read_behind_each_instruction(const ExpiryMemory& memory, Write write) {
    Readings readings;
    const pid_t child = fork();
    if (child == 0) {
        if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) {
            _exit(1);
        }
        raise(SIGSTOP);
        write();
        raise(SIGSTOP);
    }
    int status = 0;
    waitpid(child, &status, 0);
    bool has_stepped = WIFSTOPPED(status);
    while (has_stepped) {
        const ExpiryNote note = memory.read();
        if (readings.notes.empty() || !is_same(readings.notes.back(), note)) {
            readings.notes.push_back(note);
        }
        has_stepped = ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) == 0 &&
                      waitpid(child, &status, 0) == child && WIFSTOPPED(status) &&
                      WSTOPSIG(status) == SIGTRAP;
    }
    readings.is_complete = WIFSTOPPED(status) && WSTOPSIG(status) == SIGSTOP && readings.notes.size() > 1U;
    if (WIFSTOPPED(status)) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    return readings;
}

TEST_F(ExpiryMemoryTest, WriteThatIsCutOffBehindAnyInstructionLeavesOldNoteNewNoteOrCorruption) {
    verifies("SWR-SUP-037", Technique::kFaultInjection, Polarity::kViolation);
    SharedStorage shared;
    ASSERT_TRUE(shared.is_open());
    ExpiryMemory memory{shared.get()};
    memory.clear();
    const ExpiryNote none = memory.read();

    const Readings kept = read_behind_each_instruction(
        memory, [&memory] { static_cast<void>(memory.keep(3U, Violation::kAlive, Instant{5})); });
    if (!kept.is_complete) {
        GTEST_SKIP() << "verdict=no-privilege: this machine lets no process be traced";
    }
    ASSERT_EQ(kept.notes.size(), 3U);
    EXPECT_TRUE(is_same(kept.notes[0], none));
    EXPECT_TRUE(is_same(kept.notes[1], ExpiryNote{}));
    EXPECT_TRUE(is_same(kept.notes[2], {ExpiryState::kEntity, 3U, Violation::kAlive, Instant{5}}));

    const Readings cleared = read_behind_each_instruction(memory, [&memory] { memory.clear(); });
    ASSERT_EQ(cleared.notes.size(), 3U);
    EXPECT_TRUE(is_same(cleared.notes[0], kept.notes[2]));
    EXPECT_TRUE(is_same(cleared.notes[1], ExpiryNote{}));
    EXPECT_TRUE(is_same(cleared.notes[2], none));
}

TEST_F(ExpiryMemoryTest, FirstNoteIsKeptOverResetsUntilItIsCleared) {
    verifies("SWR-SUP-038", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(sut_.keep(3U, Violation::kAlive, Instant{5}), Status::kOk);

    for (int reset = 0; reset < 3; ++reset) {
        ExpiryMemory after_reset{storage_};
        EXPECT_EQ(after_reset.keep(4U, Violation::kOrder, Instant{6}), Status::kPreconditionNotMet);
        expect_note(3U, Violation::kAlive, 5);
    }
}

TEST_F(ExpiryMemoryTest, ClearedMemoryTakesTheNextNote) {
    verifies("SWR-SUP-038", Technique::kStateTransition);
    ASSERT_EQ(sut_.keep(3U, Violation::kAlive, Instant{5}), Status::kOk);
    sut_.clear();
    expect_nothing(ExpiryState::kNone);

    EXPECT_EQ(sut_.keep(4U, Violation::kOrder, Instant{6}), Status::kOk);
    expect_note(4U, Violation::kOrder, 6);
}

TEST_F(ExpiryMemoryTest, NoteWithoutAnEntityOrACauseIsRefused) {
    verifies("SWR-SUP-038", Technique::kInterface, Polarity::kViolation);

    EXPECT_EQ(sut_.keep(kNoEntity, Violation::kAlive, Instant{5}), Status::kBadParameter);
    EXPECT_EQ(sut_.keep(0U, Violation::kNone, Instant{5}), Status::kBadParameter);
    expect_nothing(ExpiryState::kNone);
}

}  // namespace
}  // namespace mamori::safety
