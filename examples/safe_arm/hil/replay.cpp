// SPDX-License-Identifier: Apache-2.0
#include "replay.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::Instant;
using mamori::Status;

/// A DriveFrame is sent soon after the start of the window `act`, and logged a little later.
constexpr Duration kSentAt = 700_us;
constexpr Duration kSearchStep = 50_us;

/// The values that drives and brakes use.
bool has_equal_outputs(const DriveFrame& a, const DriveFrame& b) noexcept {
    return a.outputs.torque_nm == b.outputs.torque_nm && a.outputs.torque_enable == b.outputs.torque_enable &&
           a.outputs.brake_release == b.outputs.brake_release && a.report.state == b.report.state;
}

}  // namespace

std::string Replay::open(const std::string& log) {
    hil::drive_sink.configure({}, drive_sink_);
    hil::state_sink.configure({}, state_sink_);
    const std::string unreadable = log + ": is not a log of lcm-logger that can be read";
    {
        mamori::ports::lcm::LogPlayer search;
        static_cast<void>(search.receive(kDriveChannel, recorded_queue_));
        if (search.open(log.c_str()) != Status::kOk) {
            return unreadable;
        }
        Status status = Status::kOk;
        while (status == Status::kOk && !recorded_.receive(now_)) {
            now_ = now_ + kSearchStep;
            status = search.deliver_until(now_);
        }
        if (status == Status::kError) {
            return log + ": is damaged at octet " + std::to_string(search.get_offset());
        }
    }
    if (recorded_.get_news().used == 0U) {
        return log + ": has no message on the channel " + kDriveChannel;
    }
    start_ = now_ - kFrame * static_cast<std::int64_t>(recorded_.get_received().frame) - kSentAt;
    static_cast<void>(player_.receive(kDeviceChannel, hil::device_queue));
    static_cast<void>(player_.receive(kCommandChannel, hil::command_queue));
    static_cast<void>(player_.receive(kDriveChannel, recorded_queue_));
    return player_.open(log.c_str()) == Status::kOk ? std::string{} : unreadable;
}

void Replay::sample(std::uint64_t, Instant now) noexcept {
    now_ = now;
    deliver(Duration{0});
}

/// The end of the log shows in the ages that the kernel checks.
void Replay::deliver(Duration into_frame) noexcept {
    static_cast<void>(player_.deliver_until(start_ + (now_ - Instant{}) + into_frame));
    if (recorded_.receive(now_)) {
        compare(recorded_.get_received());
    }
}

void Replay::compare(const DriveFrame& recorded) noexcept {
    if (!replayed_.receive(now_) || replayed_.get_received().frame != recorded.frame) {
        return;
    }
    if (has_equal_outputs(recorded, replayed_.get_received())) {
        ++equal_count_;
    } else if (!first_difference_.has_value()) {
        first_difference_ = recorded.frame;
    }
}

Status Replay::StateSink::send(mamori::Span<const std::byte>) noexcept {
    owner_.deliver(600_us);
    return Status::kOk;
}

Status Replay::DriveSink::send(mamori::Span<const std::byte> message) noexcept {
    owner_.hash_.add(message);
    ++owner_.sent_count_;
    owner_.replayed_queue_.put(message);
    return Status::kOk;
}

void Replay::Hash::add(mamori::Span<const std::byte> octets) noexcept {
    for (const std::byte octet : octets) {
        value_ = (value_ ^ static_cast<std::uint64_t>(octet)) * 0x100000001B3U;
    }
}

}  // namespace safe_arm
