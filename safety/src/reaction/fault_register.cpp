// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/reaction/fault_register.hpp"

#include "mamori/safety/base/elapsed.hpp"
#include "mamori/safety/base/saturating_increment.hpp"

namespace mamori::safety {

namespace {

/// Nothing is known of the fault yet that another rule could have judged otherwise.
bool is_untouched(const FaultRecord& record) noexcept {
    return !record.is_present && record.count == 0U && !record.is_latched;
}

}  // namespace

Status FaultRegister::set_confirmation(FaultIndex fault, Confirmation confirmation) noexcept {
    if (fault >= records_.size() || !is_valid(confirmation)) {
        return Status::kBadParameter;
    }
    if (!is_untouched(records_[fault])) {
        return Status::kPreconditionNotMet;
    }
    records_[fault].confirmation = confirmation;
    return Status::kOk;
}

Status FaultRegister::set_healing(FaultIndex fault, Healing healing) noexcept {
    if (fault >= records_.size() || !is_valid(healing)) {
        return Status::kBadParameter;
    }
    if (!is_untouched(records_[fault])) {
        return Status::kPreconditionNotMet;
    }
    records_[fault].healing = healing;
    return Status::kOk;
}

void FaultRegister::latch(FaultRecord& record, Instant now) noexcept {
    saturating_increment(record.occurrences);
    if (record.is_latched) {
        return;  // the instants of the first occurrence are kept
    }
    record.is_latched = true;
    record.latched_at = now;
    record.order = next_order_;
    ++next_order_;
    ++latched_count_;
}

bool FaultRegister::is_to_be_latched(const FaultRecord& record, Instant now) noexcept {
    const Confirmation& limits = record.confirmation;
    if (limits.cycles != 0U && record.count >= limits.cycles) {
        return true;
    }
    const bool is_in_time = now >= record.judged_at && calc_elapsed(record.changed_at, now) < limits.time;
    return limits.time > Duration{0} && !is_in_time;
}

void FaultRegister::note_presence(FaultRecord& record, Instant now) noexcept {
    if (!record.is_present) {
        record.changed_at = now;
        record.is_confirmed = false;
    }
    if (record.count == 0U && !record.is_latched) {
        record.seen_at = now;
    }
    record.is_present = true;
    record.absent_cycles = 0U;
    saturating_increment(record.count);
    if (!record.is_confirmed && is_to_be_latched(record, now)) {
        record.is_confirmed = true;
        latch(record, now);
    }
}

void FaultRegister::note_absence(FaultRecord& record, Instant now) noexcept {
    const bool has_run_backwards = now < record.judged_at;
    if (record.is_present || has_run_backwards) {
        record.changed_at = now;
        record.absent_cycles = 0U;
    }
    record.is_present = false;
    saturating_increment(record.absent_cycles);
    // A presence that was confirmed is over: what comes next is judged anew.
    const bool is_all_forgotten = record.is_confirmed || record.confirmation.decay == 0U;
    const std::uint32_t decay = is_all_forgotten ? record.count : record.confirmation.decay;
    record.count -= decay < record.count ? decay : record.count;
    record.is_confirmed = false;
}

void FaultRegister::report(FaultIndex fault, bool is_present, Instant now) noexcept {
    FaultRecord& record = records_[fault];
    if (is_present) {
        note_presence(record, now);
    } else if (!is_untouched(record)) {  // else the way of nearly every cycle: nothing decays, nothing heals
        note_absence(record, now);
    }
    record.judged_at = now;
}

bool FaultRegister::has_healed(const FaultRecord& record) noexcept {
    return !record.is_present && record.absent_cycles >= record.healing.cycles &&
           calc_elapsed(record.changed_at, record.judged_at) >= record.healing.time;
}

Status FaultRegister::acknowledge(FaultIndex fault) noexcept {
    if (fault >= records_.size()) {
        return Status::kBadParameter;
    }
    FaultRecord& record = records_[fault];
    if (!record.is_latched || !has_healed(record)) {
        return Status::kPreconditionNotMet;
    }
    record.is_latched = false;
    record.count = 0U;
    record.order = 0U;
    record.demand = ReactionDemand{};
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

const ReactionDemand& FaultRegister::raise(const ReactionDemand& demand) noexcept {
    FaultRecord& record = records_[demand.fault];
    if (record.is_latched && is_worse(demand, record.demand)) {
        record.demand = demand;
    }
    return record.demand;
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
