// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/shared_frame.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

using detail::FrameWord;

/// Indices of the words of a slot, and of the number of the newest message.
constexpr std::size_t kNewest{0U};
constexpr std::size_t kNumber{0U};
constexpr std::size_t kInstant{1U};
constexpr std::size_t kLength{2U};

/// Value instead of a number: a message is being written to the slot.
constexpr FrameWord kUnderWay{0U};

/// Returns a valid slot for any number, also one from random bytes.
std::size_t find_slot(std::uint64_t number, std::size_t capacity) noexcept {
    return 1U + static_cast<std::size_t>(number % detail::kFrameSlots) * detail::calc_slot_words(capacity);
}

bool is_usable(const std::byte* data, std::size_t size, std::size_t capacity) noexcept {
    return capacity >= 1U && capacity <= kFrameCapacityMax && data != nullptr &&
           reinterpret_cast<std::uintptr_t>(data) % alignof(FrameWord) == 0U &&
           size >= calc_frame_region_size(capacity);
}

/// Used bytes of the word at `index` of a content of `length` bytes.
std::size_t calc_used(std::size_t length, std::size_t index) noexcept {
    const std::size_t rest = length - index * sizeof(FrameWord);
    return rest < sizeof(FrameWord) ? rest : sizeof(FrameWord);
}

std::size_t count_words(std::size_t length) noexcept {
    return (length + sizeof(FrameWord) - 1U) / sizeof(FrameWord);
}

}  // namespace

Status FrameWriter::open(Span<std::byte> region, std::size_t capacity) noexcept {
    if (!is_usable(region.data(), region.size(), capacity)) {
        return Status::kBadParameter;
    }
    words_ = reinterpret_cast<FrameWord*>(region.data());
    capacity_ = capacity;
    number_ = __atomic_load_n(&words_[kNewest], __ATOMIC_RELAXED);
    return Status::kOk;
}

Status FrameWriter::write(Span<const std::byte> content, Instant published_at) noexcept {
    if (words_ == nullptr) {
        return Status::kPreconditionNotMet;
    }
    if (content.size() > capacity_) {
        return Status::kBadParameter;
    }
    ++number_;
    number_ += number_ == kUnderWay ? 1U : 0U;
    FrameWord* const slot = words_ + find_slot(number_, capacity_);
    __atomic_store_n(&slot[kNumber], kUnderWay, __ATOMIC_RELAXED);
    // Release: a reader that sees one of these words also sees that the message is being written.
    __atomic_store_n(&slot[kInstant], static_cast<FrameWord>(published_at.ns), __ATOMIC_RELEASE);
    __atomic_store_n(&slot[kLength], static_cast<FrameWord>(content.size()), __ATOMIC_RELEASE);
    for (std::size_t i = 0U; i < count_words(content.size()); ++i) {
        FrameWord word{0U};
        __builtin_memcpy(&word, content.data() + i * sizeof(FrameWord), calc_used(content.size(), i));
        __atomic_store_n(&slot[detail::kFrameHeadWords + i], word, __ATOMIC_RELEASE);
    }
    __atomic_store_n(&slot[kNumber], number_, __ATOMIC_RELEASE);
    __atomic_store_n(&words_[kNewest], number_, __ATOMIC_RELEASE);
    return Status::kOk;
}

Status FrameReader::open(Span<const std::byte> region, std::size_t capacity) noexcept {
    if (!is_usable(region.data(), region.size(), capacity)) {
        return Status::kBadParameter;
    }
    words_ = reinterpret_cast<const FrameWord*>(region.data());
    capacity_ = capacity;
    number_ = 0U;
    return Status::kOk;
}

FrameOutcome FrameReader::take(Span<std::byte> content, FrameFacts& facts) noexcept {
    if (words_ == nullptr) {
        return FrameOutcome::kNothingNew;
    }
    MAMORI_REQUIRE(1, content.size() >= capacity_);
    for (int i = 0; i < kTries; ++i) {
        const std::uint64_t newest = __atomic_load_n(&words_[kNewest], __ATOMIC_ACQUIRE);
        if (newest == kUnderWay || newest == number_) {
            return FrameOutcome::kNothingNew;
        }
        const FrameOutcome outcome = copy(newest, content, facts);
        if (outcome != FrameOutcome::kTorn) {
            number_ = newest;
            return outcome;
        }
    }
    return FrameOutcome::kTorn;
}

/// Loads each word once, so that the checked value is the used value.
FrameOutcome FrameReader::copy(std::uint64_t number, Span<std::byte> content,
                               FrameFacts& facts) const noexcept {
    const FrameWord* const slot = words_ + find_slot(number, capacity_);
    if (__atomic_load_n(&slot[kNumber], __ATOMIC_ACQUIRE) != number) {
        return FrameOutcome::kTorn;
    }
    const FrameWord instant = __atomic_load_n(&slot[kInstant], __ATOMIC_ACQUIRE);
    const FrameWord claimed = __atomic_load_n(&slot[kLength], __ATOMIC_ACQUIRE);
    const std::size_t length = claimed <= capacity_ ? static_cast<std::size_t>(claimed) : 0U;
    for (std::size_t i = 0U; i < count_words(length); ++i) {
        const FrameWord word = __atomic_load_n(&slot[detail::kFrameHeadWords + i], __ATOMIC_ACQUIRE);
        __builtin_memcpy(content.data() + i * sizeof(FrameWord), &word, calc_used(length, i));
    }
    // The acquire operations above order this load after them.
    if (__atomic_load_n(&slot[kNumber], __ATOMIC_RELAXED) != number) {
        return FrameOutcome::kTorn;
    }
    if (claimed > capacity_) {
        return FrameOutcome::kMalformed;
    }
    facts = {number, Instant{static_cast<std::int64_t>(instant)}, length};
    return FrameOutcome::kNew;
}

}  // namespace mamori::ports::posix_rt
