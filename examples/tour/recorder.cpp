// SPDX-License-Identifier: Apache-2.0
// Flight recorder: the events of a run are in a file, also when the program crashes. Usage: recorder FILE
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"

using mamori::Status;
using namespace mamori::literals;  // NOLINT: units of the times below

/// Records each second cycle as an event with code 1.
class Pump final : public mamori::Component {
  public:
    constexpr Pump() noexcept : Component("pump") {}

    Status on_execute(mamori::ContextHandle context) noexcept override {
        ++cycles_;
        if (cycles_ % 2 == 0) {
            log_.write(context.now, mamori::Severity::kWarning, 0U, 1U, cycles_);
        }
        return Status::kOk;
    }
    mamori::EventLog& get_log() noexcept { return log_; }

  private:
    std::int64_t cycles_{0};
    std::array<mamori::Event, 8U> records_{};
    mamori::EventLog log_{records_};
};

static Pump pump;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("pump", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(pump)),
    mamori::modelled_time(pump, 100_us));
MAMORI_CHECK(kSystem);
static mamori::ExecutiveFor executive{kSystem};
static mamori::ports::posix_rt::MappedFile file;
static mamori::FlightRecorder recorder;

/// Maps `path` and continues the records in it, before the system starts.
static bool open_recorder(const char* path) {
    constexpr std::size_t kSize = mamori::flight::calc_region_size(8U);  // room for eight records
    if (file.open(path, kSize) != Status::kOk) {
        std::fprintf(stderr, "%s: %s\n", path, mamori::ports::posix_rt::describe(file.get_error()));
        return false;
    }
    if (recorder.open(file.get_region()) != Status::kOk) {
        std::fprintf(stderr, "%s: not a recorder file of this size; specify another file\n", path);
        return false;
    }
    return pump.get_log().attach(recorder) == Status::kOk;
}

class NoDevices final : public mamori::ports::virtual_time::FrameDevices {
    void begin_frame(std::uint64_t, mamori::Instant) noexcept override {}
    void end_frame(std::uint64_t, mamori::Instant, mamori::Duration) noexcept override {}
};

int main(int argc, char** argv) {
    if (argc != 2 || !open_recorder(argv[1])) {
        return 2;
    }
    std::printf("session %u begins with record %u\n", recorder.get_session(),
                static_cast<unsigned>(recorder.get_next_sequence()));
    mamori::ports::virtual_time::VirtualHostFor host{kSystem};
    mamori::ports::virtual_time::SimulatedCore core{executive, host};
    NoDevices devices;
    mamori::ports::virtual_time::FrameRunner runner{{&core, 1U}, devices};
    const bool is_ok = executive.initialize() == Status::kOk && executive.start() == Status::kOk;
    for (int frame = 0; is_ok && frame < 6; ++frame) {
        runner.run_frame();
    }
    std::printf("next record %u, %u overwritten\n", static_cast<unsigned>(recorder.get_next_sequence()),
                static_cast<unsigned>(recorder.get_overwritten_count()));
    return is_ok && executive.stop() == Status::kOk ? 0 : 1;
}
