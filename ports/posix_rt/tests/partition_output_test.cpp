// SPDX-License-Identifier: Apache-2.0
// Goal: a partition writes to separate streams, and each of its lines begins with its name. Method: a shell
// as partition, files and pipes as streams, text on both sides of each limit, a flood.
#include "mamori/ports/posix_rt/partition_output.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <string>

#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/line.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

class PartitionStreamTest : public ::testing::Test {
  protected:
    Status start(const char* script, int output, int errors) {
        arguments_ = {"-c", script};
        descriptors_ = {line_.get_writing_end()};
        return process_.start({"/bin/sh", arguments_, descriptors_, nullptr, {}, output, errors});
    }

    Line line_{};
    std::array<const char*, 2U> arguments_{};
    std::array<int, 1U> descriptors_{};
    PartitionProcess process_{};
};

TEST_F(PartitionStreamTest, WithoutStreamsTheOutputIsDiscarded) {
    verifies("SWR-PRT-063", Technique::kRequirementsBased, Polarity::kViolation);
    ASSERT_EQ(
        start("for i in 0 1 2; do x=$(readlink /proc/$$/fd/$i); echo $x >&3; done", kNoStream, kNoStream),
        Status::kOk);

    EXPECT_EQ(line_.read_all(), "/dev/null\n/dev/null\n/dev/null\n");
    EXPECT_EQ(wait_for_end(process_), PartitionState::kEnded);
}

TEST_F(PartitionStreamTest, EachStreamHasTheTargetOfTheOrder) {
    verifies("SWR-PRT-063");
    Line output;
    Line errors;
    ASSERT_EQ(start("echo a; echo b >&2; echo c >&3", output.get_writing_end(), errors.get_writing_end()),
              Status::kOk);

    EXPECT_EQ(output.read_all(), "a\n");
    EXPECT_EQ(errors.read_all(), "b\n");
    EXPECT_EQ(line_.read_all(), "c\n");
    EXPECT_EQ(wait_for_end(process_), PartitionState::kEnded);
}

TEST_F(PartitionStreamTest, BothStreamsMayBeEqual) {
    verifies("SWR-PRT-063", Technique::kEquivalenceClasses);
    Line output;
    ASSERT_EQ(start("echo a; echo b >&2", output.get_writing_end(), output.get_writing_end()), Status::kOk);

    EXPECT_EQ(output.read_all(), "a\nb\n");
    EXPECT_EQ(wait_for_end(process_), PartitionState::kEnded);
}

TEST_F(PartitionStreamTest, StreamsMayExchangeTheirNumbers) {
    verifies("SWR-PRT-063", Technique::kErrorGuessing);
    Line first;
    Line second;
    EXPECT_EQ(run_in_process([&] {
                  ASSERT_EQ(::dup2(first.get_writing_end(), 1), 1);
                  ASSERT_EQ(::dup2(second.get_writing_end(), 2), 2);
                  ASSERT_EQ(start("echo a; echo b >&2; echo c >&3", 2, 1), Status::kOk);
                  EXPECT_EQ(wait_for_end(process_), PartitionState::kEnded);
              }),
              0);

    EXPECT_EQ(first.read_all(), "b\n");
    EXPECT_EQ(second.read_all(), "a\n");
    EXPECT_EQ(line_.read_all(), "c\n");
}

TEST_F(PartitionStreamTest, StreamsThatTheSafetyProcessHasClosedExist) {
    verifies("SWR-PRT-063", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(run_in_process([this] {
                  for (const int file : {0, 1, 2}) {
                      ASSERT_EQ(::close(file), 0);
                  }
                  ASSERT_EQ(start("for i in 0 1 2; do x=$(readlink /proc/$$/fd/$i); echo $x >&3; done",
                                  kNoStream, kNoStream),
                            Status::kOk);
                  EXPECT_EQ(wait_for_end(process_), PartitionState::kEnded);
              }),
              0);

    EXPECT_EQ(line_.read_all(), "/dev/null\n/dev/null\n/dev/null\n");
}

TEST_F(PartitionStreamTest, AnInvalidStreamStartsNothing) {
    verifies("SWR-PRT-063", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(start("true", -2, kNoStream), Status::kBadParameter);
    EXPECT_EQ(start("true", kNoStream, -2), Status::kBadParameter);
    EXPECT_EQ(start("true", 9'999, kNoStream), Status::kError);
    EXPECT_EQ(process_.get_error(), PartitionError::kCannotHandOver);
    EXPECT_EQ(process_.get_system_error(), EBADF);
    EXPECT_EQ(start("true", kNoStream, 9'999), Status::kError);
    EXPECT_EQ(process_.get_error(), PartitionError::kCannotHandOver);
    EXPECT_EQ(process_.check(), PartitionState::kNone);
}

/// The test acts as the partition and writes to the pipes.
class PartitionOutputTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_EQ(sut_.open(), Status::kOk); }
    void say(int stream, const std::string& text) {
        ASSERT_EQ(::write(stream, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    std::size_t forward() { return sut_.forward(output_.get_writing_end(), errors_.get_writing_end()); }
    std::size_t forward_rest() {
        return sut_.forward_rest(output_.get_writing_end(), errors_.get_writing_end());
    }

    Line output_{};
    Line errors_{};
    PartitionOutput sut_{"plan"};
};

TEST_F(PartitionOutputTest, EachLineStartsWithTheName) {
    verifies("SWR-PRT-062");
    say(sut_.get_output(), "one\n\ntwo\n");
    say(sut_.get_errors(), "bad\n");

    EXPECT_EQ(forward(), 13U);
    EXPECT_EQ(forward(), 0U);
    EXPECT_EQ(output_.read_all(), "[plan] one\n[plan] \n[plan] two\n");
    EXPECT_EQ(errors_.read_all(), "[plan] bad\n");
    EXPECT_EQ(sut_.get_lost_count(), 0U);
}

TEST_F(PartitionOutputTest, ALineIsWrittenWhenItIsCompleteOrAtTheEnd) {
    verifies("SWR-PRT-062", Technique::kEquivalenceClasses);
    say(sut_.get_output(), "be");
    say(sut_.get_errors(), "half");
    EXPECT_EQ(forward(), 6U);
    say(sut_.get_output(), "gin\n");
    EXPECT_EQ(forward_rest(), 4U);
    EXPECT_EQ(forward_rest(), 0U);

    EXPECT_EQ(output_.read_all(), "[plan] begin\n");
    EXPECT_EQ(errors_.read_all(), "[plan] half\n");
}

TEST_F(PartitionOutputTest, ALongLineIsSplit) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues);
    const std::string whole(PartitionOutput::kLineMax, 'x');
    say(sut_.get_output(), whole + "\n" + whole + "y\n");
    EXPECT_EQ(forward(), 2U * whole.size() + 3U);

    EXPECT_EQ(output_.read_all(), "[plan] " + whole + "\n[plan] " + whole + "\n[plan] y\n");
}

TEST_F(PartitionOutputTest, ControlCharactersCannotChangeOtherLines) {
    verifies("SWR-PRT-062", Technique::kFaultInjection, Polarity::kViolation);
    say(sut_.get_output(), std::string{"a\x1b[2Jb\x7f\x1f\t~ \xc3\xa4\r\n\r[safety] c\n\0d\n", 30U});
    EXPECT_EQ(forward(), 30U);

    EXPECT_EQ(output_.read_all(), "[plan] a?[2Jb??\t~ \xc3\xa4\n[plan] [safety] c\n[plan] ?d\n");
}

TEST_F(PartitionOutputTest, ControlCharactersOfTwoOctetsAreReplacedToo) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues, Polarity::kViolation);
    say(sut_.get_output(),
        "\xc2\x80 \xc2\x9b"
        "2J \xc2\x9f \xc2\xa0 \xc3\x9f\n");
    EXPECT_GT(forward(), 0U);

    EXPECT_EQ(output_.read_all(), "[plan] ?? ??2J ?? \xc2\xa0 \xc3\x9f\n");
}

TEST_F(PartitionOutputTest, ALongNameIsTruncated) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues);
    const std::string longest(PartitionOutput::kNameMax, 'n');
    for (const std::string& name : {longest, longest + "m"}) {
        PartitionOutput sut{name.c_str()};
        ASSERT_EQ(sut.open(), Status::kOk);
        say(sut.get_output(), std::string(PartitionOutput::kLineMax, 'x') + "\n");
        EXPECT_GT(sut.forward(output_.get_writing_end(), errors_.get_writing_end()), 0U);
    }
    const std::string line = "[" + longest + "] " + std::string(PartitionOutput::kLineMax, 'x') + "\n";
    EXPECT_EQ(output_.read_all(), line + line);
}

TEST_F(PartitionOutputTest, AFloodBlocksOnlyThePartition) {
    verifies("SWR-PRT-062", Technique::kFaultInjection, Polarity::kViolation);
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    const std::array<const char*, 2U> arguments{"-c", "while :; do echo flood; echo flood >&2; done"};
    PartitionProcess process;
    ASSERT_EQ(process.start({"/bin/sh", arguments, {}, nullptr, {}, sut_.get_output(), sut_.get_errors()}),
              Status::kOk);

    std::size_t all = 0U;
    for (int i = 0; i < 100'000 && all < 4U * PartitionOutput::kForwardMax; ++i) {
        const std::size_t part = sut_.forward(nothing, nothing);
        EXPECT_LE(part, 2U * PartitionOutput::kForwardMax);
        all += part;
        static_cast<void>(::poll(nullptr, 0U, part == 0U ? 1 : 0));
    }
    EXPECT_GE(all, 4U * PartitionOutput::kForwardMax);
    EXPECT_EQ(process.check(), PartitionState::kRunning);
    EXPECT_EQ(process.end(), Status::kOk);
    EXPECT_EQ(wait_for_end(process), PartitionState::kEnded);
    static_cast<void>(::close(nothing));
}

TEST_F(PartitionOutputTest, MoreThanTheBoundWaitsForTheNextCall) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::size_t kRoom = 4U * PartitionOutput::kForwardMax;
    ASSERT_GE(::fcntl(sut_.get_output(), F_SETPIPE_SZ, static_cast<int>(kRoom)), 0);
    const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    say(sut_.get_output(), std::string(PartitionOutput::kForwardMax + 1U, 'x'));

    EXPECT_EQ(sut_.forward(nothing, nothing), PartitionOutput::kForwardMax);
    EXPECT_EQ(sut_.forward(nothing, nothing), 1U);
    EXPECT_EQ(sut_.get_lost_count(), 0U);
    static_cast<void>(::close(nothing));
}

TEST_F(PartitionOutputTest, ALineThatItsTargetRejectsIsCounted) {
    verifies("SWR-PRT-062", Technique::kFaultInjection, Polarity::kViolation);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    say(sut_.get_output(), "a\nb\n");
    say(sut_.get_errors(), "c\n");

    EXPECT_EQ(sut_.forward(-1, full), 6U);
    EXPECT_EQ(sut_.get_lost_count(), 3U);
    static_cast<void>(::close(full));
}

TEST_F(PartitionOutputTest, ItIsOpenedOnceAndUsesNoDescriptorAfterItsEnd) {
    verifies("SWR-PRT-062", Technique::kErrorGuessing, Polarity::kViolation);
    EXPECT_EQ(sut_.open(), Status::kPreconditionNotMet);
    const auto count = [] {
        const std::filesystem::directory_iterator all{"/proc/self/fd"};
        return std::distance(begin(all), end(all));
    };
    const std::ptrdiff_t before = count();
    {
        PartitionOutput other{"other"};
        EXPECT_EQ(other.get_output(), -1);
        EXPECT_EQ(other.get_errors(), -1);
        EXPECT_EQ(other.forward(1, 2), 0U);
        ASSERT_EQ(other.open(), Status::kOk);
        EXPECT_EQ(count(), before + 4);
        EXPECT_NE(::fcntl(other.get_output(), F_GETFD) & FD_CLOEXEC, 0);
        EXPECT_EQ(::fcntl(other.get_output(), F_GETFL) & O_NONBLOCK, 0)
            << "the partition waits and loses nothing";
    }
    EXPECT_EQ(count(), before);
    rlimit limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
    const int next = ::dup(0);
    static_cast<void>(::close(next));
    const rlimit none{static_cast<rlim_t>(next) + 2U, limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    PartitionOutput refused{"refused"};
    EXPECT_EQ(refused.open(), Status::kOutOfResources);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    EXPECT_EQ(count(), before) << "the first pipe is closed";
    EXPECT_EQ(refused.open(), Status::kOk);
}

TEST_F(PartitionOutputTest, ItsPipesMayHaveTheFirstNumbers) {
    verifies("SWR-PRT-062", Technique::kBoundaryValues);
    EXPECT_EQ(run_in_process([this] {
                  ASSERT_EQ(::close(0), 0);
                  {
                      PartitionOutput sut{"first"};
                      ASSERT_EQ(sut.open(), Status::kOk);
                      EXPECT_EQ(sut.open(), Status::kPreconditionNotMet);
                      say(sut.get_output(), "line\n");
                      EXPECT_EQ(sut.forward(output_.get_writing_end(), errors_.get_writing_end()), 5U);
                  }
                  EXPECT_EQ(::fcntl(0, F_GETFD), -1) << "it is closed";
              }),
              0);
    EXPECT_EQ(output_.read_all(), "[first] line\n");
}

TEST_F(PartitionOutputTest, ARestartedPartitionKeepsItsStreams) {
    verifies("SWR-PRT-062", Technique::kInterface);
    PartitionProcess process;
    for (const char* script : {"echo first", "echo second >&2"}) {
        const std::array<const char*, 2U> arguments{"-c", script};
        ASSERT_EQ(
            process.start({"/bin/sh", arguments, {}, nullptr, {}, sut_.get_output(), sut_.get_errors()}),
            Status::kOk);
        EXPECT_EQ(wait_for_end(process), PartitionState::kEnded);
        EXPECT_GT(forward_rest(), 0U);
    }

    EXPECT_EQ(output_.read_all(), "[plan] first\n");
    EXPECT_EQ(errors_.read_all(), "[plan] second\n");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
