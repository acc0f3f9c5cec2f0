// SPDX-License-Identifier: Apache-2.0
// Queues: an encoder writes five counts in each cycle, and a logger reads them in one cycle.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/dataflow/queue_out_port.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

constexpr std::size_t kCountsPerCycle = 5U;

class Encoder final : public mamori::Component {
  public:
    constexpr Encoder() noexcept : Component("encoder") {}
    mamori::QueueOutPort<std::int32_t, kCountsPerCycle> count{*this, "count"};
    using Ports = mamori::Ports<&Encoder::count>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        Status status = Status::kOk;
        for (std::size_t i = 0U; i < kCountsPerCycle && status == Status::kOk; ++i) {
            status = count.write(++count_);
        }
        return status;
    }

  private:
    std::int32_t count_{0};
};

/// Capacity of each queue: one value less than the encoder writes in a cycle.
constexpr std::size_t kCapacity = 4U;

class Logger final : public mamori::Component {
  public:
    constexpr Logger() noexcept : Component("logger") {}
    // A full queue overwrites its oldest value, or rejects the new one.
    mamori::QueueInPort<std::int32_t, kCapacity> newest{*this, "newest"};
    mamori::QueueInPort<std::int32_t, kCapacity, mamori::FullPolicy::kDoNothing> oldest{*this, "oldest"};
    using Ports = mamori::Ports<&Logger::newest, &Logger::oldest>;
    using Counts = std::array<std::int32_t, kCapacity>;

    Status on_execute(mamori::ContextHandle) noexcept override {
        for (std::size_t i = 0U; i < kCapacity && newest.has_waiting(); ++i) {
            static_cast<void>(newest.read(newest_counts_[i]));
        }
        for (std::size_t i = 0U; i < kCapacity && oldest.has_waiting(); ++i) {
            static_cast<void>(oldest.read(oldest_counts_[i]));
        }
        return Status::kOk;
    }
    const Counts& get_newest_counts() const noexcept { return newest_counts_; }
    const Counts& get_oldest_counts() const noexcept { return oldest_counts_; }

  private:
    Counts newest_counts_{};
    Counts oldest_counts_{};
};

static Encoder encoder;
static Logger logger;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("count", 0_ms, 500_us, mamori::budget(400_us), mamori::run(encoder)),
    mamori::window("log", 9_ms, 1_ms, mamori::budget(900_us), mamori::run(logger)),
    mamori::connect(encoder.count, logger.newest, mamori::fresh_within(10_ms)),
    mamori::connect(encoder.count, logger.oldest, mamori::fresh_within(10_ms)),
    mamori::modelled_time(encoder, 100_us), mamori::modelled_time(logger, 200_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

static void print(std::uint64_t frame) {
    std::printf("after %u ms:", static_cast<unsigned>(frame + 1U) * 10U);
    for (const std::int32_t count : logger.get_newest_counts()) {
        std::printf(" %d", count);
    }
    std::printf(" (%u overwritten),", logger.newest.get_overwritten_count());
    for (const std::int32_t count : logger.get_oldest_counts()) {
        std::printf(" %d", count);
    }
    std::printf(" (%u rejected)\n", logger.oldest.get_rejected_count());
}

int main() {
    return machine.run(3U, print) == Status::kOk ? 0 : 1;
}
