// SPDX-License-Identifier: Apache-2.0
// Goal: messages travel over an LCM network in both directions, every lost one is counted, and what cannot be
// opened says why. Method: memq:// in one process; multicast in a network namespace that the test makes for
// itself, which needs root. MAMORI_LCM_SECONDS prolongs the run at 1 kHz, 1 s by default.
#include "mamori/ports/lcm/lcm_link.hpp"

#include <gtest/gtest.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/ports/lcm/log_player.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/free_descriptor.hpp"
#include "support/interrupted_call.hpp"
#include "support/sample_types.hpp"
#include "support/temporary_folder.hpp"
#include "support/thread_policy.hpp"
#include "support/zero_descriptor.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using lcm_sample::find_free_descriptor;
using lcm_sample::wait_until;
using Message = lcm_sample::CloudMessage;
using Queue = MessageQueue<Message, 200U>;
using namespace verification;

constexpr const char* kMulticast = "udpm://239.255.76.67:7667?ttl=0";

class LcmLinkTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (link_.open("memq://") == Status::kUnsupported) {
            GTEST_SKIP() << get_advice(link_.get_fault());
        }
        link_.close();
    }

    LcmLink link_;
    Queue queue_;
    Span<const std::byte> message_{};
};

TEST_F(LcmLinkTest, MessagesOfTheChannelArriveAndOthersDoNot) {
    verifies("SWR-LCM-011", Technique::kInterface, Polarity::kNominal);
    ASSERT_EQ(link_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(link_.open("memq://"), Status::kOk);
    LcmSender sender(link_, "STATE");
    LcmSender other(link_, "STATES");
    ASSERT_EQ(sender.open(), Status::kOk);
    ASSERT_EQ(other.open(), Status::kOk);
    safety::E2eProtector<Message::Profile> protector(Message::kChannel);
    std::vector<std::byte> octets(Message::kSizeMax);
    const Result<std::size_t> size =
        encode_protected<Message>(Cloud{}, protector, {octets.data(), octets.size()});

    ASSERT_EQ(other.send({octets.data(), size.get_value()}), Status::kOk);
    ASSERT_EQ(sender.send({octets.data(), size.get_value()}), Status::kOk);
    ASSERT_TRUE(wait_until([&] { return queue_.take(message_) == Status::kOk; }));
    EXPECT_EQ(message_.size(), size.get_value());
    EXPECT_EQ(queue_.get_counts().accepted, 1U);
    EXPECT_TRUE(link_.is_receiving());
    link_.close();
    EXPECT_FALSE(link_.is_receiving());
    EXPECT_EQ(sender.send({octets.data(), size.get_value()}), Status::kPreconditionNotMet);
}

TEST_F(LcmLinkTest, ForeignTruncatedAndOversizedMessagesAreCounted) {
    verifies("SWR-LCM-011", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(link_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(link_.open("memq://"), Status::kOk);
    LcmSender sender(link_, "STATE");
    ASSERT_EQ(sender.open(), Status::kOk);
    std::vector<std::byte> octets(Message::kSizeMax + 100'000U);
    const std::uint64_t fingerprint = Message::kFingerprint;

    ASSERT_EQ(sender.send({octets.data(), 100U}), Status::kOk);
    ASSERT_EQ(sender.send({octets.data(), 5U}), Status::kOk);
    for (std::size_t i = 0U; i < kFingerprintSize; ++i) {
        octets[i] = static_cast<std::byte>(fingerprint >> (56U - 8U * i));
    }
    ASSERT_EQ(sender.send({octets.data(), octets.size()}), Status::kOk);
    ASSERT_TRUE(wait_until([&] { return queue_.get_counts().oversized == 1U; }));
    EXPECT_EQ(queue_.get_counts().foreign, 1U);
    EXPECT_EQ(queue_.get_counts().truncated, 1U);
    EXPECT_EQ(queue_.take(message_), Status::kPreconditionNotMet);
}

TEST_F(LcmLinkTest, ALinkReceivesWhileItIsOpenAndClosesWhenItIsDestroyed) {
    verifies("SWR-LCM-010", Technique::kStateTransition, Polarity::kNominal);
    const int free = find_free_descriptor();
    {
        LcmLink link;
        EXPECT_FALSE(link.is_open());
        EXPECT_FALSE(link.is_receiving());
        ASSERT_EQ(link.open("memq://"), Status::kOk);
        EXPECT_TRUE(link.is_receiving());
        EXPECT_NE(find_free_descriptor(), free);
    }
    EXPECT_EQ(find_free_descriptor(), free);
}

TEST_F(LcmLinkTest, EachChannelOfALinkWithDescriptorZeroHasItsQueue) {
    verifies("SWR-LCM-011", Technique::kBoundaryValues, Polarity::kNominal);
    const lcm_sample::ZeroDescriptorScope scope;
    Queue other;
    ASSERT_EQ(link_.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(link_.receive("OTHER", other), Status::kOk);
    ASSERT_EQ(link_.open("memq://"), Status::kOk);
    const std::array<std::byte, 1U> message{};

    ASSERT_EQ(link_.publish("OTHER", {message.data(), message.size()}), Status::kOk);
    EXPECT_TRUE(wait_until([&] { return other.get_counts().truncated == 1U; }));
    ASSERT_EQ(link_.publish("STATE", {message.data(), message.size()}), Status::kOk);
    EXPECT_TRUE(wait_until([&] { return queue_.get_counts().truncated == 1U; }));
    EXPECT_EQ(other.get_counts().truncated, 1U);
    link_.close();
}

TEST_F(LcmLinkTest, AProcessWithoutDescriptorsIsToldWhatIsMissing) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit none{0U, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    EXPECT_EQ(link_.open("memq://"), Status::kError);
    EXPECT_EQ(link_.get_fault(), LinkFault::kThread);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);

    EXPECT_EQ(link_.open("memq://"), Status::kOk);
}

TEST_F(LcmLinkTest, AUrlThatLcmDoesNotOpenIsReported) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    const int free = find_free_descriptor();
    for (const char* url : {"nonsense://x", "udpm", "file:///nonexistent/log?mode=r"}) {
        EXPECT_EQ(link_.open(url), Status::kError) << url;
        EXPECT_EQ(link_.get_fault(), LinkFault::kUrl) << url;
        EXPECT_FALSE(link_.is_open());
        EXPECT_EQ(find_free_descriptor(), free) << url;
    }
    EXPECT_NE(std::string(get_advice(LinkFault::kUrl)).find("udpm://"), std::string::npos);
    ASSERT_EQ(link_.open("memq://"), Status::kOk);
    EXPECT_EQ(link_.get_fault(), LinkFault::kNone);
    EXPECT_EQ(link_.open("memq://"), Status::kPreconditionNotMet);
    EXPECT_EQ(link_.receive("STATE", queue_), Status::kPreconditionNotMet);
}

TEST_F(LcmLinkTest, AnInvalidChannelAndOneTooManyAreRejected) {
    verifies("SWR-LCM-010", Technique::kBoundaryValues, Polarity::kViolation);
    const std::string longest(LcmLink::kChannelNameMax, 'a');
    const std::string longer = longest + 'a';
    for (const char* name : {"", "STATE.*", "a b", longer.c_str()}) {
        EXPECT_EQ(link_.receive(name, queue_), Status::kBadParameter) << name;
        EXPECT_EQ(link_.get_fault(), LinkFault::kChannel) << name;
    }
    for (int channel = 0; channel < 16; ++channel) {  // the advice names this number
        ASSERT_EQ(link_.receive(longest.c_str(), queue_), Status::kOk);
    }
    EXPECT_EQ(link_.receive("STATE", queue_), Status::kOutOfResources);
    EXPECT_EQ(link_.get_fault(), LinkFault::kSubscribe);
}

TEST_F(LcmLinkTest, ASenderWithAnInvalidChannelDoesNotOpenAndSendsNothing) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(link_.open("memq://"), Status::kOk);
    const std::string longer(LcmLink::kChannelNameMax + 1U, 'a');
    const std::array<std::byte, 8U> message{};
    for (const char* name : {"", "STATE.*", "a b", longer.c_str()}) {
        LcmSender sender(link_, name);
        EXPECT_EQ(sender.open(), Status::kBadParameter) << name;
        EXPECT_EQ(sender.get_fault(), LinkFault::kChannel) << name;
        EXPECT_EQ(sender.send({message.data(), message.size()}), Status::kPreconditionNotMet) << name;
    }
    LcmSender good(link_, "STATE");
    EXPECT_EQ(good.send({message.data(), message.size()}), Status::kPreconditionNotMet);  // not opened
    EXPECT_EQ(good.open(), Status::kOk);
    EXPECT_EQ(good.get_fault(), LinkFault::kNone);
    EXPECT_EQ(good.send({message.data(), message.size()}), Status::kOk);
}

TEST_F(LcmLinkTest, ALogOfTheOfficialLibraryIsReplayed) {
    verifies("SWR-LCM-012", Technique::kBackToBack, Polarity::kNominal);
    const lcm_sample::TemporaryFolder folder;
    const std::string path = folder.get_path("log");
    ASSERT_EQ(link_.open(("file://" + path + "?mode=w").c_str()), Status::kOk);
    LcmSender sender(link_, "STATE");
    ASSERT_EQ(sender.open(), Status::kOk);
    safety::E2eProtector<Message::Profile> protector(Message::kChannel);
    std::vector<std::byte> octets(Message::kSizeMax);
    for (int i = 0; i < 100; ++i) {
        Cloud value{};
        value.last.f = i;
        const Result<std::size_t> size =
            encode_protected<Message>(value, protector, {octets.data(), octets.size()});
        ASSERT_EQ(sender.send({octets.data(), size.get_value()}), Status::kOk);
    }
    link_.close();

    static LogPlayer player;
    ASSERT_EQ(player.receive("STATE", queue_), Status::kOk);
    ASSERT_EQ(player.open(path.c_str()), Status::kOk);
    EXPECT_EQ(player.deliver_until(Instant{3'600'000'000'000}), Status::kPreconditionNotMet);
    for (int i = 0; i < 100; ++i) {
        Cloud value{};
        ASSERT_EQ(queue_.take(message_), Status::kOk);
        ASSERT_EQ(decode_protected<Message>(message_, value), Status::kOk);
        EXPECT_EQ(value.last.f, i);
    }
}

/// Multicast in a network namespace of a child process, which ends with it.
class LcmMulticastTest : public LcmLinkTest {
  protected:
    /// Runs `body` in the child. @param[in] has_route whether multicast has a route. Skips the test without
    /// root.
    static void run_isolated(bool has_route, const std::function<void()>& body) {
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            if (::unshare(CLONE_NEWNET) != 0 || !open_loopback(has_route)) {
                ::_exit(2);
            }
            body();
            ::_exit(::testing::Test::HasFailure() ? 1 : 0);
        }
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {
            GTEST_SKIP() << "a network namespace with a multicast route needs root";
        }
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    }

  private:
    static bool open_loopback(bool has_route) {
        const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
        ifreq device{};
        std::strncpy(device.ifr_name, "lo", IFNAMSIZ - 1);
        device.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK | IFF_MULTICAST;
        bool is_open = socket >= 0 && ::ioctl(socket, SIOCSIFFLAGS, &device) == 0;
        if (is_open && has_route) {
            rtentry route{};
            sockaddr_in address{};
            address.sin_family = AF_INET;
            address.sin_addr.s_addr = htonl(0xE0000000U);
            std::memcpy(&route.rt_dst, &address, sizeof address);
            address.sin_addr.s_addr = htonl(0xF0000000U);
            std::memcpy(&route.rt_genmask, &address, sizeof address);
            char name[] = "lo";
            route.rt_dev = name;
            route.rt_flags = RTF_UP;
            is_open = ::ioctl(socket, SIOCADDRT, &route) == 0;
        }
        return ::close(socket) == 0 && is_open;
    }
};

/// Waits for the instant `ns` after `begin`.
void wait_for_cycle(const timespec& begin, std::int64_t ns) {
    const std::int64_t due = begin.tv_nsec + ns;
    const timespec at{begin.tv_sec + due / 1'000'000'000, due % 1'000'000'000};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
    }
}

TEST_F(LcmMulticastTest, AtOneKilohertzEachMessageIsUsedOrCountedAsLost) {
    verifies("SWR-LCM-008", Technique::kInterface, Polarity::kNominal);
    const char* const seconds = std::getenv("MAMORI_LCM_SECONDS");
    const int count = 1000 * (seconds != nullptr ? std::atoi(seconds) : 1);
    run_isolated(true, [count] {
        static Queue queue;
        static LcmLink sending;
        static LcmLink receiving;
        ASSERT_EQ(receiving.receive("STATE", queue), Status::kOk);
        ASSERT_EQ(receiving.open(kMulticast), Status::kOk) << get_advice(receiving.get_fault());
        ASSERT_EQ(sending.open(kMulticast), Status::kOk);
        LcmSender sink(sending, "STATE");
        ASSERT_EQ(sink.open(), Status::kOk);
        LinkSender<Message> sender("sender", sink);
        LinkReceiver<Message, Queue> receiver("receiver", queue, {30'000U});  // a loaded host stalls
        OutPort<Cloud> source(kNoOwner, "source");
        timespec begin{};
        ASSERT_EQ(::clock_gettime(CLOCK_MONOTONIC, &begin), 0);
        int newest = -1;

        // After the last message, at most 10 s for those that are on their way.
        for (int i = 0; i < count + 10'000 && newest + 1 < count; ++i) {
            const Instant now{std::int64_t{i} * 1'000'000};
            if (i < count) {
                Cloud value{};
                value.last.f = i;
                source.write(value);
                ASSERT_TRUE(source.publish(now));
                sender.in.take(source.get_published_sample());
                ASSERT_EQ(sender.on_execute({0, now}), Status::kOk);
                sender.in.mark_read();
            }
            wait_for_cycle(begin, now.ns);
            ASSERT_EQ(receiver.on_execute({0, now}), Status::kOk);
            if (receiver.out.publish(now)) {
                ASSERT_GT(receiver.out.get_published().last.f, newest);
                newest = receiver.out.get_published().last.f;
            }
        }

        const LinkNews news = receiver.get_news();
        EXPECT_EQ(sender.get_failed_count(), 0U);
        EXPECT_EQ(newest, count - 1);
        EXPECT_EQ(news.used + news.lost + news.initial, static_cast<std::uint32_t>(count));
        EXPECT_EQ(news.damaged + news.unordered + news.foreign + news.truncated + news.oversized, 0U);
        std::cout << "sent " << count << ", used " << news.used << ", lost " << news.lost << ", initial "
                  << news.initial << ", overwritten " << news.overwritten << std::endl;
        sending.close();
        receiving.close();
    });
}

TEST_F(LcmMulticastTest, TheThreadsOfLcmHaveNoRealTimePriorityEvenIfTheCreatorHas) {
    verifies("SWR-LCM-007", Technique::kFaultInjection, Polarity::kViolation);
    run_isolated(true, [] {
        const lcm_sample::RealTimeScope real_time;
        static Queue queue;
        static LcmLink receiving;
        ASSERT_EQ(receiving.receive("STATE", queue), Status::kOk);
        ASSERT_EQ(receiving.open(kMulticast), Status::kOk);

        const lcm_sample::OtherThreads threads = lcm_sample::count_other_threads();
        EXPECT_TRUE(real_time.is_granted());
        EXPECT_GE(threads.count, 2);  // of this port and of liblcm
        EXPECT_EQ(threads.real_time, 0);
        receiving.close();
    });
}

TEST_F(LcmMulticastTest, SignalsDoNotEndTheOpenCallAndAMessageThatLcmRefusesIsReported) {
    verifies("SWR-LCM-011", Technique::kFaultInjection, Polarity::kViolation);
    run_isolated(true, [] {
        const lcm_sample::SignalScope scope(SIGUSR1);
        std::atomic<bool> is_done{false};
        std::thread sender([&is_done, opener = ::pthread_self()] {
            while (!is_done) {
                EXPECT_EQ(::pthread_kill(opener, SIGUSR1), 0);
                ::poll(nullptr, 0U, 1);
            }
        });
        static LcmLink link;
        const Status opened = link.open(kMulticast);
        is_done = true;
        sender.join();
        const std::string longer(LcmLink::kChannelNameMax + 1U, 'a');
        const std::array<std::byte, 1U> message{};

        EXPECT_EQ(opened, Status::kOk);
        EXPECT_EQ(link.publish(longer.c_str(), {message.data(), message.size()}), Status::kError);
        EXPECT_EQ(link.publish("STATE", {message.data(), message.size()}), Status::kOk);
        link.close();
    });
}

TEST_F(LcmMulticastTest, WithoutAMulticastRouteTheLinkDoesNotOpenAndSaysWhy) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    run_isolated(false, [] {
        static Queue queue;
        static LcmLink receiving;
        ASSERT_EQ(receiving.receive("STATE", queue), Status::kOk);
        EXPECT_EQ(receiving.open(kMulticast), Status::kError);
        EXPECT_EQ(receiving.get_fault(), LinkFault::kUrl);
        EXPECT_NE(std::strstr(get_advice(receiving.get_fault()), "ip route add"), nullptr);
    });
}

}  // namespace
}  // namespace mamori::ports::lcm
