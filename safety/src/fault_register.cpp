// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/fault_register.hpp"

#include "mamori/safety/count_up.hpp"

namespace mamori::safety {

Status FaultRegister::set_confirmation(FaultIndex fault, std::uint32_t confirm_cycles) noexcept {
    if (fault >= records_.size() || confirm_cycles == 0U) {
        return Status::kBadParameter;
    }
    FaultRecord& record = records_[fault];
    if (record.is_present || record.is_latched) {
        return Status::kPreconditionNotMet;
    }
    record.confirm_cycles = confirm_cycles;
    return Status::kOk;
}

void FaultRegister::latch(FaultRecord& record, Instant now) noexcept {
    count_up(record.occurrences);
    if (record.is_latched) {
        return;  // the instants of the first occurrence are kept
    }
    record.is_latched = true;
    record.latched_at = now;
    record.order = next_order_;
    ++next_order_;
    ++latched_count_;
}

void FaultRegister::report(FaultIndex fault, bool is_present, Instant now) noexcept {
    FaultRecord& record = records_[fault];
    record.is_present = is_present;
    if (!is_present) {
        record.present_cycles = 0U;
        return;
    }
    if (record.present_cycles == 0U && !record.is_latched) {
        record.seen_at = now;
    }
    if (record.present_cycles < record.confirm_cycles) {
        ++record.present_cycles;
        if (record.present_cycles == record.confirm_cycles) {
            latch(record, now);
        }
    }
}

Status FaultRegister::acknowledge(FaultIndex fault) noexcept {
    if (fault >= records_.size()) {
        return Status::kBadParameter;
    }
    FaultRecord& record = records_[fault];
    if (!record.is_latched || record.is_present) {
        return Status::kPreconditionNotMet;
    }
    record.is_latched = false;
    record.order = 0U;
    --latched_count_;
    if (latched_count_ == 0U) {
        next_order_ = 1U;
    }
    return Status::kOk;
}

Status FaultRegister::acknowledge_all() noexcept {
    for (std::size_t i = 0U; i < records_.size(); ++i) {
        static_cast<void>(acknowledge(static_cast<FaultIndex>(i)));  // refused by those that must stay
    }
    return latched_count_ == 0U ? Status::kOk : Status::kPreconditionNotMet;
}

FaultIndex FaultRegister::get_first() const noexcept {
    FaultIndex first = kNoFault;
    for (std::size_t i = 0U; i < records_.size(); ++i) {
        if (records_[i].is_latched && (first == kNoFault || records_[i].order < records_[first].order)) {
            first = static_cast<FaultIndex>(i);
        }
    }
    return first;
}

}  // namespace mamori::safety
