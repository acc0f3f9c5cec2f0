// SPDX-License-Identifier: Apache-2.0
/// @file
/// A protected message from the output of one component to the input of another. Profile 4 has the same CRC
/// as the lower bound.
#ifndef MAMORI_VERIFICATION_BENCH_E2E_RIG_HPP
#define MAMORI_VERIFICATION_BENCH_E2E_RIG_HPP

#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/safety/e2e/e2e.hpp"
#include "subject.hpp"

namespace mamori::verification::bench {

using E2eProfile = safety::E2eProfile04<>;

template <std::size_t kSize>
inline constexpr safety::SentIdChannel kE2eChannel{0x0A0B0C0DU, E2eProfile::kHeaderSize + kSize,
                                                   E2eProfile::kHeaderSize + kSize};
inline constexpr safety::E2eInLimits<safety::HardenedSequence> kE2eLimits{
    Duration{1000}, {1U}, 4U, {{1U, 0U}, {1U, 0U}, {1U, 0U}}};

/// Both ports with the ends of the channel, which is synchronised and valid.
template <std::size_t kSize>
class E2eRig {
    using Message = safety::E2eMessage<bench::Message<kSize>, E2eProfile, kE2eChannel<kSize>>;

  public:
    E2eRig() noexcept {
        const bench::Message<kSize> nothing{};
        for (int i = 0; i < 8; ++i) {
            exchange(nothing);
        }
    }

    /// A component writes, the window ends, the next window starts, a component reads.
    void exchange(const bench::Message<kSize>& value) noexcept {
        now_ = now_ + Duration{1};
        static_cast<void>(sender_.write(value));
        out_.publish(now_);
        touch(out_);
        in_.take(out_.get_published_sample());
        touch(in_);
        static_cast<void>(receiver_.read(now_, read_));
        in_.mark_read();
    }
    /// The last value read.
    const bench::Message<kSize>& get_read() const noexcept { return read_; }

  private:
    OutPort<typename Message::Frame> out_{kNoOwner, "out"};
    InPort<typename Message::Frame> in_{kNoOwner, "in"};
    safety::E2eOutPort<Message> sender_{out_};
    safety::E2eInPort<Message, kE2eLimits> receiver_{in_, {}};
    bench::Message<kSize> read_{};
    Instant now_{};
};

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_E2E_RIG_HPP
