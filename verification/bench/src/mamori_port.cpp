// SPDX-License-Identifier: Apache-2.0
/// @file
/// Mamori in the port cases: a component writes, the window ends, the next window starts, a component reads.
#include "catalogue.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class MamoriPort final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            out_.write(value);
            out_.publish(now_);
            touch(out_);
            in_.take(out_.get_published_sample());
            touch(in_);
            sum += in_.read()[0];
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    OutPort<Message<kSize>> out_{kNoOwner, "out"};
    InPort<Message<kSize>> in_{kNoOwner, "in"};
    Instant now_{};
};

}  // namespace

void add_mamori_port(std::vector<Case>& ports) {
    add_to_ports<MamoriPort>(ports, "mamori port");
}

}  // namespace mamori::verification::bench
