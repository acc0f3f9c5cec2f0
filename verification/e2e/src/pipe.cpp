// SPDX-License-Identifier: Apache-2.0
/// @file
/// Protects and reads messages for another process: binary requests on standard input, replies on standard
/// output, until the input ends. Exit status 1 for a truncated request or an unknown profile.
///
///     request: profile u8, data id mode u8, operation u8 (0 protect, 1 read), 0 u8, offset u16, length u16,
///              data id u32, counter u32, 16 data ids u8, frame of `length` bytes; numbers least significant
///              byte first
///     answer:  cause u8 (FrameCause; 255: channel refused), counter u32, and for protect the frame
///
/// @satisfies SWR-E2E-003      Design: docs/design/e2e.md#comparison
#include <cstdio>
#include <vector>

#include "mamori/safety/e2e/e2e.hpp"

namespace mamori::safety {
namespace {

constexpr std::uint8_t kRefused = 255U;
constexpr std::size_t kRequestSize = 32U;

struct Request {
    std::uint8_t profile{0U};
    DataIdMode mode{DataIdMode::kBoth};
    bool is_read{false};
    std::size_t offset{0U};
    std::uint32_t data_id{0U};
    std::uint32_t counter{0U};
    std::array<std::uint8_t, 16U> data_ids{};
    std::vector<std::byte> frame;
};

/// Number of `size` bytes, beginning at `first`.
std::uint32_t get_number(const std::array<std::uint8_t, kRequestSize>& bytes, std::size_t first,
                         std::size_t size) {
    std::uint32_t value = 0U;
    for (std::size_t i = 0U; i < size; ++i) {
        value |= static_cast<std::uint32_t>(bytes[first + i]) << (8U * i);
    }
    return value;
}

/// @return 1 for a request, 0 at the end of the input, -1 for a truncated request.
int receive(Request& request) {
    std::array<std::uint8_t, kRequestSize> head{};
    const std::size_t got = std::fread(head.data(), 1U, head.size(), stdin);
    if (got < head.size()) {
        return got == 0U ? 0 : -1;
    }
    request.profile = head[0];
    request.mode = static_cast<DataIdMode>(head[1]);
    request.is_read = head[2] == 1U;
    request.offset = get_number(head, 4U, 2U);
    request.frame.resize(get_number(head, 6U, 2U));
    request.data_id = get_number(head, 8U, 4U);
    request.counter = get_number(head, 12U, 4U);
    for (std::size_t i = 0U; i < request.data_ids.size(); ++i) {
        request.data_ids[i] = head[16U + i];
    }
    return std::fread(request.frame.data(), 1U, request.frame.size(), stdin) == request.frame.size() ? 1 : -1;
}

/// Executes the request. @return the first byte of the reply.
template <typename Profile>
std::uint8_t serve(Request& request, const typename Profile::Channel& channel) {
    if (Profile::find_fault(channel) != ChannelFault::kNone || request.counter > Profile::kCounterMax) {
        return kRefused;
    }
    FrameCause cause = Profile::judge_length(channel, request.frame.size());
    if (request.is_read && cause == FrameCause::kGood) {
        cause = Profile::read(channel, {request.frame.data(), request.frame.size()}, request.counter);
    } else if (cause == FrameCause::kGood) {
        Profile::write(channel, request.counter, {request.frame.data(), request.frame.size()});
    }
    return static_cast<std::uint8_t>(cause);
}

/// @return false for an unknown profile.
bool serve(Request& request, std::uint8_t& cause) {
    const std::size_t length = request.frame.size();
    const auto short_id = static_cast<std::uint16_t>(request.data_id);
    const std::size_t bits = request.offset * 8U;
    const NibbleCounterChannel nibbles{short_id, request.mode, length, bits, bits + 8U, bits + 12U};
    const IdListChannel listed{request.data_ids, length, request.offset};
    const KnownIdChannel known{short_id, length, length, request.offset};
    const SentIdChannel sent{request.data_id, length, length, request.offset};
    switch (request.profile) {
        case 1U:
            cause = serve<E2eProfile01<>>(request, nibbles);
            return true;
        case 2U:
            cause = serve<E2eProfile02<>>(request, listed);
            return true;
        case 4U:
            cause = serve<E2eProfile04<>>(request, sent);
            return true;
        case 5U:
            cause = serve<E2eProfile05<>>(request, known);
            return true;
        case 6U:
            cause = serve<E2eProfile06<>>(request, known);
            return true;
        case 7U:
            cause = serve<E2eProfile07<>>(request, sent);
            return true;
        case 8U:
            cause = serve<E2eProfile08<>>(request, sent);
            return true;
        case 11U:
            cause = serve<E2eProfile11<>>(request, nibbles);
            return true;
        case 22U:
            cause = serve<E2eProfile22<>>(request, listed);
            return true;
        case 44U:
            cause = serve<E2eProfile44<>>(request, sent);
            return true;
        default:
            return false;
    }
}

void answer(const Request& request, std::uint8_t cause) {
    std::array<std::uint8_t, 5U> head{cause};
    for (std::size_t i = 0U; i < 4U; ++i) {
        head[1U + i] = static_cast<std::uint8_t>(request.counter >> (8U * i));
    }
    static_cast<void>(std::fwrite(head.data(), 1U, head.size(), stdout));
    if (!request.is_read) {
        static_cast<void>(std::fwrite(request.frame.data(), 1U, request.frame.size(), stdout));
    }
}

}  // namespace
}  // namespace mamori::safety

int main() {
    using namespace mamori::safety;
    Request request;
    int got = receive(request);
    for (; got > 0; got = receive(request)) {
        std::uint8_t cause = 0U;
        if (!serve(request, cause)) {
            std::fprintf(stderr, "request for profile %u, which there is not\n", unsigned{request.profile});
            return 1;
        }
        answer(request, cause);
    }
    if (got < 0) {
        std::fprintf(stderr, "request is cut off\n");
        return 1;
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}
