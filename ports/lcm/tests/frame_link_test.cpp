// SPDX-License-Identifier: Apache-2.0
// Goal: messages arrive over UDP and a serial line, damage included, and a transport that cannot be opened
// says why. Method: the loopback address and a pseudo-terminal; other programs are sockets of the test.
#include "mamori/ports/lcm/frame_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "mamori/safety/e2e/protector.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/sample_types.hpp"
#include "support/thread_policy.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::Cloud;
using Message = lcm_sample::CloudMessage;
using namespace verification;

constexpr std::uint32_t kSpeed = 115200U;

/// Waits until `condition` holds, 10 s at most. @return whether it holds.
bool wait_until(const std::function<bool()>& condition) {
    bool holds = condition();
    for (int i = 0; i < 10'000 && !holds; ++i) {
        ::poll(nullptr, 0U, 1);
        holds = condition();
    }
    return holds;
}

class FrameLinkTest : public ::testing::Test {
  protected:
    std::vector<std::byte> make_message(int mark) {
        std::vector<std::byte> octets(Message::kSizeMax);
        Cloud value{};
        value.last.f = mark;
        const Result<std::size_t> size =
            encode_protected<Message>(value, protector_, {octets.data(), octets.size()});
        octets.resize(size.get_value());
        return octets;
    }
    Status send(const std::vector<std::byte>& octets) { return sender_.send({octets.data(), octets.size()}); }
    static std::vector<std::byte> make_frame(const std::vector<std::byte>& message) {
        std::vector<std::byte> frame(calc_frame_size_max(message.size()));
        const Result<std::size_t> size =
            encode_frame({message.data(), message.size()}, {frame.data(), frame.size()});
        frame.resize(size.get_value());
        return frame;
    }
    /// @return content of the next message; -1 when none comes.
    int receive() {
        Span<const std::byte> message;
        Cloud value{};
        const bool has_come = wait_until([&] { return queue_.take(message) == Status::kOk; });
        return has_come && decode_protected<Message>(message, value) == Status::kOk ? value.last.f : -1;
    }

    safety::E2eProtector<Message::Profile> protector_{Message::kChannel};
    MessageQueue<Message, 8U> queue_;
    FrameReceiverFor<Message> receiver_{queue_};
    FrameSenderFor<Message> sender_;
};

TEST_F(FrameLinkTest, MessagesArriveOverUdp) {
    verifies("SWR-LCM-007", Technique::kInterface, Polarity::kNominal);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);

    for (int mark = 1; mark <= 20; ++mark) {
        ASSERT_EQ(send(make_message(mark)), Status::kOk);
        ASSERT_EQ(receive(), mark);
    }
    EXPECT_TRUE(receiver_.is_receiving());
    receiver_.close();
    EXPECT_FALSE(receiver_.is_receiving());
    EXPECT_EQ(queue_.get_counts().accepted, 20U);
}

TEST_F(FrameLinkTest, DatagramsOfAnyContentGiveNothingAndDoNotDisturbTheNextMessage) {
    verifies("SWR-LCM-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);
    const int other = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(receiver_.get_port());
    ASSERT_EQ(::inet_pton(AF_INET, "127.0.0.1", &place.sin_addr), 1);
    const std::vector<char> large(5000U, 'x');
    for (const std::string& content : {std::string(), std::string("foreign"), std::string("a\0b", 3U),
                                       std::string(large.begin(), large.end())}) {
        ASSERT_EQ(::sendto(other, content.data(), content.size(), 0, reinterpret_cast<sockaddr*>(&place),
                           sizeof place),
                  static_cast<ssize_t>(content.size()));
    }
    ASSERT_EQ(::close(other), 0);

    ASSERT_EQ(send(make_message(7)), Status::kOk);
    EXPECT_EQ(receive(), 7);
    EXPECT_EQ(queue_.get_counts().accepted, 1U);
    EXPECT_GE(queue_.get_counts().damaged, 1U);
}

TEST_F(FrameLinkTest, AnUnusableAddressOrPortIsReportedWithItsCause) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(receiver_.open_udp("localhost", 7000U), Status::kError);
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kAddress);
    EXPECT_EQ(receiver_.open_udp("192.0.2.1", 7000U), Status::kError);  // no address of this host
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kSocket);
    EXPECT_EQ(sender_.open_udp("nowhere", 7000U), Status::kError);
    EXPECT_EQ(sender_.get_fault(), LinkFault::kAddress);
    EXPECT_EQ(send(make_message(1)), Status::kPreconditionNotMet);

    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kPreconditionNotMet);
    FrameReceiverFor<Message> second(queue_);
    EXPECT_EQ(second.open_udp("127.0.0.1", receiver_.get_port()), Status::kError);
    EXPECT_EQ(second.get_fault(), LinkFault::kSocket);
}

TEST_F(FrameLinkTest, AnOpenTransportIsNotOpenedAgain) {
    verifies("SWR-LCM-010", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);

    EXPECT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kPreconditionNotMet);
    EXPECT_EQ(sender_.open_serial("/dev/null", kSpeed), Status::kPreconditionNotMet);
    EXPECT_EQ(receiver_.open_serial("/dev/null", kSpeed), Status::kPreconditionNotMet);
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kNone);
    ASSERT_EQ(send(make_message(4)), Status::kOk);
    EXPECT_EQ(receive(), 4);
}

TEST_F(FrameLinkTest, AReceiverThatIsDestroyedFreesItsPort) {
    verifies("SWR-LCM-010", Technique::kStateTransition, Polarity::kNominal);
    std::uint16_t port = 0U;
    {
        FrameReceiverFor<Message> earlier(queue_);
        ASSERT_EQ(earlier.open_udp("127.0.0.1", 0U), Status::kOk);
        port = earlier.get_port();
    }
    EXPECT_EQ(receiver_.open_udp("127.0.0.1", port), Status::kOk);
}

/// Leaves this process `count` more descriptors while it exists.
class FewDescriptors final {
  public:
    explicit FewDescriptors(rlim_t count) {
        EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &before_), 0);
        const int next = ::dup(0);
        EXPECT_EQ(::close(next), 0);
        const rlimit now{static_cast<rlim_t>(next) + count, before_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &now), 0);
    }
    FewDescriptors(const FewDescriptors&) = delete;
    FewDescriptors& operator=(const FewDescriptors&) = delete;
    ~FewDescriptors() { EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &before_), 0); }

  private:
    rlimit before_{};
};

TEST_F(FrameLinkTest, AProcessWithoutDescriptorsIsToldWhatIsMissing) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    {
        const FewDescriptors none(0U);
        EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kError);
        EXPECT_EQ(receiver_.get_fault(), LinkFault::kSocket);
    }
    {
        const FewDescriptors one(1U);
        EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kError);
        EXPECT_EQ(receiver_.get_fault(), LinkFault::kThread);
        EXPECT_FALSE(receiver_.is_receiving());
        EXPECT_EQ(receiver_.get_port(), 0U);
    }
    const FewDescriptors two(2U);
    EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
}

TEST_F(FrameLinkTest, ATransportThatOpensReportsNoFault) {
    verifies("SWR-LCM-010", Technique::kRequirementsBased, Polarity::kNominal);
    EXPECT_EQ(receiver_.open_udp("localhost", 7000U), Status::kError);
    EXPECT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kNone);
    EXPECT_NE(receiver_.get_port(), 0U);
}

TEST_F(FrameLinkTest, TheReceivingThreadHasNoRealTimePriorityEvenIfItsCreatorHas) {
    verifies("SWR-LCM-007", Technique::kFaultInjection, Polarity::kViolation);
    const lcm_sample::RealTimeScope real_time;
    if (!real_time.is_granted()) {
        GTEST_SKIP() << "a real-time priority needs root";
    }
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);

    const lcm_sample::OtherThreads threads = lcm_sample::count_other_threads();
    EXPECT_GE(threads.count, 1);
    EXPECT_EQ(threads.real_time, 0);
}

/// Keeps the stack size of the thread that gives it a message.
class StackInbox final : public MessageInbox {
  public:
    StackInbox() : MessageInbox(kLimitsOf<Message>) {}
    std::atomic<std::size_t> stack_size{0U};

  private:
    void store(Span<const std::byte> /*message*/) noexcept override {
        pthread_attr_t attributes;
        std::size_t size = 0U;
        if (::pthread_getattr_np(::pthread_self(), &attributes) == 0) {
            static_cast<void>(::pthread_attr_getstacksize(&attributes, &size));
            static_cast<void>(::pthread_attr_destroy(&attributes));
        }
        stack_size = size;
    }
    std::uint32_t get_overwritten_count() const noexcept override { return 0U; }
};

TEST_F(FrameLinkTest, TheReceivingThreadHasASmallStackBecauseARealTimeProcessLocksIt) {
    verifies("SWR-LCM-007", Technique::kBoundaryValues, Polarity::kNominal);
    StackInbox inbox;
    FrameReceiverFor<Message> receiver(inbox);
    ASSERT_EQ(receiver.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver.get_port()), Status::kOk);

    ASSERT_EQ(send(make_message(1)), Status::kOk);
    ASSERT_TRUE(wait_until([&] { return inbox.stack_size != 0U; }));
    EXPECT_GE(inbox.stack_size, 256U * 1024U);
    // The default of Linux is 8 MiB; the thread sanitizer adds its own data.
    EXPECT_LE(inbox.stack_size, 2U * 1024U * 1024U);
}

TEST_F(FrameLinkTest, AMessageLongerThanTheSenderWasMadeForIsRejected) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);

    EXPECT_EQ(send(std::vector<std::byte>(Message::kSizeMax)), Status::kOk);
    EXPECT_EQ(send(std::vector<std::byte>(Message::kSizeMax + 300U)), Status::kBadParameter);
}

TEST_F(FrameLinkTest, AFrameThatWasCutBeforeASecondOpenIsForgotten) {
    verifies("SWR-LCM-009", Technique::kStateTransition, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    const int other = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(receiver_.get_port());
    ASSERT_EQ(::inet_pton(AF_INET, "127.0.0.1", &place.sin_addr), 1);
    std::vector<std::byte> octets = make_frame(make_message(1));
    const std::vector<std::byte> frame = make_frame(make_message(2));
    octets.insert(octets.end(), frame.begin(),
                  frame.begin() + static_cast<std::ptrdiff_t>(frame.size() / 2U));
    ASSERT_EQ(
        ::sendto(other, octets.data(), octets.size(), 0, reinterpret_cast<sockaddr*>(&place), sizeof place),
        static_cast<ssize_t>(octets.size()));
    ASSERT_EQ(::close(other), 0);
    ASSERT_EQ(receive(), 1);
    receiver_.close();

    ASSERT_EQ(receiver_.open_udp("127.0.0.1", 0U), Status::kOk);
    ASSERT_EQ(sender_.open_udp("127.0.0.1", receiver_.get_port()), Status::kOk);
    ASSERT_EQ(send(make_message(3)), Status::kOk);
    EXPECT_EQ(receive(), 3);
    EXPECT_EQ(queue_.get_counts().damaged, 0U);
}

/// Both ends of a pseudo-terminal.
class SerialLinkTest : public FrameLinkTest {
  protected:
    void SetUp() override {
        master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
        ASSERT_GE(master_, 0);
        ASSERT_EQ(::grantpt(master_), 0);
        ASSERT_EQ(::unlockpt(master_), 0);
        path_ = ::ptsname(master_);
        line_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
        ASSERT_GE(line_, 0);
    }
    void TearDown() override {
        if (line_ >= 0) {
            ::close(line_);
        }
        if (master_ >= 0) {
            ::close(master_);
        }
    }
    void write(const std::vector<std::byte>& octets) const {
        ASSERT_EQ(::write(master_, octets.data(), octets.size()), static_cast<ssize_t>(octets.size()));
    }
    termios get_settings() const {
        termios line{};
        EXPECT_EQ(::tcgetattr(line_, &line), 0);
        return line;
    }

    int master_{-1};
    int line_{-1};  ///< keeps the settings and the octets of the line
    std::string path_{};
};

TEST_F(SerialLinkTest, MessagesAfterNoiseAndAFrameThatWasCutAreFound) {
    verifies("SWR-LCM-007", Technique::kInterface, Polarity::kNominal);
    ASSERT_EQ(receiver_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    std::vector<std::byte> cut = make_frame(make_message(1));
    cut.resize(cut.size() / 2U);
    write(std::vector<std::byte>(30U, std::byte{0x11}));  // XON: a line that is not raw would swallow it
    write(cut);
    write(make_frame(make_message(2)));
    EXPECT_EQ(receive(), 2);
    EXPECT_GE(queue_.get_counts().damaged, 1U);
}

TEST_F(SerialLinkTest, ASenderWritesWholeFramesToTheLine) {
    verifies("SWR-LCM-007", Technique::kInterface, Polarity::kNominal);
    ASSERT_EQ(sender_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    const std::vector<std::byte> message = make_message(3);
    ASSERT_EQ(send(message), Status::kOk);

    const std::vector<std::byte> expected = make_frame(message);
    std::vector<std::byte> read(expected.size());
    ASSERT_EQ(::read(master_, read.data(), read.size()), static_cast<ssize_t>(read.size()));
    EXPECT_EQ(read, expected);
}

TEST_F(SerialLinkTest, AFullLineLosesMessagesAndDoesNotWait) {
    verifies("SWR-LCM-007", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sender_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    // The line moves octets on by itself: it is full when it has refused several messages in a row.
    int refused = 0;
    for (int i = 0; i < 10'000 && refused < 3; ++i) {
        const Status status = send(make_message(i));
        ASSERT_TRUE(status == Status::kOk || status == Status::kOutOfResources) << i;
        refused = status == Status::kOk ? 0 : refused + 1;
    }
    EXPECT_EQ(refused, 3);
    ::close(master_);
    master_ = -1;
    EXPECT_EQ(send(make_message(1)), Status::kError);
}

TEST_F(SerialLinkTest, SettingsOfAnEarlierProgramDoNotRemain) {
    verifies("SWR-LCM-007", Technique::kFaultInjection, Polarity::kViolation);
    constexpr tcflag_t kControl = CSTOPB | CRTSCTS | PARENB | CSIZE | CREAD | CLOCAL;
    constexpr tcflag_t kInput = IXON | IXOFF | IXANY | INPCK;
    termios line = get_settings();
    line.c_cflag = (line.c_cflag | CSTOPB | CRTSCTS) & ~static_cast<tcflag_t>(CLOCAL);
    line.c_iflag |= kInput;
    ASSERT_EQ(::tcsetattr(line_, TCSANOW, &line), 0);
    ASSERT_EQ(get_settings().c_cflag & (CSTOPB | CRTSCTS), static_cast<tcflag_t>(CSTOPB | CRTSCTS));
    ASSERT_EQ(get_settings().c_iflag & kInput, kInput);

    ASSERT_EQ(sender_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    EXPECT_EQ(get_settings().c_cflag & kControl, static_cast<tcflag_t>(CS8 | CREAD | CLOCAL));
    EXPECT_EQ(get_settings().c_iflag & kInput, 0U);
}

TEST_F(SerialLinkTest, ALineThatKeepsOneOfItsSettingsIsReported) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    const termios before = get_settings();
    for (const std::string kept : {"stop bits", "speed", "flow", "modem", "input", "output", "local"}) {
        termios line = before;
        line.c_cflag = (line.c_cflag & ~static_cast<tcflag_t>(CBAUD | CLOCAL)) | B9600 | CSTOPB | CRTSCTS;
        line.c_iflag |= IXON;
        line.c_oflag |= OPOST;
        line.c_lflag |= ICANON;
        ASSERT_EQ(::tcsetattr(line_, TCSANOW, &line), 0);
        termios locked{};
        locked.c_cflag = static_cast<tcflag_t>(kept == "stop bits" ? CSTOPB
                                               : kept == "speed"   ? CBAUD
                                               : kept == "flow"    ? CRTSCTS
                                               : kept == "modem"   ? CLOCAL
                                                                   : 0);
        locked.c_iflag = static_cast<tcflag_t>(kept == "input" ? IXON : 0);
        locked.c_oflag = static_cast<tcflag_t>(kept == "output" ? OPOST : 0);
        locked.c_lflag = static_cast<tcflag_t>(kept == "local" ? ICANON : 0);
        if (::ioctl(line_, TIOCSLCKTRMIOS, &locked) != 0) {
            GTEST_SKIP() << "to lock a setting of a line needs root";
        }

        EXPECT_EQ(receiver_.open_serial(path_.c_str(), kSpeed), Status::kError) << kept;
        EXPECT_EQ(receiver_.get_fault(), LinkFault::kLine) << kept;
        locked = termios{};
        ASSERT_EQ(::ioctl(line_, TIOCSLCKTRMIOS, &locked), 0);
    }
    EXPECT_EQ(receiver_.open_serial(path_.c_str(), kSpeed), Status::kOk);
}

TEST_F(SerialLinkTest, OctetsFromBeforeTheOpenCallAreNotReceived) {
    verifies("SWR-LCM-009", Technique::kStateTransition, Polarity::kViolation);
    termios line = get_settings();
    ::cfmakeraw(&line);
    ASSERT_EQ(::tcsetattr(line_, TCSANOW, &line), 0);
    const std::vector<std::byte> old = make_frame(make_message(1));
    write(old);
    int waiting = 0;
    ASSERT_TRUE(wait_until(
        [&] { return ::ioctl(line_, FIONREAD, &waiting) == 0 && waiting == static_cast<int>(old.size()); }));

    ASSERT_EQ(receiver_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    write(make_frame(make_message(2)));
    EXPECT_EQ(receive(), 2);
}

TEST_F(SerialLinkTest, AnUnpluggedDeviceEndsTheReception) {
    verifies("SWR-LCM-010", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(receiver_.open_serial(path_.c_str(), kSpeed), Status::kOk);
    ASSERT_TRUE(receiver_.is_receiving());
    ::close(master_);
    master_ = -1;

    EXPECT_TRUE(wait_until([this] { return !receiver_.is_receiving(); }));
}

TEST_F(SerialLinkTest, WhatIsNoSerialLineIsReportedWithItsCause) {
    verifies("SWR-LCM-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    EXPECT_EQ(receiver_.open_serial("/nonexistent/line", kSpeed), Status::kError);
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kDevice);
    EXPECT_EQ(receiver_.open_serial("/dev/null", kSpeed), Status::kError);
    EXPECT_EQ(receiver_.get_fault(), LinkFault::kLine);
    EXPECT_EQ(sender_.open_serial(path_.c_str(), 12345U), Status::kError);
    EXPECT_EQ(sender_.get_fault(), LinkFault::kLine);
    EXPECT_FALSE(receiver_.is_receiving());
}

}  // namespace
}  // namespace mamori::ports::lcm
