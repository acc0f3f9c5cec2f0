// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/frame_link.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>

#include "link_thread.hpp"

namespace mamori::ports::lcm {

namespace {

struct Speed {
    std::uint32_t bits_per_s;
    speed_t code;
};
constexpr std::array<Speed, 8U> kSpeeds{{{9600U, B9600},
                                         {19200U, B19200},
                                         {38400U, B38400},
                                         {57600U, B57600},
                                         {115200U, B115200},
                                         {230400U, B230400},
                                         {460800U, B460800},
                                         {921600U, B921600}}};

/// Whether the line works as `wanted`: tcsetattr() succeeds when any of the changes took effect.
bool is_line_set(int file, const termios& wanted) noexcept {
    constexpr tcflag_t kControl = CSIZE | CSTOPB | PARENB | CRTSCTS | CREAD | CLOCAL;
    termios line{};
    return ::tcgetattr(file, &line) == 0 && ((line.c_cflag ^ wanted.c_cflag) & kControl) == 0U &&
           line.c_iflag == wanted.c_iflag && line.c_oflag == wanted.c_oflag &&
           line.c_lflag == wanted.c_lflag && ::cfgetispeed(&line) == ::cfgetispeed(&wanted) &&
           ::cfgetospeed(&line) == ::cfgetospeed(&wanted);
}

LinkFault configure_line(int file, std::uint32_t bits_per_s) noexcept {
    for (const Speed& speed : kSpeeds) {
        termios line{};
        if (speed.bits_per_s == bits_per_s && ::tcgetattr(file, &line) == 0) {
            ::cfmakeraw(&line);  // does not change the stop bits and the flow control
            line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
            line.c_cflag |= CLOCAL | CREAD;
            line.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY | INPCK);
            const bool is_set = ::cfsetispeed(&line, speed.code) == 0 &&
                                ::cfsetospeed(&line, speed.code) == 0 &&
                                ::tcsetattr(file, TCSANOW, &line) == 0 && is_line_set(file, line);
            return is_set ? LinkFault::kNone : LinkFault::kLine;
        }
    }
    return LinkFault::kLine;
}

/// @param[out] file open serial device; unchanged on a fault.
LinkFault open_line(const char* path, std::uint32_t bits_per_s, int mode, int& file) noexcept {
    const int device = ::open(path, mode | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (device < 0) {
        return LinkFault::kDevice;
    }
    const LinkFault fault = configure_line(device, bits_per_s);
    if (fault != LinkFault::kNone) {
        static_cast<void>(::close(device));
        return fault;
    }
    file = device;
    return LinkFault::kNone;
}

using SocketCall = int (*)(int, const sockaddr*, socklen_t);

/// @param[in] call connect or bind. @param[out] file open socket; unchanged on a fault.
LinkFault open_socket(const char* address, std::uint16_t port, SocketCall call, int& file) noexcept {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    if (::inet_pton(AF_INET, address, &place.sin_addr) != 1) {
        return LinkFault::kAddress;
    }
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket < 0) {
        return LinkFault::kSocket;
    }
    if (call(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
        static_cast<void>(::close(socket));
        return LinkFault::kSocket;
    }
    file = socket;
    return LinkFault::kNone;
}

}  // namespace

Status FrameSender::open_udp(const char* address, std::uint16_t port) noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    fault_ = open_socket(address, port, &::connect, file_);
    return fault_ == LinkFault::kNone ? Status::kOk : Status::kError;
}

Status FrameSender::open_serial(const char* path, std::uint32_t speed) noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    fault_ = open_line(path, speed, O_WRONLY, file_);
    return fault_ == LinkFault::kNone ? Status::kOk : Status::kError;
}

void FrameSender::close() noexcept {
    if (file_ >= 0) {
        static_cast<void>(::close(file_));
        file_ = -1;
    }
}

Status FrameSender::send(Span<const std::byte> message) noexcept {
    if (file_ < 0) {
        return Status::kPreconditionNotMet;
    }
    const Result<std::size_t> size = encode_frame(message, storage_);
    if (!size.has_value()) {
        return Status::kBadParameter;
    }
    // A part of a frame is damage that the receiver detects, and the next frame begins with a delimiter.
    const ssize_t written = ::write(file_, storage_.data(), size.get_value());
    if (written == static_cast<ssize_t>(size.get_value())) {
        return Status::kOk;
    }
    const bool is_full = written >= 0 || errno == EAGAIN || errno == ENOBUFS;
    return is_full ? Status::kOutOfResources : Status::kError;
}

Status FrameReceiver::open_udp(const char* address, std::uint16_t port) noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    fault_ = open_socket(address, port, &::bind, file_);
    if (fault_ != LinkFault::kNone) {
        return Status::kError;
    }
    sockaddr_in place{};
    socklen_t size = sizeof place;
    if (::getsockname(file_, reinterpret_cast<sockaddr*>(&place), &size) == 0) {
        port_ = ntohs(place.sin_port);
    }
    return start();
}

Status FrameReceiver::open_serial(const char* path, std::uint32_t speed) noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    fault_ = open_line(path, speed, O_RDONLY, file_);
    if (fault_ != LinkFault::kNone) {
        return Status::kError;
    }
    static_cast<void>(::tcflush(file_, TCIFLUSH));  // octets from before the open call, at any speed
    return start();
}

Status FrameReceiver::start() noexcept {
    decoder_.reset();
    is_receiving_.store(true, std::memory_order_relaxed);
    if (detail::start_thread(thread_, stop_, &FrameReceiver::serve, this) == Status::kOk) {
        return Status::kOk;
    }
    close();
    fault_ = LinkFault::kThread;
    return Status::kError;
}

void FrameReceiver::close() noexcept {
    if (stop_ >= 0) {
        detail::stop_thread(thread_, stop_);
    }
    if (file_ >= 0) {
        static_cast<void>(::close(file_));
        file_ = -1;
    }
    port_ = 0U;
    is_receiving_.store(false, std::memory_order_relaxed);
}

void* FrameReceiver::serve(void* receiver) noexcept {
    static_cast<FrameReceiver*>(receiver)->receive();
    return nullptr;
}

void FrameReceiver::receive() noexcept {
    // Ends with the device or with close(); a datagram that another program sent may have any content.
    while (detail::wait_for(file_, stop_)) {
        const ssize_t size = ::read(file_, chunk_.data(), chunk_.size());
        const bool is_over = size == 0 && port_ == 0U;
        const bool is_error = size < 0 && errno != EAGAIN && errno != EINTR && errno != ECONNREFUSED;
        if (is_over || is_error) {
            break;
        }
        for (ssize_t i = 0; i < size; ++i) {
            switch (decoder_.push(chunk_[static_cast<std::size_t>(i)])) {
                case FrameEvent::kNone:
                    break;
                case FrameEvent::kMessage:
                    inbox_.put(decoder_.get_message());
                    break;
                case FrameEvent::kOversized:
                    inbox_.put_oversized();
                    break;
                case FrameEvent::kMalformed:
                case FrameEvent::kChecksum:
                    inbox_.put_damaged();
                    break;
            }
        }
    }
    is_receiving_.store(false, std::memory_order_relaxed);
}

}  // namespace mamori::ports::lcm
