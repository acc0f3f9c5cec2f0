// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/record/event_log.hpp"

#include <limits>

#include "mamori/kernel/record/flight_recorder.hpp"

namespace mamori {

Status EventLog::attach(FlightRecorder& recorder) noexcept {
    if (recorder_ != nullptr || !recorder.is_open()) {
        return Status::kPreconditionNotMet;
    }
    recorder_ = &recorder;
    return Status::kOk;
}

void EventLog::write(Instant time, Severity severity, std::uint16_t source, std::uint16_t code,
                     std::int64_t argument) noexcept {
    if (recorder_ != nullptr) {
        recorder_->write(time, severity, source, code, argument);
    }
    const bool is_full = kept_count_ == storage_.size();
    if (is_full && lost_count_ < std::numeric_limits<std::uint32_t>::max()) {
        ++lost_count_;
    }
    const std::uint32_t sequence = written_count_;
    ++written_count_;
    if (storage_.empty()) {
        return;
    }
    storage_[next_index_] = Event{sequence, severity, source, code, time, argument};
    next_index_ = (next_index_ + 1U) % storage_.size();
    if (!is_full) {
        ++kept_count_;
    }
}

std::size_t EventLog::size() const noexcept {
    return kept_count_;
}

const Event& EventLog::get(std::size_t index) const noexcept {
    MAMORI_REQUIRE(1, index < kept_count_);
    const std::size_t oldest = (next_index_ + storage_.size() - kept_count_) % storage_.size();
    return storage_[(oldest + index) % storage_.size()];
}

}  // namespace mamori
