// SPDX-License-Identifier: Apache-2.0
// Flight recorder: the events of a run are in a file, also when the program crashes. Usage: recorder FILE
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/virtual_time/machine.hpp"

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
static mamori::ports::virtual_time::Machine<kSystem> machine;
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

int main(int argc, char** argv) {
    if (argc != 2 || !open_recorder(argv[1])) {
        return 2;
    }
    std::printf("session %u begins with record %u\n", recorder.get_session(),
                static_cast<unsigned>(recorder.get_next_sequence()));
    const Status status = machine.run(6U);
    std::printf("next record %u, %u overwritten\n", static_cast<unsigned>(recorder.get_next_sequence()),
                static_cast<unsigned>(recorder.get_overwritten_count()));
    return status == Status::kOk ? 0 : 1;
}
