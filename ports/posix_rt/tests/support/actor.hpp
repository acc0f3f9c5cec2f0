// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component that does what its test says in its next cycle.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_ACTOR_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_ACTOR_HPP

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/frame_clock.hpp"

namespace mamori::ports::posix_rt {

/// Does what the test says in its next cycle.
class Actor final : public Component {
  public:
    explicit Actor(const char* name) noexcept : Component(name) {}
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Actor::out>;

    std::atomic<bool> is_to_hang{false};
    std::atomic<bool> is_hanging{false};
    const FrameClock* clock{nullptr};
    Instant busy_until{};
    std::vector<std::int64_t> starts;

    Status on_execute(ContextHandle handle) noexcept override {
        starts.push_back(handle.now.ns);
        if (is_to_hang) {
            is_hanging = true;
            while (is_to_hang) {
                std::this_thread::yield();
            }
            is_hanging = false;
        }
        while (clock != nullptr && clock->get_now() <= busy_until) {
        }
        out.write(++count_);
        return Status::kOk;
    }

  private:
    std::int64_t count_{0};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_ACTOR_HPP
