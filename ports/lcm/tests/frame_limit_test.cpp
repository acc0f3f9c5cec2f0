// SPDX-License-Identifier: Apache-2.0
// Goal: transports of frames keep their limits, and leave nothing behind in the process. Method: the largest
// datagram and one octet more; each speed of a pseudo-terminal and its neighbours; the descriptors and the
// signal mask of the process.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "mamori/ports/lcm/frame_link.hpp"
#include "mamori/safety/e2e/protector.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/free_descriptor.hpp"
#include "support/interrupted_call.hpp"
#include "support/sample_types.hpp"
#include "support/zero_descriptor.hpp"

namespace lcm_limit {

/// Frames of the protected form have up to 2048 octets.
struct Large {
    mamori::BoundedSequence<std::uint8_t, 2009U> octets{};
};

}  // namespace lcm_limit

MAMORI_LCM_FIELDS(lcm_limit::Large, octets)

namespace lcm_limit {

inline constexpr mamori::safety::SentIdChannel kLargeChannel{
    1U, mamori::ports::lcm::kChannelLengthMin<Large, lcm_sample::Profile>,
    mamori::ports::lcm::kChannelLengthMax<Large, lcm_sample::Profile>, 0U};
using LargeMessage = mamori::ports::lcm::LcmMessage<Large, lcm_sample::Profile, kLargeChannel>;

}  // namespace lcm_limit

namespace mamori::ports::lcm {
namespace {

using lcm_limit::LargeMessage;
using lcm_sample::find_free_descriptor;
using lcm_sample::wait_until;
using namespace verification;

constexpr std::size_t kDatagram = 2048U;
static_assert(calc_frame_size_max(LargeMessage::kSizeMax) == kDatagram);

using Octets = std::vector<std::byte>;

class FrameLimitTest : public ::testing::Test {
  protected:
    static Octets make_message(std::size_t size) {
        safety::E2eProtector<LargeMessage::Profile> protector(LargeMessage::kChannel);
        lcm_limit::Large value{};
        EXPECT_EQ(value.octets.resize(size), Status::kOk);
        for (std::uint8_t& octet : value.octets) {
            octet = 0x5AU;
        }
        Octets octets(LargeMessage::kSizeMax);
        octets.resize(
            encode_protected<LargeMessage>(value, protector, {octets.data(), octets.size()}).get_value());
        return octets;
    }
    static Octets make_frame(const Octets& message) {
        Octets frame(calc_frame_size_max(message.size()));
        frame.resize(
            encode_frame({message.data(), message.size()}, {frame.data(), frame.size()}).get_value());
        return frame;
    }
    /// Sends datagrams of any content to the receiver.
    void send(const std::vector<Octets>& datagrams) const {
        const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(receiver_.get_port());
        ASSERT_EQ(::inet_pton(AF_INET, "127.0.0.1", &place.sin_addr), 1);
        for (const Octets& datagram : datagrams) {
            ASSERT_EQ(::sendto(socket, datagram.data(), datagram.size(), 0,
                               reinterpret_cast<sockaddr*>(&place), sizeof place),
                      static_cast<ssize_t>(datagram.size()));
        }
        ASSERT_EQ(::close(socket), 0);
    }

    MessageQueue<LargeMessage, 4U> queue_;
    FrameReceiverFor<LargeMessage> receiver_{queue_};
    FrameSenderFor<LargeMessage> sender_;
};

TEST_F(FrameLimitTest, TheLongestMessageOfADatagramArrives) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kNominal);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);
    const Octets message = make_message(2009U);
    ASSERT_EQ(message.size(), LargeMessage::kSizeMax);

    ASSERT_EQ(sender_.send({message.data(), message.size()}), Status::kOk);
    Span<const std::byte> received;
    ASSERT_TRUE(wait_until([&] { return queue_.take(received) == Status::kOk; }));
    EXPECT_EQ(Octets(received.begin(), received.end()), message);
}

TEST_F(FrameLimitTest, OctetsBeyondTheLongestDatagramAreNotRead) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    Octets longer(kDatagram + 1U);
    longer.back() = std::byte{5};  // would begin a frame, which the next delimiter cuts
    send({longer, make_frame(make_message(1U))});

    Span<const std::byte> received;
    ASSERT_TRUE(wait_until([&] { return queue_.take(received) == Status::kOk; }));
    EXPECT_EQ(queue_.get_counts().damaged, 0U);
}

TEST_F(FrameLimitTest, ATransportThatIsClosedDestroyedOrNotOpenedReleasesItsDescriptors) {
    verifies("SWR-LCM-010", Technique::kStateTransition, Polarity::kViolation);
    const int free = find_free_descriptor();
    {
        FrameReceiverFor<LargeMessage> receiver(queue_);
        FrameSenderFor<LargeMessage> sender;
        ASSERT_EQ(receiver.open_udp("127.0.0.1", 0U), Status::kOk);
        ASSERT_EQ(sender.open_udp("127.0.0.1", receiver.get_port()), Status::kOk);
        EXPECT_NE(find_free_descriptor(), free);
        FrameReceiverFor<LargeMessage> second(queue_);
        const int next = find_free_descriptor();
        EXPECT_EQ(second.open_udp("127.0.0.1", receiver.get_port()), Status::kError);
        EXPECT_EQ(second.open_serial("/dev/null", 9600U), Status::kError);
        EXPECT_EQ(find_free_descriptor(), next);
    }
    EXPECT_EQ(find_free_descriptor(), free);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", 7000U), Status::kOk);
    sender_.close();
    EXPECT_EQ(find_free_descriptor(), free);
    EXPECT_EQ(sender_.open_udp("127.0.0.1", 7000U), Status::kOk);
}

TEST_F(FrameLimitTest, ASenderWorksWithDescriptorZero) {
    verifies("SWR-LCM-010", Technique::kBoundaryValues, Polarity::kNominal);
    const Octets message = make_message(1U);
    const lcm_sample::ZeroDescriptorScope scope;
    ASSERT_EQ(sender_.open_udp("127.0.0.1", 7000U), Status::kOk);
    EXPECT_NE(find_free_descriptor(), 0);
    EXPECT_EQ(sender_.open_udp("127.0.0.1", 7000U), Status::kPreconditionNotMet);
    EXPECT_EQ(sender_.open_serial("/dev/null", 9600U), Status::kPreconditionNotMet);
    EXPECT_EQ(sender_.send({message.data(), message.size()}), Status::kOk);
    sender_.close();
    EXPECT_EQ(find_free_descriptor(), 0);
    EXPECT_EQ(sender_.open_serial("/dev/null", 9600U), Status::kError);
    EXPECT_EQ(sender_.get_fault(), LinkFault::kLine);  // it was opened
}

TEST_F(FrameLimitTest, AReceiverWorksWithDescriptorZero) {
    verifies("SWR-LCM-010", Technique::kBoundaryValues, Polarity::kNominal);
    const lcm_sample::ZeroDescriptorScope scope;
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kPreconditionNotMet);
    EXPECT_EQ(receiver_.open_serial("/dev/null", 9600U), Status::kPreconditionNotMet);
    send({make_frame(make_message(1U))});
    Span<const std::byte> received;
    EXPECT_TRUE(wait_until([&] { return queue_.take(received) == Status::kOk; }));
    receiver_.close();
    EXPECT_EQ(find_free_descriptor(), 0);
}

TEST_F(FrameLimitTest, EachEventOfAStreamIsCountedOnceByItsCause) {
    verifies("SWR-LCM-009", Technique::kEquivalenceClasses, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    const Octets oversized = make_frame(Octets(3000U, std::byte{0x5A}));
    const auto half = oversized.begin() + 1500;
    send({{oversized.begin(), half}, {half, oversized.end()}, make_frame(make_message(1U))});

    Span<const std::byte> received;
    ASSERT_TRUE(wait_until([&] { return queue_.take(received) == Status::kOk; }));
    const ReceptionCounts counts = queue_.get_counts();
    EXPECT_EQ(counts.accepted, 1U);
    EXPECT_EQ(counts.oversized, 1U);
    EXPECT_EQ(counts.damaged + counts.truncated + counts.foreign, 0U);
}

/// From now on, this process starts no thread. @return false: not supported on this system.
bool refuse_threads() {
    constexpr auto kNumber = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
    std::array<sock_filter, 5U> steps{{
        {BPF_LD | BPF_W | BPF_ABS, 0U, 0U, kNumber},
        {BPF_JMP | BPF_JEQ | BPF_K, 1U, 0U, SYS_clone},
        {BPF_JMP | BPF_JEQ | BPF_K, 0U, 1U, SYS_clone3},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ERRNO | EAGAIN},
        {BPF_RET | BPF_K, 0U, 0U, SECCOMP_RET_ALLOW},
    }};
    const sock_fprog program{static_cast<unsigned short>(steps.size()), steps.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1UL, 0UL, 0UL, 0UL) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST_F(FrameLimitTest, AProcessThatStartsNoThreadIsToldAndKeepsNoDescriptor) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (!refuse_threads()) {
            ::_exit(2);
        }
        const int free = find_free_descriptor();
        EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kError);
        EXPECT_EQ(receiver_.get_fault(), LinkFault::kThread);
        EXPECT_EQ(find_free_descriptor(), free);
        receiver_.close();
        ::_exit(HasFailure() ? 1 : 0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 2) {
        GTEST_SKIP() << "verdict=not-shown: a system without filters of system calls";
    }
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(FrameLimitTest, ProgramsThatTheProcessStartsDoNotInheritATransport) {
    verifies("SWR-LCM-010", Technique::kErrorGuessing, Polarity::kViolation);
    const int first = find_free_descriptor();
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);
    const int end = find_free_descriptor();

    ASSERT_EQ(end - first, 3);  // a socket and the stop event, a socket
    for (int descriptor = first; descriptor < end; ++descriptor) {
        EXPECT_EQ(::fcntl(descriptor, F_GETFD), FD_CLOEXEC) << descriptor;
    }
    EXPECT_NE(::fcntl(first, F_GETFL) & O_NONBLOCK, 0);
}

/// Keeps the blocked signals of the thread that gives it a message.
class SignalInbox final : public MessageInbox {
  public:
    SignalInbox() : MessageInbox(kLimitsOf<LargeMessage>) {}
    std::atomic<int> blocked_count{-1};

  private:
    void store(Span<const std::byte> /*message*/) noexcept override { blocked_count = count_blocked(); }
    std::uint32_t get_overwritten_count() const noexcept override { return 0U; }

  public:
    /// Of the signals that a process can block.
    static int count_blocked() {
        sigset_t mask;
        static_cast<void>(::pthread_sigmask(SIG_SETMASK, nullptr, &mask));
        int count = 0;
        for (int signal = 1; signal < SIGSYS; ++signal) {
            count += ::sigismember(&mask, signal) == 1 ? 1 : 0;
        }
        return count;
    }
};

TEST_F(FrameLimitTest, SignalsOfTheProcessGoToOtherThreads) {
    verifies("SWR-LCM-007", Technique::kRequirementsBased, Polarity::kNominal);
    sigset_t one;
    sigset_t before;
    ASSERT_EQ(::sigemptyset(&one), 0);
    ASSERT_EQ(::sigaddset(&one, SIGUSR2), 0);
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &one, &before), 0);
    SignalInbox inbox;
    FrameReceiverFor<LargeMessage> receiver(inbox);
    ASSERT_EQ(receiver.open_udp("127.0.0.1", 0U), Status::kOk);
    EXPECT_EQ(SignalInbox::count_blocked(), 1);
    ASSERT_EQ(::pthread_sigmask(SIG_SETMASK, &before, nullptr), 0);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver.get_port()), Status::kOk);
    const Octets message = make_message(1U);

    ASSERT_EQ(sender_.send({message.data(), message.size()}), Status::kOk);
    ASSERT_TRUE(wait_until([&] { return inbox.blocked_count >= 0; }));
    EXPECT_EQ(inbox.blocked_count, SIGSYS - 3);  // all but SIGKILL and SIGSTOP
}

/// As in <asm/termbits.h>, which cannot be included with <termios.h>: the speeds are in bits per second.
struct termios2 {
    std::array<tcflag_t, 4U> flags;
    std::array<cc_t, 20U> characters;
    speed_t c_ispeed;
    speed_t c_ospeed;
};

class LineSpeedTest : public FrameLimitTest {
  protected:
    void SetUp() override {
        master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        ASSERT_GE(master_, 0);
        ASSERT_EQ(::grantpt(master_), 0);
        ASSERT_EQ(::unlockpt(master_), 0);
    }
    void TearDown() override { static_cast<void>(::close(master_)); }
    std::string get_path() const { return ::ptsname(master_); }

    int master_{-1};
};

TEST_F(LineSpeedTest, EachSpeedIsSetAndItsNeighboursAreRejected) {
    verifies("SWR-LCM-010", Technique::kBoundaryValues, Polarity::kViolation);
    constexpr std::array<std::uint32_t, 8U> kSpeeds{9600U,   19200U,  38400U,  57600U,
                                                    115200U, 230400U, 460800U, 921600U};
    const std::string path = get_path();
    for (const std::uint32_t speed : kSpeeds) {
        ASSERT_EQ(sender_.open_serial(path.c_str(), speed), Status::kOk) << speed;
        termios2 line{};
        ASSERT_EQ(::ioctl(master_, TCGETS2, &line), 0);
        EXPECT_EQ(line.c_ispeed, speed);
        EXPECT_EQ(line.c_ospeed, speed);
        sender_.close();
        for (const std::uint32_t other : {speed - 1U, speed + 1U}) {
            EXPECT_EQ(sender_.open_serial(path.c_str(), other), Status::kError) << other;
            EXPECT_EQ(sender_.get_fault(), LinkFault::kLine) << other;
        }
    }
}

TEST(LinkFaultTest, EachFaultHasAnAdviceOfItsOwn) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kNominal);
    std::set<std::string> advice;
    for (int fault = 0; fault <= static_cast<int>(LinkFault::kThread); ++fault) {
        advice.insert(get_advice(static_cast<LinkFault>(fault)));
    }
    EXPECT_EQ(advice.size(), static_cast<std::size_t>(LinkFault::kThread) + 1U);
    EXPECT_EQ(advice.count(""), 0U);
    EXPECT_EQ(advice.count("invalid fault"), 0U);
    EXPECT_STREQ(get_advice(static_cast<LinkFault>(200)), "invalid fault");
    EXPECT_STREQ(
        get_advice(LinkFault::kUrl),
        "LCM cannot open the URL; use for example udpm://239.255.76.67:7667?ttl=0, and give multicast a "
        "route: ip route add 224.0.0.0/4 dev lo");
    EXPECT_STREQ(
        get_advice(LinkFault::kSubscribe),
        "LCM cannot receive: its self test failed, or a link has more than 16 channels; allow multicast "
        "in the firewall, or use a second link");
}

}  // namespace
}  // namespace mamori::ports::lcm
