// SPDX-License-Identifier: Apache-2.0
// Event log: a battery monitor records numbered events; the program prints them with their names at the end.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

/// Codes of the events of the battery. The names stay on the host.
enum class BatteryEvent : std::uint16_t { kStarted, kLow, kEmpty };
constexpr std::array<const char*, 3U> kEventNames{"started", "low", "empty"};
constexpr std::array<const char*, 3U> kSeverityNames{"info", "warning", "fault"};

/// Discharges by 20 % in each cycle and records what it finds.
class Battery final : public mamori::Component {
  public:
    constexpr Battery() noexcept : Component("battery") {}

    Status on_activated(mamori::ContextHandle context) noexcept override {
        write(context.now, mamori::Severity::kInfo, BatteryEvent::kStarted);
        return Status::kOk;
    }
    Status on_execute(mamori::ContextHandle context) noexcept override {
        charge_percent_ -= 20;
        if (charge_percent_ == 0) {
            write(context.now, mamori::Severity::kFault, BatteryEvent::kEmpty);
            return Status::kError;
        }
        if (charge_percent_ <= 60) {
            write(context.now, mamori::Severity::kWarning, BatteryEvent::kLow);
        }
        return Status::kOk;
    }
    const mamori::EventLog& get_log() const noexcept { return log_; }

  private:
    static constexpr std::uint16_t kSource = 7U;  ///< number of the battery in the event table

    void write(mamori::Instant now, mamori::Severity severity, BatteryEvent event) noexcept {
        log_.write(now, severity, kSource, static_cast<std::uint16_t>(event), charge_percent_);
    }

    std::int64_t charge_percent_{100};
    std::array<mamori::Event, 4U> records_{};
    mamori::EventLog log_{records_};
};

static Battery battery;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("battery", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(battery)),
    mamori::modelled_time(battery, 100_us));
static mamori::ports::virtual_time::Machine<kSystem> machine;

static void print_log(const mamori::EventLog& log) {
    for (std::size_t i = 0U; i < log.size(); ++i) {
        const mamori::Event& event = log.get(i);
        std::printf("%u at %2d ms: %s, source %u, %s, charge %d %%\n", event.sequence,
                    static_cast<int>(event.time.ns / 1'000'000),
                    kSeverityNames[static_cast<std::size_t>(event.severity)], event.source,
                    kEventNames[event.code], static_cast<int>(event.argument));
    }
    std::printf("%u lost\n", log.get_lost_count());
}

int main() {
    const Status status = machine.run(6U);
    print_log(battery.get_log());
    return status == Status::kOk ? 0 : 1;
}
