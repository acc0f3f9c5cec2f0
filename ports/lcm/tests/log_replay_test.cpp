// SPDX-License-Identifier: Apache-2.0
// Goal: a replay delivers a log up to its end, prints the same text each time, and reports damage with its
// place. Method: logs written by hand; the output goes to a file. A whole program is replayed in
// verification/integration.
#include "mamori/ports/lcm/log_replay.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "support/interrupted_call.hpp"
#include "support/log_writer.hpp"
#include "support/sample_types.hpp"
#include "support/temporary_folder.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using Message = lcm_sample::CloudMessage;
using Queue = MessageQueue<Message, 8U>;
using namespace verification;

constexpr std::int64_t kMs = 1'000'000;

class LogReplayTest : public ::testing::Test {
  protected:
    LogReplayTest() : file_(::open(text_path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)) {}
    void TearDown() override { static_cast<void>(::close(file_)); }
    std::vector<std::byte> make_message() {
        std::vector<std::byte> octets(Message::kSizeMax);
        const Result<std::size_t> size =
            encode_protected<Message>(Cloud{}, protector_, {octets.data(), octets.size()});
        octets.resize(size.get_value());
        return octets;
    }
    Status open(bool has_hash = true) {
        std::ofstream(path_, std::ios::binary) << writer_.log;
        const std::array<const char*, 3U> arguments{"program", "--replay", path_.c_str()};
        return sut_->open(channels_, has_hash, 3, arguments.data());
    }
    std::string read_text() const {
        std::ifstream in(text_path_);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }

    lcm_sample::TemporaryFolder folder_{};
    std::string path_{folder_.get_path("log")};
    std::string text_path_{path_ + ".text"};
    int file_;
    lcm_sample::LogWriter writer_{};
    safety::E2eProtector<Message::Profile> protector_{Message::kChannel};
    Queue queue_;
    LinkReceiver<Message, Queue> receiver_{"receiver", queue_, {50U}};
    std::vector<ReplayChannel> channel_list_{replay_channel("STATE", queue_, receiver_)};
    Span<const ReplayChannel> channels_{channel_list_.data(), channel_list_.size()};
    std::unique_ptr<LogReplay> sut_{std::make_unique<LogReplay>(file_, file_)};
};

TEST_F(LogReplayTest, EventsAreDeliveredAtTheirFrameAndTheRunEndsOneFrameAfterTheLast) {
    verifies("SWR-LCM-014", Technique::kRequirementsBased, Polarity::kNominal);
    writer_.add_event(0, "STATE", make_message());
    writer_.add_event(500, "OTHER", {});
    writer_.add_event(1500, "STATE", make_message());
    writer_.add_event(2000, "STATE", make_message());
    ASSERT_EQ(open(), Status::kOk);

    const std::array<std::uint32_t, 4U> expected{1U, 1U, 3U, 3U};
    for (std::size_t frame = 0U; frame < expected.size(); ++frame) {
        const Instant start{static_cast<std::int64_t>(frame) * kMs};
        EXPECT_EQ(sut_->advance(start), frame < 3U) << frame;
        EXPECT_EQ(queue_.get_counts().accepted, expected[frame]) << frame;
        ASSERT_EQ(receiver_.on_execute({0, start}), Status::kOk);
    }
    EXPECT_EQ(sut_->report(4U), Status::kOk);
    sut_->report_hash(1U, 0xABCDEF0123456789U);

    EXPECT_EQ(read_text(),
              "channel STATE: used 1, lost 0, damaged 0, unordered 0, initial 2, foreign 0, truncated 0, "
              "oversized 0, overwritten 0\nevents 4, frames 4\ncore 1: trace hash abcdef0123456789\n");
}

TEST_F(LogReplayTest, TheCountersOfEachChannelAreThoseOfItsReceiver) {
    verifies("SWR-LCM-014", Technique::kInterface, Polarity::kNominal);
    const LinkNews news{1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, true};
    channel_list_[0].receiver = &news;
    channel_list_[0].get_news = [](const void* pointer) { return *static_cast<const LinkNews*>(pointer); };
    writer_.add_event(0, "STATE", {});
    ASSERT_EQ(open(), Status::kOk);

    EXPECT_EQ(sut_->report(0U), Status::kOk);

    EXPECT_EQ(read_text(),
              "channel STATE: used 1, lost 2, damaged 3, unordered 4, initial 5, foreign 6, truncated 7, "
              "oversized 8, overwritten 9, closed\nevents 0, frames 0\n");
}

TEST_F(LogReplayTest, ADamagedLogIsReportedWithItsOffset) {
    verifies("SWR-LCM-014", Technique::kFaultInjection, Polarity::kViolation);
    writer_.add_event(0, "STATE", make_message());
    const std::size_t good = writer_.log.size();
    writer_.add_event(1, "STATE", make_message());
    writer_.log.resize(good + 30U);
    ASSERT_EQ(open(), Status::kOk);

    EXPECT_TRUE(sut_->advance(Instant{0}));
    EXPECT_FALSE(sut_->advance(Instant{kMs}));
    EXPECT_EQ(sut_->report(2U), Status::kError);

    EXPECT_NE(read_text().find(path_ + ": damaged at offset " + std::to_string(good) +
                               "; the events before it were replayed\n"),
              std::string::npos)
        << read_text();
}

TEST_F(LogReplayTest, APauseOfMoreThanAnHourEndsTheReplay) {
    verifies("SWR-LCM-014", Technique::kBoundaryValues, Polarity::kViolation);
    writer_.add_event(0, "STATE", make_message());
    writer_.add_event(2'000'000, "STATE", make_message());
    const std::size_t good = writer_.log.size();
    writer_.add_event(4'000'000'000, "STATE", make_message());
    ASSERT_EQ(open(), Status::kOk);
    constexpr Duration kHour{3'600'000 * kMs};
    const Instant last{2000 * kMs};

    EXPECT_TRUE(sut_->advance(Instant{0}));
    EXPECT_TRUE(sut_->advance(last));
    EXPECT_TRUE(sut_->advance(last + kHour));
    EXPECT_FALSE(sut_->advance(last + kHour + Duration{1}));
    EXPECT_EQ(sut_->report(4U), Status::kError);

    EXPECT_NE(read_text().find("no event for an hour before offset " + std::to_string(good)),
              std::string::npos)
        << read_text();
}

TEST_F(LogReplayTest, ThePauseBeginsAtTheLastEventAlsoIfTheFirstFrameIsLate) {
    verifies("SWR-LCM-014", Technique::kBoundaryValues, Polarity::kNominal);
    writer_.add_event(0, "STATE", make_message());
    writer_.add_event(8'000'000'000, "STATE", make_message());
    ASSERT_EQ(open(), Status::kOk);

    EXPECT_TRUE(sut_->advance(Instant{0} + LogReplay::kPauseMax + Duration{1}));
    EXPECT_EQ(sut_->report(1U), Status::kOk);
}

TEST_F(LogReplayTest, WrongArgumentsAreRejectedInOneLine) {
    verifies("SWR-LCM-014", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::array<const char*, 4U> arguments{"program", "--replay", "/nonexistent/log", "more"};
    const std::array<const char*, 3U> other{"program", "--record", "log"};
    EXPECT_EQ(sut_->open(channels_, true, 2, arguments.data()), Status::kBadParameter);
    EXPECT_EQ(sut_->open(channels_, true, 4, arguments.data()), Status::kBadParameter);
    EXPECT_EQ(sut_->open(channels_, true, 3, other.data()), Status::kBadParameter);
    EXPECT_EQ(sut_->open(channels_, true, 0, nullptr), Status::kBadParameter);
    EXPECT_EQ(sut_->open(channels_, true, 3, arguments.data()), Status::kError);

    EXPECT_EQ(read_text(),
              "usage: program --replay LOG\nusage: program --replay LOG\nusage: program --replay LOG\n"
              "usage: PROGRAM --replay LOG\n/nonexistent/log: cannot be read, or is not a log of lcm-logger; "
              "specify the log\n");
}

TEST_F(LogReplayTest, ALineHasUpTo1024CharactersAndTheLargestNumbers) {
    verifies("SWR-LCM-014", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string program(2000U, 'p');
    const std::array<const char*, 1U> arguments{program.c_str()};
    EXPECT_EQ(sut_->open(channels_, true, 1, arguments.data()), Status::kBadParameter);
    EXPECT_EQ(read_text(), "usage: " + std::string(1017U, 'p'));
    ASSERT_EQ(::ftruncate(file_, 0), 0);
    ASSERT_EQ(::lseek(file_, 0, SEEK_SET), 0);

    constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(sut_->report(kLargest), Status::kOk);
    sut_->report_hash(0U, kLargest);
    EXPECT_EQ(read_text(), "events 0, frames 18446744073709551615\ncore 0: trace hash ffffffffffffffff\n");
}

TEST_F(LogReplayTest, AfterARefusedPartOfALineNothingMoreOfItIsWritten) {
    verifies("SWR-LCM-014", Technique::kFaultInjection, Polarity::kViolation);
    {
        const lcm_sample::OneOctetScope scope;
        sut_->report_failure();
    }
    EXPECT_EQ(lcm_sample::SignalScope::count, 1);  // the second part
    EXPECT_EQ(read_text(), "t");
}

TEST_F(LogReplayTest, ATableWithoutHashIsRejected) {
    verifies("SWR-LCM-014", Technique::kErrorGuessing, Polarity::kViolation);
    writer_.add_event(0, "STATE", {});

    EXPECT_EQ(open(false), Status::kBadParameter);

    EXPECT_NE(read_text().find("has no trace_hash()"), std::string::npos);
}

TEST_F(LogReplayTest, AnInvalidChannelIsNamed) {
    verifies("SWR-LCM-014", Technique::kErrorGuessing, Polarity::kViolation);
    writer_.add_event(0, "STATE", {});
    channel_list_[0].name = "STATE.*";

    EXPECT_EQ(open(), Status::kBadParameter);

    EXPECT_NE(read_text().find("channel 'STATE.*': invalid channel"), std::string::npos);
}

TEST_F(LogReplayTest, ASystemThatFailsAndAnOutputThatCannotBeWrittenDoNotHang) {
    verifies("SWR-LCM-014", Technique::kFaultInjection, Polarity::kViolation);
    sut_->report_failure();
    EXPECT_EQ(read_text(), "the system did not start or stop; check its components\n");
    LogReplay closed(-1, -1);
    closed.report_failure();
    EXPECT_EQ(closed.report(0U), Status::kOk);
}

}  // namespace
}  // namespace mamori::ports::lcm
