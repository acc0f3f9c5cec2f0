// SPDX-License-Identifier: Apache-2.0
// Goal: for any behaviour of the other side, a reader gets intact messages or none, ends in bounded time and
// accesses only its memory. Method: both sides of each limit; a write that ends after each of its stores; a
// writer that is killed at random instants; memory with random bytes, with valid messages that have single
// changed words, and with words that change during the read. Seeds are printed on failure.
#include "mamori/ports/posix_rt/shared_frame.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr std::size_t kCapacity = 29U;  // not a multiple of the word size
constexpr std::size_t kSize = calc_frame_region_size(kCapacity);
constexpr std::size_t kWordCount = kSize / sizeof(std::uint64_t);

/// Exactly the required size, so that a sanitizer detects each access beyond it.
using Region = std::vector<std::uint64_t>;
using Bytes = std::vector<std::byte>;

Span<std::byte> view(Region& region) {
    return {reinterpret_cast<std::byte*>(region.data()), region.size() * sizeof(std::uint64_t)};
}
Span<const std::byte> view_const(Region& region) {
    return {reinterpret_cast<const std::byte*>(region.data()), region.size() * sizeof(std::uint64_t)};
}

/// Content whose bytes and length depend on a number.
Bytes make_content(std::uint64_t number) {
    Bytes content(1U + number % kCapacity);
    for (std::size_t i = 0U; i < content.size(); ++i) {
        content[i] = static_cast<std::byte>((number * 0x9E3779B97F4A7C15U) >> (8U * (i % 8U)));
    }
    return content;
}

Status write_next(FrameWriter& writer, std::uint64_t number) {
    const Bytes content = make_content(number);
    return writer.write({content.data(), content.size()}, Instant{static_cast<std::int64_t>(number)});
}

/// A reader with its buffer.
struct Side {
    FrameReader reader{};
    Bytes content = Bytes(kCapacity);
    FrameFacts facts{};

    FrameOutcome take() { return reader.take({content.data(), content.size()}, facts); }
    /// True if the last message read equals the message that was written with its number.
    bool is_whole() const {
        const Bytes expected = make_content(facts.number);
        return facts.length == expected.size() &&
               facts.published_at.ns == static_cast<std::int64_t>(facts.number) &&
               std::equal(expected.begin(), expected.end(), content.begin());
    }
};

class SharedFrameTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(writer_.open(view(region_), kCapacity), Status::kOk);
        ASSERT_EQ(side_.reader.open(view_const(region_), kCapacity), Status::kOk);
    }

    Region region_ = Region(kWordCount);
    FrameWriter writer_{};
    Side side_{};
};

TEST_F(SharedFrameTest, EachMessageArrivesOnceWithItsFacts) {
    verifies("SWR-PRT-010");

    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    for (std::uint64_t number = 1U; number <= 100U; ++number) {
        ASSERT_EQ(write_next(writer_, number), Status::kOk);
        ASSERT_EQ(side_.take(), FrameOutcome::kNew);
        EXPECT_EQ(side_.facts.number, number);
        EXPECT_TRUE(side_.is_whole());
        EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    }
}

TEST_F(SharedFrameTest, TheNewestMessageIsReadAndItsNumberGivesTheLostCount) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues);
    for (std::uint64_t number = 1U; number <= 9U; ++number) {
        ASSERT_EQ(write_next(writer_, number), Status::kOk);
    }

    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_EQ(side_.facts.number, 9U);
    EXPECT_TRUE(side_.is_whole());
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
}

TEST_F(SharedFrameTest, LengthsFromZeroToTheCapacityArriveAndLongerOnesAreRejected) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues, Polarity::kViolation);
    const Bytes longest(kCapacity + 1U, std::byte{7U});

    ASSERT_EQ(writer_.write({longest.data(), kCapacity}, Instant{-1}), Status::kOk);
    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_EQ(side_.facts.length, kCapacity);
    EXPECT_EQ(side_.facts.published_at, Instant{-1});
    ASSERT_EQ(writer_.write({}, Instant{}), Status::kOk);
    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_EQ(side_.facts.length, 0U);
    EXPECT_EQ(writer_.write({longest.data(), kCapacity + 1U}, Instant{}), Status::kBadParameter);
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
}

TEST_F(SharedFrameTest, AMemoryOfWrongSizeIsRejectedByBothSides) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues, Polarity::kViolation);
    FrameWriter writer;
    FrameReader reader;
    Region larger(kWordCount + 1U);
    const Span<std::byte> whole = view(region_);
    const Span<std::byte> crooked{view(larger).data() + 1U, kSize};

    EXPECT_EQ(writer.open({whole.data(), kSize - 1U}, kCapacity), Status::kBadParameter);
    EXPECT_EQ(writer.open(crooked, kCapacity), Status::kBadParameter);
    EXPECT_EQ(writer.open({}, kCapacity), Status::kBadParameter);
    EXPECT_EQ(writer.open(whole, 0U), Status::kBadParameter);
    EXPECT_EQ(writer.open(whole, kFrameCapacityMax + 1U), Status::kBadParameter);
    EXPECT_EQ(reader.open({whole.data(), kSize - 1U}, kCapacity), Status::kBadParameter);
    EXPECT_EQ(reader.open({crooked.data(), kSize}, kCapacity), Status::kBadParameter);
    EXPECT_EQ(reader.open({whole.data(), kSize}, 0U), Status::kBadParameter);
    EXPECT_EQ(writer.write({}, Instant{}), Status::kPreconditionNotMet);
    EXPECT_EQ(writer.get_capacity() + reader.get_capacity(), 0U);
    FrameFacts facts;
    EXPECT_EQ(reader.take({}, facts), FrameOutcome::kNothingNew);
}

TEST_F(SharedFrameTest, TheSmallestAndTheLargestCapacityAreAccepted) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues);
    for (const std::size_t capacity : {std::size_t{1U}, std::size_t{1'048'576U}}) {
        Region region(calc_frame_region_size(capacity) / sizeof(std::uint64_t));
        FrameWriter writer;
        FrameReader reader;
        ASSERT_EQ(writer.open(view(region), capacity), Status::kOk) << capacity;
        ASSERT_EQ(reader.open(view_const(region), capacity), Status::kOk) << capacity;
        Bytes content(capacity, std::byte{7U});
        ASSERT_EQ(writer.write({content.data(), content.size()}, Instant{}), Status::kOk);
        Bytes taken(capacity);
        FrameFacts facts;
        EXPECT_EQ(reader.take({taken.data(), taken.size()}, facts), FrameOutcome::kNew);
        EXPECT_EQ(taken, content);
    }
}

TEST_F(SharedFrameTest, WordsAreAtThePlacesOfTheFormat) {
    verifies("SWR-PRT-010", Technique::kInterface);
    constexpr std::size_t kSlot = 3U + 4U;  // words: number, instant, length, and 29 bytes
    const std::array<std::byte, 9U> content{std::byte{1U}, std::byte{2U}, std::byte{3U},
                                            std::byte{4U}, std::byte{5U}, std::byte{6U},
                                            std::byte{7U}, std::byte{8U}, std::byte{9U}};
    ASSERT_EQ(writer_.write(content, Instant{-3}), Status::kOk);

    EXPECT_EQ(region_[0U], 1U) << "newest";
    const std::size_t slot = 1U + kSlot;  // number 1 of 4
    EXPECT_EQ(region_[slot], 1U);
    EXPECT_EQ(region_[slot + 1U], ~std::uint64_t{2U});
    EXPECT_EQ(region_[slot + 2U], 9U);
    EXPECT_EQ(region_[slot + 3U], 0x0807060504030201U);
    EXPECT_EQ(region_[slot + 4U], 9U);
    EXPECT_EQ(region_[slot + 5U], 0U);
}

TEST_F(SharedFrameTest, ABufferWithoutRoomForALongestFrameIsRejected) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues, Polarity::kViolation);
    FrameReader reader;
    Bytes content(kCapacity);
    FrameFacts facts;
    const auto take = [&](std::size_t size) {
        static_cast<void>(reader.take({content.data(), size}, facts));
    };

    take(0U);  // without a memory there is nothing to take
    const Span<std::byte> memory = view(region_);
    ASSERT_EQ(reader.open({memory.data(), kSize}, kCapacity), Status::kOk);
    take(kCapacity);
    EXPECT_CHECK_FAILS(take(kCapacity - 1U), "shared_frame.cpp", 1);
}

TEST_F(SharedFrameTest, NumbersWrapAroundAndSkipZero) {
    verifies("SWR-PRT-010", Technique::kBoundaryValues);
    region_[0U] = ~std::uint64_t{0U} - 1U;
    ASSERT_EQ(writer_.open(view(region_), kCapacity), Status::kOk);

    ASSERT_EQ(writer_.write({}, Instant{}), Status::kOk);
    ASSERT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_EQ(side_.facts.number, ~std::uint64_t{0U});
    ASSERT_EQ(write_next(writer_, 1U), Status::kOk);
    ASSERT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_EQ(side_.facts.number, 1U);
    EXPECT_TRUE(side_.is_whole());
}

TEST_F(SharedFrameTest, MessagesOfASecondWriterAreNew) {
    verifies("SWR-PRT-010");
    ASSERT_EQ(write_next(writer_, 1U), Status::kOk);
    ASSERT_EQ(side_.take(), FrameOutcome::kNew);
    FrameWriter successor;

    ASSERT_EQ(successor.open(view(region_), kCapacity), Status::kOk);
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    ASSERT_EQ(write_next(successor, 2U), Status::kOk);
    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_TRUE(side_.is_whole());
}

/// Repeats the stores of the writer in their order.
TEST_F(SharedFrameTest, AnIncompleteWriteIsNotSeenAfterAnyOfItsStores) {
    verifies("SWR-PRT-011", Technique::kFaultInjection, Polarity::kViolation);
    for (std::uint64_t number = 1U; number <= 8U; ++number) {
        ASSERT_EQ(write_next(writer_, number), Status::kOk);
    }
    const Region before = region_;
    ASSERT_EQ(write_next(writer_, 9U), Status::kOk);
    const Region after = region_;
    const std::size_t slot = 1U + 9U % 4U * (kWordCount - 1U) / 4U;
    const std::size_t words = 3U + (make_content(9U).size() + 7U) / 8U;
    region_ = before;
    ASSERT_EQ(side_.take(), FrameOutcome::kNew);
    ASSERT_EQ(side_.facts.number, 8U);

    region_[slot] = 0U;
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    for (std::size_t i = 1U; i < words; ++i) {
        region_[slot + i] = after[slot + i];
        EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew) << i;
    }
    region_[slot] = after[slot];
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    region_[0U] = after[0U];
    EXPECT_EQ(region_, after);
    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    EXPECT_TRUE(side_.is_whole());
}

TEST_F(SharedFrameTest, AnInconsistentMessageIsTornAndAnOverlongOneMalformed) {
    verifies("SWR-PRT-011", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(write_next(writer_, 1U), Status::kOk);
    const std::size_t slot = 1U + (kWordCount - 1U) / 4U;

    region_[0U] = 5U;  // its slot contains number 1
    EXPECT_EQ(side_.take(), FrameOutcome::kTorn);
    EXPECT_EQ(side_.take(), FrameOutcome::kTorn);
    region_[slot] = 5U;
    region_[slot + 2U] = kCapacity + 1U;
    EXPECT_EQ(side_.take(), FrameOutcome::kMalformed);
    EXPECT_EQ(side_.take(), FrameOutcome::kNothingNew);
    region_[0U] = region_[slot] = 9U;
    region_[slot + 2U] = kCapacity;
    EXPECT_EQ(side_.take(), FrameOutcome::kNew);
    region_[0U] = region_[slot] = 13U;
    region_[slot + 2U] = ~std::uint64_t{0U};
    EXPECT_EQ(side_.take(), FrameOutcome::kMalformed);
}

TEST_F(SharedFrameTest, RandomBytesAreReadWithinTheMemoryAndItsLimits) {
    verifies("SWR-PRT-011", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 40417U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random{kSeed};
    std::size_t news = 0U;

    for (int round = 0; round < 200'000; ++round) {
        const bool is_mutation = random() % 2U == 0U;
        if (is_mutation) {
            ASSERT_EQ(write_next(writer_, random()), Status::kOk);
            region_[random() % kWordCount] = random() % 2U == 0U ? random() : random() % 64U;
        } else {
            for (std::uint64_t& word : region_) {
                word = random() % 3U == 0U ? random() % 8U : random();
            }
        }
        const FrameOutcome outcome = side_.take();
        if (outcome == FrameOutcome::kNew) {
            ++news;
            ASSERT_LE(side_.facts.length, kCapacity);
            ASSERT_EQ(side_.facts.number, region_[0U]);
        }
    }
    EXPECT_GT(news, 1000U) << "too few of the memories led to a read";
}

TEST_F(SharedFrameTest, MessagesThatAreOverwrittenDuringTheReadAreNeverMixed) {
    verifies("SWR-PRT-011", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr std::uint64_t kFrames = 300'000U;
    std::thread thread{[this] {
        for (std::uint64_t number = 1U; number <= kFrames; ++number) {
            static_cast<void>(write_next(writer_, number));
        }
    }};
    std::uint64_t last = 0U;
    std::size_t news = 0U;

    while (last < kFrames) {
        const FrameOutcome outcome = side_.take();
        ASSERT_NE(outcome, FrameOutcome::kMalformed);
        if (outcome == FrameOutcome::kNew) {
            ASSERT_TRUE(side_.is_whole()) << side_.facts.number;
            ASSERT_GT(side_.facts.number, last);
            last = side_.facts.number;
            ++news;
        }
    }
    thread.join();
    RecordProperty("frames_read", static_cast<int>(news));
}

TEST_F(SharedFrameTest, WordsThatChangeDuringTheReadAreHarmless) {
    verifies("SWR-PRT-011", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 977U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::atomic<bool> is_ending{false};
    std::thread thread{[this, &is_ending] {
        std::mt19937_64 random{kSeed};
        while (!is_ending.load(std::memory_order_relaxed)) {
            const std::uint64_t value = random() % 2U == 0U ? random() : random() % 64U;
            __atomic_store_n(&region_[random() % kWordCount], value, __ATOMIC_RELAXED);
        }
    }};

    for (int i = 0; i < 300'000; ++i) {
        if (side_.take() == FrameOutcome::kNew) {
            ASSERT_LE(side_.facts.length, kCapacity);
        }
    }
    is_ending.store(true, std::memory_order_relaxed);
    thread.join();
}

/// Writes until it is killed.
[[noreturn]] void write_until_killed(std::byte* memory) {
    FrameWriter writer;
    if (writer.open({memory, kSize}, kCapacity) != Status::kOk) {
        ::_exit(1);
    }
    FrameReader reader;
    Bytes content(kCapacity);
    FrameFacts facts;
    static_cast<void>(reader.open({memory, kSize}, kCapacity));
    std::uint64_t number =
        reader.take({content.data(), content.size()}, facts) == FrameOutcome::kNew ? facts.number : 0U;
    for (;;) {
        ++number;
        static_cast<void>(write_next(writer, number));
    }
}

TEST_F(SharedFrameTest, AWriterKilledAtRandomInstantsLeavesIntactMessages) {
    verifies("SWR-PRT-011", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 5501U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 random{kSeed};
    void* const shared = ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    ASSERT_EQ(side_.reader.open({static_cast<const std::byte*>(shared), kSize}, kCapacity), Status::kOk);
    std::uint64_t last = 0U;

    for (int round = 0; round < 60; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            write_until_killed(static_cast<std::byte*>(shared));
        }
        const auto spins = static_cast<std::size_t>(random() % 4000U);
        for (std::size_t seen = 0U; seen <= spins;) {
            const FrameOutcome outcome = side_.take();
            ASSERT_NE(outcome, FrameOutcome::kMalformed);
            if (outcome == FrameOutcome::kNew) {
                ASSERT_TRUE(side_.is_whole());
                ASSERT_GT(side_.facts.number, last);
                last = side_.facts.number;
            }
            seen += last > 0U ? 1U : 0U;
        }
        ASSERT_EQ(::kill(child, SIGKILL), 0);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status));
        const FrameOutcome outcome = side_.take();
        ASSERT_TRUE(outcome == FrameOutcome::kNothingNew ||
                    (outcome == FrameOutcome::kNew && side_.is_whole()));
        last = side_.facts.number;
    }
    static_cast<void>(::munmap(shared, kSize));
}

}  // namespace
}  // namespace mamori::ports::posix_rt
