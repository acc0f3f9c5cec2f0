// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lower bounds of the port cases: two copies of the bytes, and a seqlock around them.
#include <cstring>

#include "catalogue.hpp"
#include "seqlock.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class TwoMemcpy final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            std::memcpy(shared_.data(), value.data(), kSize);
            touch(shared_);
            std::memcpy(read_.data(), shared_.data(), kSize);
            touch(read_);
            sum += read_[0];
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    Message<kSize> shared_{};
    Message<kSize> read_{};
};

template <std::size_t kSize>
class SeqlockExchange final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            lock_.write(value);
            touch(lock_);
            if (lock_.try_read(read_)) {
                touch(read_);
                sum += read_[0];
            }
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    Seqlock<Message<kSize>> lock_;
    Message<kSize> read_{};
};

}  // namespace

void add_port_floors(std::vector<Case>& ports) {
    add_to_ports<TwoMemcpy>(ports, "two memcpy");
    add_to_ports<SeqlockExchange>(ports, "seqlock");
}

}  // namespace mamori::verification::bench
