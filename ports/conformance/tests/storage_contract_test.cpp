// SPDX-License-Identifier: Apache-2.0
// Goal: the storage rules accept a storage that complies with its contract and report each violation. Method:
// storages in memory with one defect each.
#include "mamori/ports/conformance/storage_contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/ports/conformance/rule_runner.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/rule_names.hpp"

namespace mamori::ports::conformance {
namespace {

using namespace verification;

enum class StorageFlaw {
    kNone,
    kLosesAWrite,
    kForgetsAtClose,
    kForgetsAtCrash,
    kTearsAtCrash,
    kBeginsDirty,
    kTakesAnySize,
    kTakesNoSize,
    kRefusesWithoutCare,
    kOpensTwice,
    kHasTwoUsers,
    kGivesANarrowerRegion,
    kStaysReachable,
    kRefusesWhatIsThere,
    kShowsARefusedRegion,
    kChangesWhenOpenedAgain,
    kChangesForAnotherUser,
    kChangesBetweenWrites,
};

constexpr std::size_t kSize = flight::calc_region_size(6U) + 24U;

/// The bytes of a region, or its records and the bytes that no record uses.
std::string describe(Span<const std::byte> region) {
    const auto to_text = [](std::byte byte) { return std::to_string(std::to_integer<unsigned>(byte)); };
    if (std::all_of(region.begin(), region.end(), [&region](std::byte byte) { return byte == region[0]; })) {
        return "all " + to_text(region[0]);
    }
    FlightReader reader;
    std::string text = reader.open(region) == Status::kOk ? "" : "no recorder ";
    for (std::size_t slot = 0U; slot < reader.get_capacity(); ++slot) {
        FlightRecord record{};
        const SlotState state = reader.read(slot, record);
        if (state == SlotState::kWhole) {
            text += std::to_string(record.sequence) + "@" + std::to_string(record.time.ns) + ":" +
                    std::to_string(record.source) + "," + std::to_string(record.code) + "," +
                    std::to_string(record.argument) + " ";
        } else {
            text += state == SlotState::kEmpty ? "- " : state == SlotState::kTorn ? "torn " : "corrupt ";
            text += state == SlotState::kEmpty ? "" : to_text(region[flight::calc_region_size(slot)]) + " ";
        }
    }
    const std::size_t end = kSize - 24U;
    text += "spare";
    for (std::size_t i = end; i < region.size(); ++i) {
        text += region[i] == std::byte{0U} ? "" : " " + std::to_string(i - end) + "=" + to_text(region[i]);
    }
    return text;
}

class FlawedStorage final : public StorageRig {
  public:
    /// @param[out] calls receives one line per request and per change of the region, unless it is nullptr.
    FlawedStorage(StorageFlaw flaw, std::string* calls) : flaw_(flaw), calls_(calls) {}

    Status open(std::size_t size) override {
        note("open " + std::to_string(size));
        is_refused_ = is_open_ || size != kSize;
        if (size == 0U) {
            return has(StorageFlaw::kTakesNoSize) ? Status::kError : Status::kBadParameter;
        }
        if (is_open_ && !has(StorageFlaw::kOpensTwice)) {
            change_if(StorageFlaw::kChangesWhenOpenedAgain);
            return Status::kPreconditionNotMet;
        }
        if (!bytes_.empty() && (bytes_.size() != size || has(StorageFlaw::kRefusesWhatIsThere)) &&
            !has(StorageFlaw::kTakesAnySize)) {
            if (has(StorageFlaw::kRefusesWithoutCare)) {
                std::fill(bytes_.begin(), bytes_.end(), std::byte{0U});
            }
            return Status::kError;
        }
        make(size);
        is_open_ = true;
        return Status::kOk;
    }
    void close() override {
        note("close");
        is_open_ = false;
        is_refused_ = false;
        if (has(StorageFlaw::kLosesAWrite)) {
            bytes_.back() = std::byte{0U};
        } else if (has(StorageFlaw::kForgetsAtClose)) {
            std::fill(bytes_.begin(), bytes_.end(), std::byte{0U});
        }
    }
    Span<std::byte> get_region() override {
        const bool is_shown = has(StorageFlaw::kShowsARefusedRegion) && is_refused_;
        if (!is_open_ && !has(StorageFlaw::kStaysReachable) && !is_shown) {
            return {};
        }
        note_region();
        if (++look_count_ % 8U == 0U) {
            change_if(StorageFlaw::kChangesBetweenWrites);
        }
        return {bytes_.data(), bytes_.size() - (has(StorageFlaw::kGivesANarrowerRegion) ? 1U : 0U)};
    }
    Status open_as_another(std::size_t size) override {
        note("open as another " + std::to_string(size));
        change_if(StorageFlaw::kChangesForAnotherUser);
        return has(StorageFlaw::kHasTwoUsers) ? Status::kOk : Status::kError;
    }
    void crash(std::size_t size, const std::function<void(Span<std::byte>)>& write) override {
        note("crash " + std::to_string(size));
        make(size);
        const std::vector<std::byte> before = bytes_;
        write({bytes_.data(), bytes_.size()});
        note_region();
        if (has(StorageFlaw::kForgetsAtCrash)) {
            bytes_ = before;
        } else if (has(StorageFlaw::kTearsAtCrash)) {
            std::fill(bytes_.begin() + 64, bytes_.begin() + 104, std::byte{0U});
        }
    }

  private:
    bool has(StorageFlaw flaw) const { return flaw_ == flaw; }
    void change_if(StorageFlaw flaw) {
        if (has(flaw)) {
            bytes_.back() ^= std::byte{128U};
        }
    }
    void note(const std::string& call) {
        if (calls_ != nullptr) {
            *calls_ += call + "\n";
        }
    }
    void note_region() {
        if (calls_ != nullptr && bytes_ != noted_) {
            noted_ = bytes_;
            note(describe({bytes_.data(), bytes_.size()}));
        }
    }

    void make(std::size_t size) {
        bytes_.resize(size, has(StorageFlaw::kBeginsDirty) ? std::byte{1U} : std::byte{0U});
    }

    StorageFlaw flaw_;
    std::string* calls_;
    std::vector<std::byte> bytes_;
    std::vector<std::byte> noted_;
    std::size_t look_count_{0U};
    bool is_open_{false};
    bool is_refused_{false};
};

TrialFactory make(StorageFlaw flaw, std::string* calls = nullptr) {
    return make_storage_trials([flaw, calls] { return std::make_unique<FlawedStorage>(flaw, calls); });
}

struct FlawCase {
    StorageFlaw flaw;
    const char* sentence;
};
void PrintTo(const FlawCase& flaw, std::ostream* out) {
    *out << flaw.sentence;
}

class StorageFlawTest : public ::testing::TestWithParam<FlawCase> {};

TEST_P(StorageFlawTest, IsReportedInEachOrder) {
    verifies("SWR-CNF-007", Technique::kFaultInjection, Polarity::kViolation);
    const TrialFactory factory = make(GetParam().flaw);

    const Report report = run_in_order(factory);
    ASSERT_FALSE(report.is_kept());
    EXPECT_NE(report.findings[0].find(GetParam().sentence), std::string::npos) << report.to_text();
    EXPECT_FALSE(run_randomly(factory, 1U, 1000U).is_kept());
    EXPECT_FALSE(explore(factory, 5U).is_kept());
}

INSTANTIATE_TEST_SUITE_P(
    All, StorageFlawTest,
    ::testing::Values(FlawCase{StorageFlaw::kLosesAWrite, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kForgetsAtClose, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kForgetsAtCrash, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kTearsAtCrash, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kBeginsDirty, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kTakesAnySize, "another size was opened"},
                      FlawCase{StorageFlaw::kTakesNoSize, "size 0 is a bad parameter"},
                      FlawCase{StorageFlaw::kRefusesWithoutCare, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kOpensTwice, "opened twice"},
                      FlawCase{StorageFlaw::kHasTwoUsers, "a second user"},
                      FlawCase{StorageFlaw::kGivesANarrowerRegion, "size of the region"},
                      FlawCase{StorageFlaw::kStaysReachable, "is still accessible"},
                      FlawCase{StorageFlaw::kRefusesWhatIsThere, "a valid region was rejected"},
                      FlawCase{StorageFlaw::kShowsARefusedRegion, "a rejected region is accessible"},
                      FlawCase{StorageFlaw::kChangesWhenOpenedAgain, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kChangesForAnotherUser, "does not contain the stored data"},
                      FlawCase{StorageFlaw::kChangesBetweenWrites, "does not contain the stored data"}));

TEST(StorageContractTest, ACompliantStorageIsAcceptedInEachOrder) {
    verifies("SWR-CNF-007", Technique::kStateTransition);
    EXPECT_TRUE(run_in_order(make(StorageFlaw::kNone)).is_kept());
    EXPECT_TRUE(run_randomly(make(StorageFlaw::kNone), 1U, 2000U).is_kept());

    const Report report = explore(make(StorageFlaw::kNone), 6U);
    EXPECT_EQ(report.to_text(), "12 rules, 23328 sequences, 139968 steps, 13 states\n");
}

TEST(StorageContractTest, EachRuleRequestsWhatItsNameStates) {
    verifies("SWR-CNF-007", Technique::kBoundaryValues);
    std::string calls;
    EXPECT_TRUE(run_in_order(make(StorageFlaw::kNone, &calls)).is_kept());
    EXPECT_EQ(calls,
              "open 328\n"
              "all 0\n"
              "1@1:1,2,3 2@2:1,2,6 - - - - spare\n"
              "1@1:1,2,3 2@2:1,2,6 - - - - spare 0=1 23=1\n"
              "open 328\n"
              "open as another 328\n"
              "close\n"
              "open 327\n"
              "open 329\n"
              "open 0\n"
              "crash 328\n"
              "1@1:1,2,3 2@2:1,2,6 3@3:1,2,9 4@4:1,2,12 - - spare 0=1 23=1\n"
              "crash 328\n"
              "torn 85 2@2:1,2,6 3@3:1,2,9 4@4:1,2,12 5@5:1,2,15 6@6:1,2,18 spare 0=1 23=1\n"
              "open 328\n"
              "all 165\n"
              "- - - - - - spare\n");
}

TEST(StorageContractTest, TheStateStatesWhetherTheRegionIsOpenAndThereAndHowManyRecordsItHas) {
    verifies("SWR-CNF-007", Technique::kStateTransition);
    EXPECT_EQ(list_states(make(StorageFlaw::kNone), {0U, 1U, 5U, 9U, 10U, 0U}),
              (std::vector<std::string>{"closed none 0", "open there 0", "open there 2", "closed there 2",
                                        "closed there 4", "closed there 5", "open there 5"}));
}

TEST(StorageContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-007", Technique::kInterface);
    expect_named_rules(make(StorageFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance
