// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/lcm_link.hpp"

#include <lcm/lcm.h>

#include "link_thread.hpp"
#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::lcm {

namespace {

/// Messages that liblcm keeps for one channel until the receiving thread takes them.
constexpr int kQueueLength = 256;

lcm_t* get_lcm(LcmHandle* handle) noexcept {
    return reinterpret_cast<lcm_t*>(handle);
}

void take_message(const lcm_recv_buf_t* message, const char* /*channel*/, void* inbox) noexcept {
    static_cast<MessageInbox*>(inbox)->put(
        {static_cast<const std::byte*>(message->data), static_cast<std::size_t>(message->data_size)});
}

}  // namespace

Status LcmLink::open(const char* url) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    url_ = url;
    MAMORI_ENSURE(1, ::pthread_barrier_init(&connected_, nullptr, 2U) == 0);
    if (detail::start_thread(thread_, stop_, &LcmLink::serve, this) != Status::kOk) {
        fault_ = LinkFault::kThread;
    } else {
        static_cast<void>(::pthread_barrier_wait(&connected_));
        if (fault_ != LinkFault::kNone) {
            detail::stop_thread(thread_, stop_);
        }
    }
    static_cast<void>(::pthread_barrier_destroy(&connected_));
    return fault_ == LinkFault::kNone ? Status::kOk : Status::kError;
}

void LcmLink::close() noexcept {
    if (is_open()) {
        detail::stop_thread(thread_, stop_);
        ::lcm_destroy(get_lcm(handle_));
        handle_ = nullptr;
    }
}

Status LcmLink::publish(const char* channel, Span<const std::byte> message) noexcept {
    if (!is_open()) {
        return Status::kPreconditionNotMet;
    }
    const int error =
        ::lcm_publish(get_lcm(handle_), channel, message.data(), static_cast<unsigned>(message.size()));
    return error == 0 ? Status::kOk : Status::kError;
}

void* LcmLink::serve(void* link) noexcept {
    static_cast<LcmLink*>(link)->run();
    return nullptr;
}

/// In the receiving thread, because the threads of liblcm inherit its priority.
LinkFault LcmLink::connect() noexcept {
    lcm_t* const lcm = ::lcm_create(url_);
    if (lcm == nullptr) {
        return LinkFault::kUrl;
    }
    for (std::size_t i = 0U; i < channel_count_; ++i) {
        const Channel& channel = channels_[i];
        lcm_subscription_t* const subscription =
            ::lcm_subscribe(lcm, channel.name, &take_message, channel.inbox);
        if (subscription == nullptr ||
            ::lcm_subscription_set_queue_capacity(subscription, kQueueLength) != 0) {
            ::lcm_destroy(lcm);
            return LinkFault::kSubscribe;
        }
    }
    handle_ = reinterpret_cast<LcmHandle*>(lcm);
    return LinkFault::kNone;
}

void LcmLink::run() noexcept {
    fault_ = connect();
    const bool is_connected = fault_ == LinkFault::kNone;
    is_receiving_.store(is_connected, std::memory_order_relaxed);
    lcm_t* const lcm = get_lcm(handle_);
    static_cast<void>(::pthread_barrier_wait(&connected_));
    if (!is_connected) {
        return;
    }
    const int file = ::lcm_get_fileno(lcm);
    while (detail::wait_for(file, stop_) && ::lcm_handle(lcm) == 0) {
    }
    is_receiving_.store(false, std::memory_order_relaxed);
}

}  // namespace mamori::ports::lcm
