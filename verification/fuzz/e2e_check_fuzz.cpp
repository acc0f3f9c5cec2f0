// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fuzz target for the receiving ends of end-to-end protection. A checker and a port of every profile, in
/// both orders and on both kinds of input, receive the bytes of the fuzzer. They may accept only messages
/// that an independent recomputation accepts. A value may only be the value of its message, the previous
/// value, or the fail-safe value. Every check has one cause and every reading one outcome. The first byte
/// selects the ends; steps follow, see Step. Seeds: corpus/e2e_check.txt.
/// Design: docs/design/test_strength.md#fuzzing
#include <cstdint>
#include <cstring>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/safety/e2e/e2e.hpp"

namespace mamori::fuzz {

enum class Gear : std::uint8_t { kPark, kDrive };

/// Always 16 bytes.
struct Fixed {
    double rad_s{0.0};
    Gear gear{Gear::kPark};
    std::uint32_t number{0U};
};
/// 9 .. 32 bytes.
struct Varying {
    Gear gear{Gear::kPark};
    BoundedString<7U> text{};
    BoundedSequence<std::uint16_t, 6U> numbers{};
};

}  // namespace mamori::fuzz

MAMORI_LAST_ENUMERATOR(mamori::fuzz::Gear, kDrive)
MAMORI_FIELDS(mamori::fuzz::Fixed, rad_s, gear, number)
MAMORI_FIELDS(mamori::fuzz::Varying, gear, text, numbers)

namespace {

using namespace mamori::safety;  // NOLINT: the subject
using namespace mamori::literals;
using mamori::Instant;
using mamori::fuzz::Fixed;
using mamori::fuzz::Gear;
using mamori::fuzz::Varying;
using Bytes = std::vector<std::uint8_t>;

void demand(bool condition) {
    if (!condition) {
        __builtin_trap();
    }
}

// ---- Recomputation ----

/// Register of `width` bits, processed bit by bit, most significant first; reflected registers are reversed.
std::uint64_t divide(const Bytes& bytes, unsigned width, std::uint64_t polynomial, std::uint64_t start,
                     bool turns) {
    const std::uint64_t mask = ~std::uint64_t{0U} >> (64U - width);
    std::uint64_t rest = start;
    for (const std::uint8_t byte : bytes) {
        for (unsigned i = 0U; i < 8U; ++i) {
            const bool in = ((byte >> (turns ? i : 7U - i)) & 1U) != 0U;
            const bool out = ((rest >> (width - 1U)) & 1U) != 0U;
            rest = ((rest << 1U) & mask) ^ (in != out ? polynomial : 0U);
        }
    }
    std::uint64_t turned = 0U;
    for (unsigned i = 0U; i < width; ++i) {
        turned |= ((rest >> i) & 1U) << (width - 1U - i);
    }
    return turns ? turned : rest;
}

std::uint64_t get_big(const Bytes& frame, std::size_t first, std::size_t size) {
    std::uint64_t value = 0U;
    for (std::size_t i = 0U; i < size; ++i) {
        value = value << 8U | frame[first + i];
    }
    return value;
}

/// `frame` without the bytes first .. first + size - 1.
Bytes without(const Bytes& frame, std::size_t first, std::size_t size) {
    Bytes rest(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(first));
    rest.insert(rest.end(), frame.begin() + static_cast<std::ptrdiff_t>(first + size), frame.end());
    return rest;
}

constexpr std::uint16_t kShortId = 0x0123U;
constexpr std::uint32_t kLongId = 0x0A0B0C0DU;
constexpr std::uint64_t kOnes = ~std::uint64_t{0U};
constexpr std::uint64_t kOnes32 = 0xFFFFFFFFU;

/// True for a message that a sender of the channel below writes with any counter.
bool is_good(unsigned profile, const Bytes& frame, std::size_t shortest, std::size_t longest) {
    if (frame.size() < shortest || frame.size() > longest) {
        return false;
    }
    Bytes covered;
    switch (profile) {
        case 1U:
        case 11U:
            covered = without(frame, 0U, 1U);
            covered.insert(covered.begin(), {kShortId & 0xFFU, kShortId >> 8U});
            return divide(covered, 8U, 0x1DU, 0U, false) == frame[0] && (frame[1] & 0x0FU) < 15U;
        case 2U:
        case 22U:
            covered = without(frame, 0U, 1U);
            covered.push_back(static_cast<std::uint8_t>((frame[1] & 0x0FU) + 1U));
            return (divide(covered, 8U, 0x2FU, 0xFFU, false) ^ 0xFFU) == frame[0];
        case 5U:
            covered = without(frame, 0U, 2U);
            covered.insert(covered.end(), {kShortId & 0xFFU, kShortId >> 8U});
            return divide(covered, 16U, 0x1021U, 0xFFFFU, false) == get_big({frame[1], frame[0]}, 0U, 2U);
        case 6U:
            covered = without(frame, 0U, 2U);
            covered.insert(covered.end(), {kShortId >> 8U, kShortId & 0xFFU});
            return divide(covered, 16U, 0x1021U, 0xFFFFU, false) == get_big(frame, 0U, 2U) &&
                   get_big(frame, 2U, 2U) == frame.size();
        case 7U:
            return (divide(without(frame, 0U, 8U), 64U, 0x42F0E1EBA9EA3693U, kOnes, true) ^ kOnes) ==
                       get_big(frame, 0U, 8U) &&
                   get_big(frame, 8U, 4U) == frame.size() && get_big(frame, 16U, 4U) == kLongId;
        case 8U:
            return (divide(without(frame, 0U, 4U), 32U, 0xF4ACFB13U, kOnes32, true) ^ kOnes32) ==
                       get_big(frame, 0U, 4U) &&
                   get_big(frame, 4U, 4U) == frame.size() && get_big(frame, 12U, 4U) == kLongId;
        default:
            return (divide(without(frame, 8U, 4U), 32U, 0xF4ACFB13U, kOnes32, true) ^ kOnes32) ==
                       get_big(frame, 8U, 4U) &&
                   get_big(frame, 0U, 2U) == frame.size() && get_big(frame, 4U, 4U) == kLongId;
    }
}

// ---- The ends ----

constexpr NibbleCounterChannel kNibbles{kShortId, DataIdMode::kBoth, 18U};
constexpr IdListChannel kListed{{1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U, 13U, 14U, 15U, 16U}, 18U};
constexpr KnownIdChannel kKnown3{kShortId, 19U, 19U};
constexpr KnownIdChannel kKnown5{kShortId, 5U + 16U, 5U + 32U};
constexpr SentIdChannel kSent12{kLongId, 12U + 16U, 12U + 32U};
constexpr SentIdChannel kSent16{kLongId, 16U + 16U, 16U + 32U};
constexpr SentIdChannel kSent20{kLongId, 20U + 16U, 20U + 32U};
using M01 = E2eMessage<Fixed, E2eProfile01<>, kNibbles>;
using M02 = E2eMessage<Fixed, E2eProfile02<>, kListed>;
using M04 = E2eMessage<Varying, E2eProfile04<>, kSent12>;
using M05 = E2eMessage<Fixed, E2eProfile05<>, kKnown3>;
using M06 = E2eMessage<Varying, E2eProfile06<>, kKnown5>;
using M07 = E2eMessage<Varying, E2eProfile07<>, kSent20>;
using M08 = E2eMessage<Varying, E2eProfile08<>, kSent16>;
using M11 = E2eMessage<Fixed, E2eProfile11<>, kNibbles>;
using M22 = E2eMessage<Fixed, E2eProfile22<>, kListed>;
using M44 = E2eMessage<Varying, E2eProfile44<>, kSent12, mamori::ByteOrder::kBig>;

/// Longer than every valid message, so that too long messages are possible.
using Frame = E2eFrame<64U>;
using Latest = mamori::InPort<Frame>;
using Queue = mamori::QueueInPort<Frame, 3U>;

template <typename Order>
constexpr E2eInLimits<Order> kLimits{35_ms, {1U}, 5U, {{1U, 3U}, {1U, 3U}, {2U, 2U}}};
constexpr Instant kStart{1000};

/// Actions of a step of the input. Messages arrive; then a cycle follows, except for kQueueUp.
enum class Step : std::uint8_t {
    kArbitrary,  ///< a message of the following bytes: length, bytes
    kGood,       ///< the same, with the header that the sender writes with its next counter
    kDamaged,    ///< the same, with one byte changed: length, bytes, index, change
    kRepeated,   ///< the last message again
    kSilent,     ///< no message
    kSkip,       ///< the counter of the sender increases by the next byte
    kWait,       ///< time advances by that number of milliseconds
    kQueueUp,    ///< the last message again, without a cycle
    kRestart,    ///< a deliberate reset
    kNewMode,    ///< the connection is restarted
};
constexpr unsigned kStepCount = 10U;

class Input final {
  public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    bool is_at_end() const { return next_ == size_; }
    /// Next byte; 0 after the end.
    std::uint8_t take() { return is_at_end() ? std::uint8_t{0U} : data_[next_++]; }

  private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::size_t next_{0U};
};

template <typename T>
Bytes to_bytes(const T& value) {
    Bytes bytes(mamori::max_encoded_size<T>());
    const auto size = mamori::encode(value, {reinterpret_cast<std::byte*>(bytes.data()), bytes.size()},
                                     mamori::ByteOrder::kLittle);
    demand(size.has_value());
    bytes.resize(size.get_value());
    return bytes;
}

template <typename Message, typename Order, typename Port>
class Run final {
    using Value = typename Message::Value;
    using Profile = typename Message::Profile;

  public:
    void follow(Input& input) {
        while (!input.is_at_end()) {
            step(static_cast<Step>(input.take() % kStepCount), input);
            check_counts();
        }
    }

  private:
    void step(Step what, Input& input) {
        switch (what) {
            case Step::kArbitrary:
                take_frame(input);
                break;
            case Step::kGood:
                take_frame(input);
                protect();
                break;
            case Step::kDamaged:
                take_frame(input);
                protect();
                damage(input);
                break;
            case Step::kRepeated:
                break;
            case Step::kQueueUp:
                deliver();
                return;
            case Step::kSilent:
                return read(false);
            case Step::kSkip:
                counter_ += input.take();
                return;
            case Step::kWait:
                now_ = now_ + 1_ms * input.take();
                return;
            case Step::kRestart:
                checker_.restart();
                port_.restart();
                held_.clear();
                return;
            case Step::kNewMode:
                in_.restart(now_, revision_);
                held_.clear();
                return;
        }
        check();
        deliver();
        read(true);
    }

    void take_frame(Input& input) {
        frame_.assign(input.take() % (Frame::capacity() + 1U), 0U);
        for (std::uint8_t& byte : frame_) {
            byte = input.take();
        }
    }
    void protect() {
        if (Profile::judge_length(Message::kChannel, frame_.size()) == FrameCause::kGood) {
            const std::uint64_t period = std::uint64_t{Profile::kCounterMax} + 1U;
            Profile::write(Message::kChannel, static_cast<std::uint32_t>(counter_++ % period),
                           {reinterpret_cast<std::byte*>(frame_.data()), frame_.size()});
            demand(is_known_good());
        }
    }
    void damage(Input& input) {
        if (!frame_.empty()) {
            std::uint8_t& byte = frame_[input.take() % frame_.size()];
            byte = static_cast<std::uint8_t>(byte ^ input.take());
        }
    }
    bool is_known_good() const {
        return is_good(Profile::kNumber, frame_, Message::kLengthMin, Message::kLengthMax);
    }

    /// The checker alone.
    void check() {
        ++check_count_;
        const CheckStatus status =
            checker_.check({reinterpret_cast<const std::byte*>(frame_.data()), frame_.size()});
        demand((status != CheckStatus::kError) == is_known_good());
        demand(is_usable(status) == (checker_.get_cause() == FrameCause::kGood));
    }
    void deliver() {
        Frame frame;
        demand(frame.resize(frame_.size()) == mamori::Status::kOk);
        if (!frame_.empty()) {
            std::memcpy(frame.data(), frame_.data(), frame_.size());
        }
        now_ = now_ + 1_ms;
        ++revision_;
        if constexpr (Port::kIsQueue) {
            static_cast<void>(in_.push({frame, revision_, now_}));
            in_.open(now_);
        } else {
            in_.take({frame, revision_, now_});
        }
    }
    /// A cycle of the port; queued messages are read in further cycles. @param[in] has_frame a message was
    /// delivered.
    void read(bool has_frame) {
        demand(!has_frame || port_.has_frame());
        do {
            now_ = now_ + 1_ms;
            Value value{};
            const E2eWorth worth = port_.read(now_, value);
            ++reading_count_;
            judge(worth, to_bytes(value));
            in_.mark_read();
        } while (port_.has_frame());
    }
    void judge(E2eWorth worth, const Bytes& value) {
        const bool is_accepted = port_.get_outcome() == E2eOutcome::kAccepted;
        demand((worth == E2eWorth::kNew) == is_accepted);
        if (worth == E2eWorth::kNew) {
            // A queue contains this message, or messages that were the last one when they were queued.
            demand(Port::kIsQueue || is_known_good());
            demand(port_.get_state() == ChannelState::kValid);
            held_ = value;
        } else if (worth == E2eWorth::kHeld) {
            demand(!held_.empty() && value == held_);
            demand(port_.get_state() == ChannelState::kValid);
        } else {
            demand(value == to_bytes(substitute_));
        }
        if (is_accepted && !Port::kIsQueue) {
            Value expected{};
            demand(mamori::decode({reinterpret_cast<const std::byte*>(frame_.data()) + Message::kPayloadAt,
                                   frame_.size() - Message::kPayloadAt},
                                  Message::kByteOrder, expected) == mamori::Status::kOk);
            demand(to_bytes(expected) == value);
        }
    }
    void check_counts() const {
        std::uint64_t causes = 0U;
        std::uint64_t port_causes = 0U;
        for (std::size_t i = 0U; i < kFrameCauseCount; ++i) {
            causes += checker_.get_count(static_cast<FrameCause>(i));
            port_causes += port_.get_checker().get_count(static_cast<FrameCause>(i));
        }
        std::uint64_t outcomes = 0U;
        for (std::size_t i = 0U; i < kE2eOutcomeCount; ++i) {
            outcomes += port_.get_count(static_cast<E2eOutcome>(i));
        }
        demand(causes == check_count_ && port_causes == reading_count_ && outcomes == reading_count_);
    }

    const Value substitute_{{}};
    Port in_{mamori::kNoOwner, "in"};
    E2eInPort<Message, kLimits<Order>, Port> port_{in_, substitute_};
    E2eChecker<Profile, Order> checker_{Message::kChannel, {1U}};
    Bytes frame_{};
    Bytes held_{};
    Instant now_{kStart};
    std::uint64_t counter_{Profile::kFirstCounter};
    std::uint64_t revision_{0U};
    std::uint64_t check_count_{0U};
    std::uint64_t reading_count_{0U};
};

template <typename Message>
void choose(unsigned ends, Input& input) {
    switch (ends) {
        case 0U:
            return Run<Message, typename Message::Profile::Sequence, Latest>{}.follow(input);
        case 1U:
            return Run<Message, typename Message::Profile::Sequence, Queue>{}.follow(input);
        case 2U:
            return Run<Message, HardenedSequence, Latest>{}.follow(input);
        default:
            return Run<Message, HardenedSequence, Queue>{}.follow(input);
    }
}

void choose(unsigned message, unsigned ends, Input& input) {
    switch (message) {
        case 0U:
            return choose<M01>(ends, input);
        case 1U:
            return choose<M02>(ends, input);
        case 2U:
            return choose<M04>(ends, input);
        case 3U:
            return choose<M05>(ends, input);
        case 4U:
            return choose<M06>(ends, input);
        case 5U:
            return choose<M07>(ends, input);
        case 6U:
            return choose<M08>(ends, input);
        case 7U:
            return choose<M11>(ends, input);
        case 8U:
            return choose<M22>(ends, input);
        default:
            return choose<M44>(ends, input);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    const unsigned ends = input.take() % 40U;
    choose(ends / 4U, ends % 4U, input);
    return 0;
}
