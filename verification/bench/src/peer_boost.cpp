// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reference implementation: the single-producer single-consumer queue of Boost.Lockfree.
#include <boost/lockfree/spsc_queue.hpp>

#include "catalogue.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class BoostSpsc final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            queue_.push(value);
            touch(queue_);
            if (queue_.pop(read_)) {
                touch(read_);
                sum += read_[0];
            }
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    boost::lockfree::spsc_queue<Message<kSize>, boost::lockfree::capacity<4>> queue_;
    Message<kSize> read_{};
};

}  // namespace

void add_boost(PeerCases cases) {
    add_to_ports<BoostSpsc>(cases.ports, "Boost SPSC");
}

}  // namespace mamori::verification::bench
