// SPDX-License-Identifier: Apache-2.0
// Goal: the storage rules accept a storage that complies with its contract and report each violation. Method:
// storages in memory with one defect each.
#include "mamori/ports/conformance/storage_contract.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <vector>

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
};

class FlawedStorage final : public StorageRig {
  public:
    explicit FlawedStorage(StorageFlaw flaw) : flaw_(flaw) {}

    Status open(std::size_t size) override {
        if (size == 0U) {
            return has(StorageFlaw::kTakesNoSize) ? Status::kError : Status::kBadParameter;
        }
        if (is_open_ && !has(StorageFlaw::kOpensTwice)) {
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
        is_open_ = false;
        if (has(StorageFlaw::kLosesAWrite)) {
            bytes_.back() = std::byte{0U};
        } else if (has(StorageFlaw::kForgetsAtClose)) {
            std::fill(bytes_.begin(), bytes_.end(), std::byte{0U});
        }
    }
    Span<std::byte> get_region() override {
        if (!is_open_ && !has(StorageFlaw::kStaysReachable)) {
            return {};
        }
        return {bytes_.data(), bytes_.size() - (has(StorageFlaw::kGivesANarrowerRegion) ? 1U : 0U)};
    }
    Status open_as_another(std::size_t) override {
        return has(StorageFlaw::kHasTwoUsers) ? Status::kOk : Status::kError;
    }
    void crash(std::size_t size, const std::function<void(Span<std::byte>)>& write) override {
        make(size);
        const std::vector<std::byte> before = bytes_;
        write({bytes_.data(), bytes_.size()});
        if (has(StorageFlaw::kForgetsAtCrash)) {
            bytes_ = before;
        } else if (has(StorageFlaw::kTearsAtCrash)) {
            std::fill(bytes_.begin() + 64, bytes_.begin() + 104, std::byte{0U});
        }
    }

  private:
    bool has(StorageFlaw flaw) const { return flaw_ == flaw; }

    void make(std::size_t size) {
        bytes_.resize(size, has(StorageFlaw::kBeginsDirty) ? std::byte{1U} : std::byte{0U});
    }

    StorageFlaw flaw_;
    std::vector<std::byte> bytes_;
    bool is_open_{false};
};

TrialFactory make(StorageFlaw flaw) {
    return make_storage_trials([flaw] { return std::make_unique<FlawedStorage>(flaw); });
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
                      FlawCase{StorageFlaw::kRefusesWhatIsThere, "a valid region was rejected"}));

TEST(StorageContractTest, ACompliantStorageIsAcceptedInEachOrder) {
    verifies("SWR-CNF-007", Technique::kStateTransition);
    EXPECT_TRUE(run_in_order(make(StorageFlaw::kNone)).is_kept());
    EXPECT_TRUE(run_randomly(make(StorageFlaw::kNone), 1U, 2000U).is_kept());

    const Report report = explore(make(StorageFlaw::kNone), 6U);
    EXPECT_EQ(report.to_text(), "12 rules, 23328 sequences, 139968 steps, 13 states\n");
}

TEST(StorageContractTest, EachRuleHasANameOfItsOwnAndARequirement) {
    verifies("SWR-CNF-007", Technique::kInterface);
    expect_named_rules(make(StorageFlaw::kNone));
}

}  // namespace
}  // namespace mamori::ports::conformance
