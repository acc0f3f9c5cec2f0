// SPDX-License-Identifier: Apache-2.0
// Goal: a process without standard input uses the number 0 of a descriptor like any other number. Method: a
// process of its own closes descriptor 0, so that the next one that is opened gets this number.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <string>

#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/partition_output.hpp"
#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/ports/posix_rt/provisions.hpp"
#include "mamori/ports/posix_rt/shared_memory.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/line.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

bool is_open(int descriptor) {
    return ::fcntl(descriptor, F_GETFD) >= 0;
}

/// Runs `act` in a process without descriptor 0, and expects that `act` leaves it closed.
void run_without_input(const std::function<void()>& act) {
    EXPECT_EQ(run_in_process([&act] {
                  ASSERT_EQ(::close(0), 0);
                  act();
                  EXPECT_FALSE(is_open(0)) << "a descriptor is left";
              }),
              0);
}

TEST(FirstDescriptorTest, IsUsedForAMappedFile) {
    verifies("SWR-REC-010", Technique::kBoundaryValues);
    const std::string path = ::testing::TempDir() + "mamori_first_" + std::to_string(::getpid());
    run_without_input([&path] {
        for (int i = 0; i < 2; ++i) {  // a new file, and one that exists
            MappedFile sut;
            ASSERT_EQ(sut.open(path.c_str(), 4096U), Status::kOk);
            EXPECT_TRUE(is_open(0));
            EXPECT_EQ(sut.get_region().size(), 4096U);
        }
        MappedFile other;
        EXPECT_EQ(other.open(path.c_str(), 8192U), Status::kError);
        EXPECT_EQ(other.get_error(), MappedFileError::kWrongSize);
    });
    ASSERT_EQ(::unlink(path.c_str()), 0);
}

TEST(FirstDescriptorTest, IsUsedForASharedMemory) {
    verifies("SWR-PRT-012", Technique::kBoundaryValues);
    run_without_input([] {
        for (const SharedAccess access : {SharedAccess::kWrite, SharedAccess::kRead}) {
            SharedMemory sut;
            ASSERT_EQ(sut.create("first", 4096U, access), Status::kOk) << describe(sut.get_error());
            EXPECT_EQ(sut.get_descriptor(), 0);
            EXPECT_TRUE(is_open(0));
        }
        SharedMemory owner;
        ASSERT_EQ(owner.create("first", 4096U, SharedAccess::kRead), Status::kOk);
        SharedMemory sut;
        EXPECT_EQ(sut.adopt(0, 4096U, SharedAccess::kWrite), Status::kOk);
    });
}

TEST(FirstDescriptorTest, IsUsedForTheFiguresOfTheMemory) {
    verifies("SWR-AOU-011", Technique::kBoundaryValues);
    run_without_input([] {
        MemoryLocked sut;
        ASSERT_EQ(sut.open(), Status::kOk);
        EXPECT_TRUE(is_open(0));
        EXPECT_EQ(sut.open(), Status::kPreconditionNotMet);
        EXPECT_NE(sut.look(), Status::kUnsupported);
    });
}

TEST(FirstDescriptorTest, IsUsedForTheOutputOfAPartition) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues);
    Line line;
    run_without_input([&line] {
        PartitionOutput sut{"p"};
        ASSERT_EQ(sut.open(), Status::kOk);
        EXPECT_TRUE(is_open(0));
        EXPECT_EQ(sut.open(), Status::kPreconditionNotMet);
        ASSERT_EQ(::write(sut.get_output(), "a\n", 2U), 2);
        EXPECT_EQ(sut.forward(line.get_writing_end(), line.get_writing_end()), 2U);
    });
    EXPECT_EQ(line.read_all(), "[p] a\n");
}

TEST(FirstDescriptorTest, IsUsedForTheStartOfAPartition) {
    verifies("SWR-PRT-015", Technique::kBoundaryValues);
    Line line;
    run_without_input([&line] {
        const std::array<const char*, 2U> arguments{"-c", "cat /proc/$$/oom_score_adj >&3; exit 7"};
        const std::array<int, 1U> descriptors{line.get_writing_end()};
        PartitionProcess sut;
        ASSERT_EQ(sut.start({"/bin/sh", arguments, descriptors, nullptr, {}}), Status::kOk)
            << describe(sut.get_error());
        EXPECT_EQ(wait_for_end(sut), PartitionState::kEnded);
        EXPECT_EQ(sut.get_exit_status(), 7);
        EXPECT_EQ(sut.start({"/no/such/program", {}, {}, nullptr, {}}), Status::kError);
    });
    EXPECT_EQ(line.read_all(), "1000\n");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
