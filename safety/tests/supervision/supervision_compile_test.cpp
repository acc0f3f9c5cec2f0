// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler refuses a table with a fault, names the fault and the guilty row, and says how to mend
// it. Method: the build's own compiler is run on one source, without and with groups of broken tables.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

struct Compilation {
    int exit_status;
    std::string messages;
};

Compilation compile(const std::string& group) {
    const std::string root{MAMORI_SOURCE_FOLDER};
    const std::string command = "LC_ALL=C '" MAMORI_COMPILER "' -std=c++17 -fsyntax-only -Wno-unused -D" +
                                group + " -I'" + root + "/kernel/include' -I'" + root + "/safety/include' '" +
                                root + "/safety/tests/supervision/broken_tables_source.cpp' 2>&1";
    Compilation result{-1, {}};
    std::FILE* const output = popen(command.c_str(), "r");
    if (output == nullptr) {
        return result;
    }
    std::array<char, 512U> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr) {
        result.messages += line.data();
    }
    const int status = pclose(output);
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

/// A fault with its rows as compilers print it, and the part of the message that says how to mend it.
struct Refusal {
    const char* fault;
    const char* remedy;
};

template <std::size_t kCount>
void expect_refusals(const std::string& group, const std::array<Refusal, kCount>& refusals) {
    const Compilation result = compile(group);
    EXPECT_EQ(result.exit_status, 1) << result.messages;
    for (const Refusal& refusal : refusals) {
        const std::string fault = std::string{"SupervisionFault::"} + refusal.fault;
        EXPECT_NE(result.messages.find(fault), std::string::npos) << fault << '\n' << result.messages;
        EXPECT_NE(result.messages.find(refusal.remedy), std::string::npos) << refusal.remedy;
    }
}

TEST(SupervisionCompileTest, SoundTableCompiles) {
    verifies("SWR-SUP-033");

    const Compilation result = compile("MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
}

TEST(SupervisionCompileTest, EntitiesThatAreNotSoundDoNotCompile) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refusals(
        "MAMORI_DEFECT_ENTITIES",
        std::array<Refusal, 7U>{{
            {"kTableEmpty, 0, 0", "add a row supervise(<entity>)"},
            {"kModeCount, 0, 0", "correct mode_count"},
            {"kEntityTwice, 1, 0", "entity that is listed twice; keep one row"},
            {"kEntityOutOfOrder, 0, 0", "list them in the order of their enumeration"},
            {"kEntityInNoMode, 1, 0", "add a mode, or remove the entity"},
            {"kEntityUnsupervised, 2, 0", "give it a checkpoint with an alive, a deadline or a role"},
            {"kModeUnsupervised, 0, 0", "add the mode to an entity"},
        }});
}

TEST(SupervisionCompileTest, CheckpointsThatAreNotSoundDoNotCompile) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refusals("MAMORI_DEFECT_ROWS",
                    std::array<Refusal, 6U>{{
                        {"kCheckpointTwice, 3, 0", "checkpoint that is listed twice; keep one row"},
                        {"kCheckpointOutOfOrder, 1, 0", "list them in the order of their enumeration"},
                        {"kCheckpointOfUnknownEntity, 3, 0", "add a row supervise(<entity>)"},
                        {"kCheckpointUnused, 4, 0", "add an alive, a deadline or a role, or remove it"},
                        {"kAliveOfUnknownCheckpoint, 1, 0", "alive of a checkpoint that is not in the table"},
                        {"kAliveTwice, 1, 0", "checkpoint with two alive rows; keep one"},
                    }});
}

TEST(SupervisionCompileTest, DeadlinesThatAreNotSoundDoNotCompile) {
    verifies("SWR-SUP-033", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refusals("MAMORI_DEFECT_DEADLINES",
                    std::array<Refusal, 4U>{{
                        {"kDeadlineOfUnknownCheckpoint, 0, 0", "add a row checkpoint(...)"},
                        {"kDeadlineToItself, 0, 0", "count it with alive(...)"},
                        {"kDeadlineBetweenEntities, 0, 0", "both ends are checkpoints of one entity"},
                        {"kDeadlineTwice, 1, 0", "deadline that is listed twice; keep one row"},
                    }});
}

TEST(SupervisionCompileTest, LimitsOutsideTheirRangeDoNotCompile) {
    verifies("SWR-SUP-034", Technique::kBoundaryValues, Polarity::kViolation);

    expect_refusals("MAMORI_DEFECT_LIMITS",
                    std::array<Refusal, 4U>{{
                        {"kAliveNothingExpected, 0, 0", "expected and reference_cycles are at least 1"},
                        {"kAliveMargin, 1, 0", "min_margin is less than expected"},
                        {"kAliveBeyondQueue, 0, 0", "is at most kPendingCheckpointsMax"},
                        {"kDeadlineLimits, 0, 0", "0 <= shortest <= longest and longest > 0"},
                    }});
}

TEST(SupervisionCompileTest, GraphsThatAreNotSoundDoNotCompile) {
    verifies("SWR-SUP-035", Technique::kErrorGuessing, Polarity::kViolation);

    expect_refusals("MAMORI_DEFECT_GRAPH",
                    std::array<Refusal, 9U>{{
                        {"kEdgeOfUnknownCheckpoint, 0, 0", "edge of a checkpoint that is not in the table"},
                        {"kEdgeOfUnorderedCheckpoint, 2, 0", "give it kInitial, kInner or kFinal"},
                        {"kEdgeBetweenEntities, 2, 0", "both ends are checkpoints of one entity"},
                        {"kEdgeLeavesFinal, 2, 0", "make it kInner or remove the edge"},
                        {"kEdgeTwice, 2, 1", "edge that is listed twice; keep one row"},
                        {"kGraphWithoutInitial, 0, 0", "make the first one kInitial"},
                        {"kCheckpointUnreachable, 2, 0", "an initial one leads to; add an edge"},
                        {"kCheckpointIsDeadEnd, 1, 0", "make it kFinal or add an edge"},
                        {"kDeadlineBypassed, 0, 0", "move the deadline or change the edges"},
                    }});
}

}  // namespace
}  // namespace mamori::safety
