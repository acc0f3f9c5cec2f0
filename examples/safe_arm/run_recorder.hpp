// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flight recorder of a run: a mapped file that takes the supervisor's events as they happen, and the table
/// that names their numbers beside it. `mamori log FILE` shows both.
///
/// @satisfies SWR-REC-014      Design: docs/design/recorder.md#in-the-example
#ifndef EXAMPLES_SAFE_ARM_RUN_RECORDER_HPP
#define EXAMPLES_SAFE_ARM_RUN_RECORDER_HPP

#include <string>

#include "mamori/kernel/record/event_log.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"

namespace safe_arm {

/// Room of the file: 1024 events, 41 kB. A run writes some ten.
inline constexpr std::size_t kRecorderCapacity = 1024U;

/// Owner of the file while the run lasts; must outlive the last event. Thread safety: none.
class RunRecorder final {
  public:
    /// Goes on in the file at `path`, or makes it, writes `path`.names.json, and takes the events of `log`
    /// from here on.
    /// @return empty on success, else one line with the reason; the file is as it was then.
    std::string begin(const std::string& path, mamori::EventLog& log);

  private:
    mamori::ports::posix_rt::MappedFile file_;
    mamori::FlightRecorder recorder_;
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_RUN_RECORDER_HPP
