// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reference implementation: LCM with its in-process transport memq, raw messages.
#include <lcm/lcm.h>

#include <cstring>
#include <stdexcept>

#include "catalogue.hpp"
#include "wake_up_pair.hpp"

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

/// A separate channel; the reader sleeps in lcm_handle().
class LcmMailbox final {
  public:
    explicit LcmMailbox(const char* name) : lcm_(lcm_create("memq://")), name_(name) {
        if (lcm_ == nullptr) {
            throw std::runtime_error("lcm_create(\"memq://\") failed");
        }
        lcm_subscribe(lcm_, name, &LcmMailbox::take, this);
    }
    ~LcmMailbox() { lcm_destroy(lcm_); }
    LcmMailbox(const LcmMailbox&) = delete;
    LcmMailbox& operator=(const LcmMailbox&) = delete;

    void post(const Message<64U>& message) { lcm_publish(lcm_, name_, message.data(), sizeof message); }
    Message<64U> await() {
        if (lcm_handle(lcm_) != 0) {
            throw std::runtime_error("lcm_handle() failed");
        }
        return read_;
    }

  private:
    static void take(const lcm_recv_buf_t* buffer, const char*, void* user) {
        std::memcpy(static_cast<LcmMailbox*>(user)->read_.data(), buffer->data, sizeof(Message<64U>));
    }

    lcm_t* lcm_;
    const char* name_;
    Message<64U> read_{};
};

}  // namespace

void add_lcm(PeerCases cases) {
    add_to_ports<LcmMemq>(cases.ports, "LCM memq");
    cases.wake_ups[0].candidates.push_back({"LCM memq", &make_subject<WakeUpPair<LcmMailbox>>});
}

}  // namespace mamori::verification::bench
