// SPDX-License-Identifier: Apache-2.0
/// @file
/// For the tests of end-to-end protection: frames as text, and a channel of each profile in each of its
/// variants.
#ifndef MAMORI_SAFETY_TESTS_E2E_RIG_HPP
#define MAMORI_SAFETY_TESTS_E2E_RIG_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mamori/kernel/base/span.hpp"
#include "mamori/safety/e2e/profile_01.hpp"
#include "mamori/safety/e2e/profile_02.hpp"
#include "mamori/safety/e2e/profile_04.hpp"
#include "mamori/safety/e2e/profile_05.hpp"
#include "mamori/safety/e2e/protector.hpp"

namespace mamori::safety::rig {

using Frame = std::vector<std::byte>;

inline Span<std::byte> edit(Frame& frame) {
    return {frame.data(), frame.size()};
}
inline Span<const std::byte> view(const Frame& frame) {
    return {frame.data(), frame.size()};
}

/// Bytes as pairs of digits with a space between, as the vectors are printed.
inline std::string to_hex(const Frame& frame) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (const std::byte byte : frame) {
        const auto value = std::to_integer<unsigned>(byte);
        text += text.empty() ? "" : " ";
        text += kDigits[value >> 4U];
        text += kDigits[value & 15U];
    }
    return text;
}

/// A frame of zeros, protected with `counter`. Empty where the protector refuses.
template <typename Profile>
Frame protect(const typename Profile::Channel& channel, std::uint32_t counter, std::size_t length) {
    Frame frame(length);
    E2eProtector<Profile> sut{channel, counter};
    return sut.protect(edit(frame)) == Status::kOk ? frame : Frame{};
}

/// The same as text.
template <typename Profile>
std::string show(const typename Profile::Channel& channel, std::uint32_t counter, std::size_t length) {
    return to_hex(protect<Profile>(channel, counter, length));
}

/// `text` and zeros behind it up to `length` bytes.
inline std::string fill(const std::string& text, std::size_t length) {
    std::string filled = text;
    while ((filled.size() + 1U) / 3U < length) {
        filled += filled.empty() ? "00" : " 00";
    }
    return filled;
}

// One variant of a profile each: a channel for frames of `length` bytes, and a second one with another
// identifier.
template <typename P, DataIdMode kMode, std::uint16_t kId, std::uint16_t kOther>
struct Nibbles {
    using Profile = P;
    static typename P::Channel make(std::size_t length) { return {kId, kMode, length}; }
    static typename P::Channel make_other(std::size_t length) { return {kOther, kMode, length}; }
};
template <typename P>
struct Listed {
    using Profile = P;
    static typename P::Channel make(std::size_t length) {
        return {{1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U, 13U, 14U, 15U, 16U}, length};
    }
    static typename P::Channel make_other(std::size_t length) {
        typename P::Channel channel = make(length);
        for (std::uint8_t& id : channel.data_ids) {
            id = static_cast<std::uint8_t>(id + 64U);
        }
        return channel;
    }
};
template <typename P, std::uint16_t kId = 0x1234U>
struct Known {
    using Profile = P;
    static typename P::Channel make(std::size_t length) { return {kId, length, length}; }
    static typename P::Channel make_other(std::size_t length) { return {kId + 1U, length, length}; }
};
template <typename P>
struct Sent {
    using Profile = P;
    static typename P::Channel make(std::size_t length) { return {0x0A0B0C0DU, length, length}; }
    static typename P::Channel make_other(std::size_t length) { return {0x0A0B0C0EU, length, length}; }
};

using P01Both = Nibbles<E2eProfile01<>, DataIdMode::kBoth, 0x0123U, 0x0124U>;
using P01Alternating = Nibbles<E2eProfile01<>, DataIdMode::kAlternating, 0x0123U, 0x0224U>;
using P01Low = Nibbles<E2eProfile01<>, DataIdMode::kLow, 0x0023U, 0x0024U>;
using P01Nibble = Nibbles<E2eProfile01<>, DataIdMode::kNibble, 0x0123U, 0x0223U>;
using P02 = Listed<E2eProfile02<>>;
using P04 = Sent<E2eProfile04<>>;
using P05 = Known<E2eProfile05<>>;
using P06 = Known<E2eProfile06<>>;
using P07 = Sent<E2eProfile07<>>;
using P08 = Sent<E2eProfile08<>>;
using P11Both = Nibbles<E2eProfile11<>, DataIdMode::kBoth, 0x0123U, 0x0124U>;
using P11Nibble = Nibbles<E2eProfile11<>, DataIdMode::kNibble, 0x0123U, 0x0223U>;
using P22 = Listed<E2eProfile22<>>;
using P44 = Sent<E2eProfile44<>>;

}  // namespace mamori::safety::rig

#endif  // MAMORI_SAFETY_TESTS_E2E_RIG_HPP
