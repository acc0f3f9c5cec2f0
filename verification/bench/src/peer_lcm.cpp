// SPDX-License-Identifier: Apache-2.0
/// @file
/// Peer: LCM with its in-process transport memq, raw messages.
#include <lcm/lcm.h>

#include <cstring>
#include <stdexcept>

#include "catalogue.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
class LcmMemq final : public Subject {
  public:
    LcmMemq() : lcm_(lcm_create("memq://")) {
        if (lcm_ == nullptr) {
            throw std::runtime_error("lcm_create(\"memq://\") failed");
        }
        lcm_subscribe(lcm_, "bench", &LcmMemq::take, this);
    }
    ~LcmMemq() override { lcm_destroy(lcm_); }
    LcmMemq(const LcmMemq&) = delete;
    LcmMemq& operator=(const LcmMemq&) = delete;

    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            lcm_publish(lcm_, "bench", value.data(), kSize);
            lcm_handle(lcm_);
            touch(read_);
            sum += read_[0];
        }
        return sum;
    }

  private:
    static void take(const lcm_recv_buf_t* buffer, const char*, void* user) {
        std::memcpy(static_cast<LcmMemq*>(user)->read_.data(), buffer->data, kSize);
    }

    WrittenValues<kSize> values_;
    Message<kSize> read_{};
    lcm_t* lcm_;
};

}  // namespace

void add_lcm(std::vector<Case>& ports) {
    add_to_ports<LcmMemq>(ports, "LCM memq");
}

}  // namespace mamori::verification::bench
