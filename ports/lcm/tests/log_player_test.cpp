// SPDX-License-Identifier: Apache-2.0
// Goal: a log of a run replays to the same outputs, and a damaged log is reported with its place. Method:
// logs in the published format, written by hand; a run with random losses in virtual time is logged and
// replayed.
#include "mamori/ports/lcm/log_player.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mamori/kernel/payload/trace_hash.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/free_descriptor.hpp"
#include "support/interrupted_call.hpp"
#include "support/log_writer.hpp"
#include "support/random_value.hpp"
#include "support/sample_types.hpp"
#include "support/temporary_folder.hpp"
#include "support/zero_descriptor.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using lcm_sample::find_free_descriptor;
using Message = lcm_sample::CloudMessage;
using Queue = MessageQueue<Message, 8U>;
using namespace verification;

class LogPlayerTest : public ::testing::Test {
  protected:
    void add_event(std::int64_t time_us, const std::string& channel, const std::vector<std::byte>& message) {
        writer_.add_event(time_us, channel, message);
    }
    Status open() {
        std::ofstream(path_, std::ios::binary) << log_;
        return player_.open(path_.c_str());
    }
    std::vector<std::byte> make_message(const Cloud& value) {
        std::vector<std::byte> octets(Message::kSizeMax);
        const Result<std::size_t> size =
            encode_protected<Message>(value, protector_, {octets.data(), octets.size()});
        octets.resize(size.get_value());
        return octets;
    }

    lcm_sample::TemporaryFolder folder_{};
    std::string path_{folder_.get_path("log")};
    lcm_sample::LogWriter writer_{};
    std::string& log_{writer_.log};
    safety::E2eProtector<Message::Profile> protector_{Message::kChannel};
    Queue queue_;
    LogPlayer player_;
};

/// Hash over all that a receiver gives in one run.
class ReceivingRun final {
  public:
    explicit ReceivingRun(Queue& queue) noexcept : receiver_("receiver", queue, {50U}) {}

    void execute(Instant now) {
        EXPECT_EQ(receiver_.on_execute({0, now}), Status::kOk);
        if (receiver_.out.publish(now)) {
            ++values_;
            hash_(now.ns);
            hash_.add(receiver_.out.get_published());
        }
        EXPECT_TRUE(receiver_.news.publish(now));
        hash_.add(receiver_.news.get_published());
    }
    std::uint64_t get_hash() const { return hash_.get_value(); }
    int get_values() const { return values_; }

  private:
    LinkReceiver<Message, Queue> receiver_;
    TraceHash hash_{};
    int values_{0};
};

TEST_F(LogPlayerTest, ALoggedRunReplaysToTheSameOutputs) {
    verifies("SWR-LCM-012", Technique::kBackToBack, Polarity::kNominal);
    constexpr int kCycles = 5000;
    constexpr std::int64_t kCycleUs = 1000;
    std::mt19937_64 random(3U);
    ReceivingRun original(queue_);
    for (int cycle = 0; cycle < kCycles; ++cycle) {
        // Lost, repeated, damaged, foreign and good messages, 0 .. 3 in a cycle; the first event is at 0.
        for (std::uint64_t count = cycle == 0 ? 1U : random() % 4U; count > 0U; --count) {
            std::vector<std::byte> octets = make_message(lcm_sample::make_random<Cloud>(random));
            const std::uint64_t kind = random() % 16U;
            if (kind == 0U) {
                continue;
            }
            if (kind <= 2U) {
                octets[random() % octets.size()] ^= std::byte{4};
            }
            for (int copy = kind == 3U ? 2 : 1; copy > 0; --copy) {
                add_event(cycle * kCycleUs, "STATE", octets);
                queue_.put({octets.data(), octets.size()});
            }
            add_event(cycle * kCycleUs, "OTHER", octets);
        }
        original.execute(Instant{cycle * kCycleUs * 1000});
    }

    Queue queue;
    ReceivingRun replay(queue);
    ASSERT_EQ(player_.receive("STATE", queue), Status::kOk);
    ASSERT_EQ(open(), Status::kOk);
    Status status = Status::kOk;
    for (int cycle = 0; cycle < kCycles; ++cycle) {
        status = player_.deliver_until(Instant{cycle * kCycleUs * 1000});
        ASSERT_NE(status, Status::kError) << player_.get_offset();
        replay.execute(Instant{cycle * kCycleUs * 1000});
    }
    EXPECT_EQ(status, Status::kPreconditionNotMet);
    EXPECT_EQ(player_.get_event_count(), writer_.event_count);
    EXPECT_GT(original.get_values(), kCycles / 2);
    EXPECT_EQ(replay.get_values(), original.get_values());
    EXPECT_EQ(replay.get_hash(), original.get_hash());
}

TEST_F(LogPlayerTest, APlayerWithoutALogIsAtItsBeginAndOneThatIsDestroyedClosesItsLog) {
    verifies("SWR-LCM-012", Technique::kStateTransition, Polarity::kNominal);
    add_event(0, "STATE", {});
    std::ofstream(path_, std::ios::binary) << log_;
    const int free = find_free_descriptor();
    {
        LogPlayer player;
        EXPECT_EQ(player.get_offset(), 0U);
        EXPECT_EQ(player.get_event_count(), 0U);
        EXPECT_EQ(player.deliver_until(Instant{0}), Status::kPreconditionNotMet);
        ASSERT_EQ(player.open(path_.c_str()), Status::kOk);
        EXPECT_NE(find_free_descriptor(), free);
    }
    EXPECT_EQ(find_free_descriptor(), free);
}

TEST_F(LogPlayerTest, EventsAreDeliveredAtTheirInstantAndNotBefore) {
    verifies("SWR-LCM-012", Technique::kBoundaryValues, Polarity::kNominal);
    add_event(0, "STATE", make_message(Cloud{}));
    add_event(1000, "STATE", make_message(Cloud{}));
    add_event(400, "STATE", make_message(Cloud{}));  // the clock of the logger was set back
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(open(), Status::kOk);

    EXPECT_EQ(player_.deliver_until(Instant{-1000}), Status::kOk);
    EXPECT_EQ(queue_.get_counts().accepted, 0U);
    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kOk);
    EXPECT_EQ(queue_.get_counts().accepted, 1U);
    EXPECT_EQ(player_.deliver_until(Instant{999'999}), Status::kOk);
    EXPECT_EQ(queue_.get_counts().accepted, 1U);
    EXPECT_EQ(player_.deliver_until(Instant{1'000'000}), Status::kPreconditionNotMet);
    EXPECT_EQ(queue_.get_counts().accepted, 3U);
}

TEST_F(LogPlayerTest, ALogThatIsOpenedAgainHasTheSameTimesAlsoWithDescriptorZero) {
    verifies("SWR-LCM-012", Technique::kBoundaryValues, Polarity::kNominal);
    add_event(0, "STATE", make_message(Cloud{}));
    add_event(1000, "STATE", make_message(Cloud{}));
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    std::ofstream(path_, std::ios::binary) << log_;
    const lcm_sample::ZeroDescriptorScope scope;
    for (std::uint32_t times = 1U; times <= 2U; ++times) {
        ASSERT_EQ(player_.open(path_.c_str()), Status::kOk);
        EXPECT_EQ(::fcntl(0, F_GETFD), FD_CLOEXEC);
        EXPECT_EQ(player_.open(path_.c_str()), Status::kPreconditionNotMet);
        EXPECT_EQ(player_.deliver_until(Instant{999'999}), Status::kOk);
        EXPECT_EQ(player_.deliver_until(Instant{1'000'000}), Status::kPreconditionNotMet);
        EXPECT_EQ(queue_.get_counts().accepted, 2U * times);
        player_.close();
        EXPECT_EQ(find_free_descriptor(), 0);
    }
}

TEST_F(LogPlayerTest, EachChannelHasItsEventsAlsoAfterALongerName) {
    verifies("SWR-LCM-012", Technique::kEquivalenceClasses, Polarity::kNominal);
    add_event(0, "STATE_OF_THE_ARM", make_message(Cloud{}));
    add_event(0, "STATE", make_message(Cloud{}));
    add_event(0, "OTHER", {});
    Queue other;
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(player_.receive("OTHER", other), Status::kOk);
    ASSERT_EQ(open(), Status::kOk);

    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kPreconditionNotMet);
    EXPECT_EQ(queue_.get_counts().accepted, 1U);
    EXPECT_EQ(other.get_counts().truncated, 1U);
}

TEST_F(LogPlayerTest, WhatIsNoLogIsRejected) {
    verifies("SWR-LCM-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(player_.open("/nonexistent/log"), Status::kError);
    EXPECT_EQ(player_.open("/"), Status::kError);
    EXPECT_EQ(open(), Status::kError);  // empty
    log_ = "no log, although it is longer than a header";
    EXPECT_EQ(open(), Status::kError);
    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kPreconditionNotMet);
    log_.clear();
    add_event(0, "STATE", {});
    EXPECT_EQ(open(), Status::kOk);
    EXPECT_EQ(open(), Status::kPreconditionNotMet);
}

TEST_F(LogPlayerTest, ALogThatIsCutAnywhereIsReportedAfterTheEventsBeforeTheCut) {
    verifies("SWR-LCM-012", Technique::kFaultInjection, Polarity::kViolation);
    add_event(0, "STATE", make_message(Cloud{}));
    const std::size_t first = log_.size();
    add_event(1, "STATE", make_message(Cloud{}));
    const std::string whole = log_;
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);

    for (std::size_t size = first + 1U; size < whole.size(); ++size) {
        log_ = whole.substr(0U, size);
        ASSERT_EQ(open(), Status::kOk);
        EXPECT_EQ(player_.deliver_until(Instant{1'000'000}), Status::kError) << size;
        EXPECT_EQ(player_.get_offset(), first);
        EXPECT_EQ(player_.get_event_count(), 1U);
        player_.close();
    }
    EXPECT_EQ(queue_.get_counts().accepted, whole.size() - first - 1U);
}

TEST_F(LogPlayerTest, LongNamesLargeMessagesAndRandomOctetsAreHandled) {
    verifies("SWR-LCM-012", Technique::kBoundaryValues, Polarity::kViolation);
    add_event(0, "STATE", std::vector<std::byte>(LogPlayer::kMessageMax + 10'000U));
    add_event(0, std::string(LogPlayer::kChannelNameMax, 'a'), make_message(Cloud{}));
    const std::size_t good = log_.size();
    add_event(0, std::string(LogPlayer::kChannelNameMax + 1U, 'a'), make_message(Cloud{}));
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(open(), Status::kOk);
    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kError);
    EXPECT_EQ(player_.get_offset(), good);
    EXPECT_EQ(queue_.get_counts().oversized, 1U);
    player_.close();

    const std::string event = log_.substr(good);
    std::mt19937_64 random(5U);
    for (int i = 0; i < 300; ++i) {
        log_ = event;
        log_[random() % 28U] = static_cast<char>(random());
        if (open() == Status::kOk) {
            static_cast<void>(player_.deliver_until(Instant{0}));
        }
        player_.close();
    }
    EXPECT_EQ(queue_.get_counts().accepted, 0U);
}

TEST_F(LogPlayerTest, ALargeMessageIsOversizedFromOneOctetAboveTheBufferOn) {
    verifies("SWR-LCM-012", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::size_t kLargest = 65536U;
    add_event(0, "STATE", std::vector<std::byte>(kLargest));
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(open(), Status::kOk);
    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kPreconditionNotMet);
    EXPECT_EQ(queue_.get_counts().foreign, 1U);  // it reached the queue, which examined it
    player_.close();

    log_.clear();
    add_event(0, "STATE", std::vector<std::byte>(kLargest + 1U));
    ASSERT_EQ(open(), Status::kOk);
    EXPECT_EQ(player_.deliver_until(Instant{0}), Status::kPreconditionNotMet);
    EXPECT_EQ(queue_.get_counts().foreign, 1U);
    EXPECT_EQ(queue_.get_counts().oversized, 1U);
}

TEST_F(LogPlayerTest, ALargeMessageThatIsCutOrHasAnImpossibleSizeIsReported) {
    verifies("SWR-LCM-012", Technique::kFaultInjection, Polarity::kViolation);
    add_event(0, "STATE", std::vector<std::byte>(LogPlayer::kMessageMax + 10'000U));
    log_.pop_back();
    EXPECT_EQ(open(), Status::kError);

    log_.clear();
    add_event(0, "STATE", {});
    log_[24U] = static_cast<char>(0x80);  // the first octet of the size
    EXPECT_EQ(open(), Status::kError);
}

TEST_F(LogPlayerTest, MoreChannelsThanTheLimitAreRejected) {
    verifies("SWR-LCM-012", Technique::kBoundaryValues, Polarity::kViolation);
    for (int channel = 0; channel < 16; ++channel) {
        ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    }
    EXPECT_EQ(player_.receive("STATE", queue_), Status::kOutOfResources);
    EXPECT_EQ(player_.get_fault(), LinkFault::kSubscribe);
}

TEST_F(LogPlayerTest, AnInvalidChannelIsRejected) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    const std::string longest(LogPlayer::kChannelNameMax, 'a');
    const std::string longer = longest + 'a';
    for (const char* name : {"", "STATE.*", "a b", longer.c_str()}) {
        EXPECT_EQ(player_.receive(name, queue_), Status::kBadParameter) << name;
        EXPECT_EQ(player_.get_fault(), LinkFault::kChannel) << name;
    }
    EXPECT_EQ(player_.receive(longest.c_str(), queue_), Status::kOk);
    EXPECT_EQ(player_.get_fault(), LinkFault::kNone);
}

TEST_F(LogPlayerTest, OnlyLettersDigitsAndFourOtherCharactersAreAllowedInAChannel) {
    verifies("SWR-LCM-010", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-/:";
    for (int code = 1; code < 256; ++code) {
        const std::string name{'a', static_cast<char>(code)};
        LogPlayer player;
        const bool is_allowed = allowed.find(static_cast<char>(code)) != std::string::npos;
        const Status expected = is_allowed ? Status::kOk : Status::kBadParameter;
        EXPECT_EQ(player.receive(name.c_str(), queue_), expected) << code;
        EXPECT_EQ(player.receive(name.c_str() + 1U, queue_), expected) << code;  // one character
    }
}

TEST_F(LogPlayerTest, ALogThatArrivesInPartsBetweenSignalsIsReadWhole) {
    verifies("SWR-LCM-012", Technique::kFaultInjection, Polarity::kNominal);
    std::mt19937_64 random(9U);
    const std::vector<std::byte> message = make_message(lcm_sample::make_random<Cloud>(random));
    add_event(0, "STATE", message);
    add_event(0, "STATE", std::vector<std::byte>(LogPlayer::kMessageMax + 100U));
    add_event(0, "STATE", message);
    ASSERT_EQ(player_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    const int other_end = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const lcm_sample::SignalScope scope(SIGUSR1);
    std::atomic<bool> is_done{false};
    // Each part waits until the part before it was read, so no call reads more than one.
    std::thread logger([this, &is_done, reader = ::pthread_self()] {
        const int file = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
        std::size_t size = 0U;
        for (std::size_t done = 0U; done < log_.size() && !is_done; done += size) {
            size = std::min<std::size_t>(done < 500U ? 7U : 3000U, log_.size() - done);
            ::poll(nullptr, 0U, done < 500U ? 1 : 0);
            EXPECT_EQ(::pthread_kill(reader, SIGUSR1), 0);
            EXPECT_EQ(::write(file, log_.data() + done, size), static_cast<ssize_t>(size));
            int waiting = 0;
            EXPECT_TRUE(lcm_sample::wait_until(
                [&] { return is_done || (::ioctl(file, FIONREAD, &waiting) == 0 && waiting == 0); }));
        }
        EXPECT_EQ(::close(file), 0);
    });
    const Status opened = player_.open(path_.c_str());
    const Status delivered = player_.deliver_until(Instant{0});
    is_done = true;
    logger.join();
    EXPECT_EQ(::close(other_end), 0);

    EXPECT_EQ(opened, Status::kOk);
    EXPECT_EQ(delivered, Status::kPreconditionNotMet);
    EXPECT_EQ(queue_.get_counts().oversized, 1U);
    for (int i = 0; i < 2; ++i) {
        Span<const std::byte> received;
        ASSERT_EQ(queue_.take(received), Status::kOk);
        EXPECT_EQ(std::vector<std::byte>(received.begin(), received.end()), message);
    }
}

}  // namespace
}  // namespace mamori::ports::lcm
