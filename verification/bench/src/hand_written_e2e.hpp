// SPDX-License-Identifier: Apache-2.0
/// @file
/// The lower bound of a protected exchange: both ends of a message of profile 4, HARDENED, written by hand
/// for one size, one sender and one receiver. It does what E2eOutPort, OutPort, InPort and E2eInPort do
/// together, with the limits of e2e_rig.hpp as constants. Only the checksum and the enumerations are those of
/// Mamori. hand_written_e2e_test.cpp compares both receivers on disturbed messages.
///
/// @satisfies SWR-BEN-010      Design: docs/design/bench.md#method
#ifndef MAMORI_VERIFICATION_BENCH_HAND_WRITTEN_E2E_HPP
#define MAMORI_VERIFICATION_BENCH_HAND_WRITTEN_E2E_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/safety/e2e/frame_cause.hpp"
#include "mamori/safety/e2e/port_outcome.hpp"
#include "mamori/safety/e2e/state_machine.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {

/// Bytes of a message: length, counter and identifier as one number of 64 bits, checksum, payload.
template <std::size_t kSize>
struct HandWrittenFrame {
    static constexpr std::size_t kCrcAt = 8U;
    static constexpr std::size_t kPayloadAt = 12U;
    static constexpr std::size_t kLength = kPayloadAt + kSize;
    static constexpr std::uint64_t kDataId = 0x0A0B0C0DU;
    /// All fields with the counter 0.
    static constexpr std::uint64_t kFields = std::uint64_t{kLength} << 48U | kDataId;

    std::uint32_t calc_checksum() const noexcept {
        safety::Crc<safety::kCrc32P4> crc;
        crc.add({bytes.data(), kCrcAt});
        crc.add({bytes.data() + kPayloadAt, kSize});
        return crc.get_value();
    }

    std::array<std::byte, kLength> bytes{};
};

/// Protects values and publishes them: one slot is written while the other is published.
template <std::size_t kSize>
class HandWrittenSender {
    using Frame = HandWrittenFrame<kSize>;

  public:
    /// Stages a message. A second write before the publication replaces the first, under its counter.
    void write(const Message<kSize>& value) noexcept {
        Frame& frame = frames_[(published_ + 1U) & 1U];
        sent_ = static_cast<std::uint16_t>(sent_ + (is_staged_ ? 0U : 1U));
        const std::uint64_t head = __builtin_bswap64(Frame::kFields | std::uint64_t{sent_} << 32U);
        std::memcpy(frame.bytes.data(), &head, sizeof(head));
        std::memcpy(frame.bytes.data() + Frame::kPayloadAt, value.data(), kSize);
        const std::uint32_t checksum = __builtin_bswap32(frame.calc_checksum());
        std::memcpy(frame.bytes.data() + Frame::kCrcAt, &checksum, sizeof(checksum));
        is_staged_ = true;
    }
    void publish(Instant now) noexcept {
        if (is_staged_) {
            ++published_;
            published_at_ = now;
            is_staged_ = false;
        }
    }
    const Frame& get_published() const noexcept { return frames_[published_ & 1U]; }
    /// Number of publications.
    std::uint64_t get_published_count() const noexcept { return published_; }
    Instant get_published_at() const noexcept { return published_at_; }

  private:
    std::array<Frame, 2U> frames_{};
    std::uint64_t published_{0U};
    Instant published_at_{};
    std::uint16_t sent_{0xFFFFU};  ///< counter of the last message
    bool is_staged_{false};
};

/// Takes messages and gives the value that may be used now. Limits: no loss, order found again by reset only,
/// age of 1000 ns, a window of four readings without an error and with one good reading.
template <std::size_t kSize>
class HandWrittenReceiver {
    using Frame = HandWrittenFrame<kSize>;

  public:
    /// @param[in] count number of publications of the sender, this one included.
    void take(const Frame& frame, std::uint64_t count, Instant published_at) noexcept {
        if (count > taken_) {
            frame_ = frame;
            taken_ = count;
            published_at_ = published_at;
            is_new_ = true;
        }
    }

    /// @return a value that may be used now, or the fail-safe value; valid until the next reading.
    const Message<kSize>& read(Instant now) noexcept {
        safety::E2eOutcome outcome = check_reading(now);
        if (is_unlikely(state_ != safety::ChannelState::kValid)) {
            has_value_ = false;
            outcome = outcome == safety::E2eOutcome::kAccepted ? safety::E2eOutcome::kUnproven : outcome;
        }
        outcome_ = outcome;
        increment(outcome_counts_[static_cast<std::size_t>(outcome)]);
        if (is_unlikely(outcome != safety::E2eOutcome::kAccepted)) {
            return has_value_ && is_fresh(origin_, now) ? value_ : kFailSafeValue;
        }
        return value_;
    }

    safety::E2eOutcome get_outcome() const noexcept { return outcome_; }
    safety::FrameCause get_cause() const noexcept { return cause_; }
    safety::ChannelState get_state() const noexcept { return state_; }
    std::uint32_t get_count(safety::FrameCause cause) const noexcept {
        return cause_counts_[static_cast<std::size_t>(cause)];
    }
    std::uint32_t get_count(safety::E2eOutcome outcome) const noexcept {
        return outcome_counts_[static_cast<std::size_t>(outcome)];
    }

  private:
    static constexpr Message<kSize> kFailSafeValue{};
    static constexpr std::uint64_t kAgeMaxNs = 1000U;
    static constexpr std::uint32_t kResyncFrames = 2U;
    static constexpr std::uint32_t kAbsenceMax = 255U;
    static constexpr std::uint32_t kWindow = 0xFU;  ///< one bit per reading
    static constexpr std::uint64_t kCounterBits = std::uint64_t{0xFFFFU} << 32U;

    static bool is_unlikely(bool condition) noexcept { return __builtin_expect(condition, false); }
    static void increment(std::uint32_t& count) noexcept {
        if (!is_unlikely(count == 0xFFFFFFFFU)) {
            ++count;
        }
    }
    static std::uint64_t calc_age_ns(Instant origin, Instant now) noexcept {
        return static_cast<std::uint64_t>(now.ns) - static_cast<std::uint64_t>(origin.ns);
    }
    /// An instant after now has an age above every limit.
    static bool is_fresh(Instant origin, Instant now) noexcept {
        return calc_age_ns(origin, now) <= kAgeMaxNs;
    }

    safety::E2eOutcome check_reading(Instant now) noexcept {
        if (is_unlikely(!is_new_)) {
            return record_silence();
        }
        is_new_ = false;
        std::uint64_t head = 0U;
        std::memcpy(&head, frame_.bytes.data(), sizeof(head));
        std::uint32_t checksum = 0U;
        std::memcpy(&checksum, frame_.bytes.data() + Frame::kCrcAt, sizeof(checksum));
        const std::uint64_t fields = __builtin_bswap64(head);
        if (is_unlikely(__builtin_bswap32(checksum) != frame_.calc_checksum() ||
                        (fields & ~kCounterBits) != Frame::kFields)) {
            return refuse_frame(__builtin_bswap32(checksum), fields);
        }
        const auto counter = static_cast<std::uint16_t>(fields >> 32U);
        if (is_unlikely(!is_synchronised_ || counter != static_cast<std::uint16_t>(last_ + 1U))) {
            return refuse_counter(counter);
        }
        last_ = counter;
        run_ = 0U;
        absence_ = 0U;
        record_cause(safety::FrameCause::kGood);
        std::memcpy(value_.data(), frame_.bytes.data() + Frame::kPayloadAt, kSize);
        origin_ = published_at_;
        has_value_ = is_fresh(origin_, now);
        move_state(has_value_, !has_value_);
        if (is_unlikely(!has_value_)) {
            return origin_ > now ? safety::E2eOutcome::kEarly : safety::E2eOutcome::kLate;
        }
        return safety::E2eOutcome::kAccepted;
    }

    void record_cause(safety::FrameCause cause) noexcept {
        cause_ = cause;
        increment(cause_counts_[static_cast<std::size_t>(cause)]);
    }
    void record_absence() noexcept { absence_ += absence_ <= kAbsenceMax ? 1U : 0U; }

    /// The windows are read as a whole each time, so a flipped bit leaves them.
    void move_state(bool is_ok, bool is_error) noexcept {
        ok_ = (ok_ << 1U | (is_ok ? 1U : 0U)) & kWindow;
        errors_ = (errors_ << 1U | (is_error ? 1U : 0U)) & kWindow;
        if (is_unlikely(state_ != safety::ChannelState::kValid || errors_ != 0U || ok_ == 0U)) {
            leave_or_enter_valid();
        }
    }
    [[gnu::noinline]] void leave_or_enter_valid() noexcept {
        const bool is_met = errors_ == 0U && ok_ != 0U;
        switch (state_) {
            case safety::ChannelState::kNoData:
                state_ = is_silent_or_damaged() ? state_ : safety::ChannelState::kInit;
                return;
            case safety::ChannelState::kInit:
                state_ = is_met ? safety::ChannelState::kValid : state_;
                state_ = errors_ != 0U ? safety::ChannelState::kInvalid : state_;
                return;
            case safety::ChannelState::kValid:
            case safety::ChannelState::kInvalid:
                state_ = is_met ? safety::ChannelState::kValid : safety::ChannelState::kInvalid;
                return;
        }
    }
    /// Whether the reading that moves the state brought nothing that counts as a message.
    bool is_silent_or_damaged() const noexcept {
        return cause_ == safety::FrameCause::kSilence || (errors_ & 1U) != 0U;
    }

    [[gnu::noinline]] safety::E2eOutcome record_silence() noexcept {
        record_absence();
        record_cause(safety::FrameCause::kSilence);
        move_state(false, false);
        return safety::E2eOutcome::kSilent;
    }
    [[gnu::noinline]] safety::E2eOutcome refuse_frame(std::uint32_t checksum, std::uint64_t fields) noexcept {
        safety::FrameCause cause = safety::FrameCause::kLengthField;
        if (checksum != frame_.calc_checksum()) {
            cause = safety::FrameCause::kChecksum;
        } else if ((fields & 0xFFFFFFFFU) != Frame::kDataId) {
            cause = safety::FrameCause::kDataId;
        }
        run_ = 0U;
        record_absence();
        record_cause(safety::refine(cause, {frame_.bytes.data(), frame_.bytes.size()}));
        move_state(false, true);
        return safety::E2eOutcome::kRefused;
    }
    [[gnu::noinline]] safety::E2eOutcome refuse_counter(std::uint16_t counter) noexcept {
        record_cause(find_order_cause(counter));
        move_state(false, false);
        return safety::E2eOutcome::kRefused;
    }
    /// A larger step ahead closes the channel, and so does a counter of the past after a long absence.
    safety::FrameCause find_order_cause(std::uint16_t counter) noexcept {
        if (is_closed_) {
            return safety::FrameCause::kOutOfOrder;
        }
        if (!is_synchronised_) {
            extend_run(counter);
            return safety::FrameCause::kOutOfOrder;
        }
        record_absence();
        const auto delta = static_cast<std::uint16_t>(counter - last_);
        if (delta == 0U) {
            run_ = 0U;
            return safety::FrameCause::kRepeated;
        }
        is_closed_ = delta <= 0x7FFFU || absence_ > kAbsenceMax;
        is_synchronised_ = !is_closed_;
        return safety::FrameCause::kOutOfOrder;
    }
    void extend_run(std::uint16_t counter) noexcept {
        const bool is_next = run_ > 0U && counter == static_cast<std::uint16_t>(run_end_ + 1U);
        run_ = is_next ? run_ + 1U : 1U;
        run_end_ = counter;
        if (run_ >= kResyncFrames) {
            last_ = counter;
            run_ = 0U;
            absence_ = 0U;
            is_synchronised_ = true;
        }
    }

    Frame frame_{};
    std::uint64_t taken_{0U};
    Instant published_at_{};
    Message<kSize> value_{};
    Instant origin_{};
    std::uint32_t ok_{0U};      ///< good readings of the window
    std::uint32_t errors_{0U};  ///< damaged messages of the window
    std::uint32_t run_{0U};
    std::uint32_t absence_{0U};
    safety::FrameCounts cause_counts_{};
    safety::E2eOutcomeCounts outcome_counts_{};
    std::uint16_t last_{0U};
    std::uint16_t run_end_{0U};
    safety::ChannelState state_{safety::ChannelState::kNoData};
    safety::FrameCause cause_{safety::FrameCause::kSilence};
    safety::E2eOutcome outcome_{safety::E2eOutcome::kSilent};
    bool is_new_{false};
    bool is_synchronised_{false};
    bool is_closed_{false};
    bool has_value_{false};
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_HAND_WRITTEN_E2E_HPP
