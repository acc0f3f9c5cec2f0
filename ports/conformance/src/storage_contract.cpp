// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/conformance/storage_contract.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/ports/conformance/rule_trial.hpp"

namespace mamori::ports::conformance {
namespace {

constexpr const char* kRequirement = "SWR-CNF-007";

using Bytes = std::vector<std::byte>;

constexpr std::size_t kCapacity = 6U;  ///< records; a few writes return to the first slot
constexpr std::size_t kSpare = 24U;    ///< bytes after the records
constexpr std::size_t kSize = flight::calc_region_size(kCapacity) + kSpare;

Span<std::byte> view(Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}

/// Writes a session of the flight recorder with two records.
void write_records(Span<std::byte> region) {
    FlightRecorder recorder;
    if (recorder.open(region) == Status::kOk) {
        for (std::int64_t i = 0; i < 2; ++i) {
            const auto sequence = static_cast<std::int64_t>(recorder.get_next_sequence());
            recorder.write(Instant{sequence}, Severity::kInfo, 1U, 2U, sequence * 3);
        }
    }
}

/// Like write_records(), and also writes the beginning of a third record.
void write_torn(Span<std::byte> region) {
    write_records(region);
    FlightReader reader;
    if (reader.open({region.data(), region.size()}) == Status::kOk) {
        const std::size_t slot = flight::calc_slot(reader.calc_newest_sequence() + 1U, kCapacity);
        const std::size_t begin = flight::calc_region_size(slot);
        region[begin + flight::kCommitOffset] = std::byte{0U};
        region[begin] = std::byte{0x55U};
    }
}

/// Writes the first and the last byte that no record uses.
void write_spare(Span<std::byte> region) {
    for (const std::size_t place : {kSize - kSpare, kSize - 1U}) {
        region[place] = static_cast<std::byte>(std::to_integer<unsigned>(region[place]) + 1U);
    }
}

void write_unexpected(Span<std::byte> region) {
    std::fill(region.begin(), region.end(), std::byte{0xA5U});
}

/// Numbers of the readable records.
std::vector<std::uint64_t> list_records(Span<std::byte> region) {
    std::vector<std::uint64_t> numbers;
    FlightReader reader;
    if (reader.open({region.data(), region.size()}) == Status::kOk) {
        for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
            FlightRecord record{};
            if (reader.read(slot, record) == SlotState::kWhole) {
                numbers.push_back(record.sequence);
            }
        }
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

/// The model contains the expected bytes: each write to the port is also applied to the model.
class StorageSubject final {
  public:
    explicit StorageSubject(std::unique_ptr<StorageRig> rig) : rig_(std::move(rig)) {}

    bool is_open() const { return is_open_; }
    bool is_there() const { return !content_.empty(); }

    void open(Judge& judge) {
        make_content();
        judge.expect(rig_->open(kSize) == Status::kOk, "a valid region was rejected");
        is_open_ = true;
        compare(judge);
        const std::vector<std::uint64_t> records = list_records(rig_->get_region());
        judge.expect(newest_before_crash_ == 0U ||
                         std::binary_search(records.begin(), records.end(), newest_before_crash_),
                     "a record written before a crash cannot be read");
        newest_before_crash_ = 0U;
    }

    void close(Judge& judge) {
        rig_->close();
        is_open_ = false;
        judge.expect(rig_->get_region().empty(), "a closed region is still accessible");
    }

    void write(void (*action)(Span<std::byte>), Judge& judge) {
        compare(judge);
        action(rig_->get_region());
        action(view(content_));
        compare(judge);
    }

    void crash(void (*action)(Span<std::byte>)) {
        make_content();
        const std::vector<std::uint64_t> before = list_records(view(content_));
        action(view(content_));
        newest_before_crash_ = before.empty() ? 0U : before.back();
        rig_->crash(kSize, action);
    }

    void open_wrong(std::size_t size, Judge& judge) {
        const Status status = rig_->open(size);
        judge.expect(status != Status::kOk, "a region of another size was opened");
        judge.expect(size != 0U || status == Status::kBadParameter, "size 0 is a bad parameter");
        judge.expect(rig_->get_region().empty(), "a rejected region is accessible");
        if (status == Status::kOk) {
            rig_->close();
        }
    }

    void open_again(Judge& judge) {
        judge.expect(rig_->open(kSize) == Status::kPreconditionNotMet, "a region was opened twice");
        compare(judge);
    }

    void open_as_another(Judge& judge) {
        judge.expect(rig_->open_as_another(kSize) != Status::kOk, "a second user got the region");
        compare(judge);
    }

    /// Unexpected content is unchanged, and formatted only on request.
    void reject_unexpected(Judge& judge) {
        write(&write_unexpected, judge);
        FlightRecorder recorder;
        judge.expect(recorder.open(rig_->get_region()) == Status::kError, "unexpected content was opened");
        compare(judge);
        write([](Span<std::byte> region) { static_cast<void>(FlightRecorder::format(region)); }, judge);
    }

    std::string describe_state() const {
        Bytes bytes = content_;
        const std::vector<std::uint64_t> records =
            bytes.empty() ? std::vector<std::uint64_t>{} : list_records(view(bytes));
        return std::string{is_open_ ? "open " : "closed "} + (is_there() ? "there " : "none ") +
               std::to_string(records.size());
    }

  private:
    /// A new region is zero-filled.
    void make_content() { content_.resize(kSize); }

    void compare(Judge& judge) {
        const Span<std::byte> region = rig_->get_region();
        judge.expect_equal(static_cast<std::int64_t>(region.size()), static_cast<std::int64_t>(kSize),
                           "size of the region");
        judge.expect(region.size() == kSize && std::equal(region.begin(), region.end(), content_.begin()),
                     "the region does not contain the stored data");
    }

    std::unique_ptr<StorageRig> rig_;
    Bytes content_;
    bool is_open_{false};
    std::uint64_t newest_before_crash_{0U};
};

bool is_closed(const StorageSubject& subject) {
    return !subject.is_open();
}
bool is_closed_and_there(const StorageSubject& subject) {
    return !subject.is_open() && subject.is_there();
}
bool is_open(const StorageSubject& subject) {
    return subject.is_open();
}

Rule<StorageSubject> make_write(const char* name, void (*action)(Span<std::byte>)) {
    return {name, kRequirement, is_open,
            [action](StorageSubject& subject, Judge& judge) { subject.write(action, judge); }};
}
Rule<StorageSubject> make_crash(const char* name, void (*action)(Span<std::byte>)) {
    return {name, kRequirement, is_closed,
            [action](StorageSubject& subject, Judge&) { subject.crash(action); }};
}
Rule<StorageSubject> make_wrong(const char* name, std::size_t size) {
    return {name, kRequirement, is_closed_and_there,
            [size](StorageSubject& subject, Judge& judge) { subject.open_wrong(size, judge); }};
}

Rules<StorageSubject> make_rules() {
    return {
        {"open", kRequirement, is_closed, [](StorageSubject& subject, Judge& judge) { subject.open(judge); }},
        make_write("write records", &write_records),
        make_write("write bytes at the ends", &write_spare),
        {"open an open region", kRequirement, is_open,
         [](StorageSubject& subject, Judge& judge) { subject.open_again(judge); }},
        {"open as another user", kRequirement, is_open,
         [](StorageSubject& subject, Judge& judge) { subject.open_as_another(judge); }},
        {"close", kRequirement, is_open, [](StorageSubject& subject, Judge& judge) { subject.close(judge); }},
        make_wrong("open with one byte too few", kSize - 1U),
        make_wrong("open with one byte too many", kSize + 1U),
        make_wrong("open with size 0", 0U),
        make_crash("crash after a record", &write_records),
        make_crash("crash during a record", &write_torn),
        {"unexpected content", kRequirement, is_open,
         [](StorageSubject& subject, Judge& judge) { subject.reject_unexpected(judge); }},
    };
}

}  // namespace

TrialFactory make_storage_trials(RigFactory<StorageRig> make_rig) {
    return make_trials<StorageSubject>(make_rules(), [make_rig = std::move(make_rig)] {
        return std::make_unique<StorageSubject>(make_rig());
    });
}

}  // namespace mamori::ports::conformance
