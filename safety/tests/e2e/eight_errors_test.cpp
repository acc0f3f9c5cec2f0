// SPDX-License-Identifier: Apache-2.0
// Goal: of the eight errors of a transmission, the design note states in one row for all profiles what is
// seen and what is not claimed. Method: each error is made on a channel of each profile; the note must
// contain the resulting row, word by word.
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "mamori/safety/e2e/checker.hpp"
#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr std::size_t kLength = 24U;

/// A receiver that follows a sender; the next frame has number `next_`.
template <typename Case>
class Line final {
    using Profile = typename Case::Profile;

  public:
    Line() {
        for (int i = 0; i < 3; ++i) {
            last_ = send(make(next_++));
        }
    }
    rig::Frame make(std::uint64_t number) const {
        const auto counter = static_cast<std::uint32_t>(number % (std::uint64_t{Profile::kCounterMax} + 1U));
        return rig::protect<Profile>(Case::make(kLength), counter, kLength);
    }
    rig::Frame make_foreign() const {
        return rig::protect<Profile>(Case::make_other(kLength), static_cast<std::uint32_t>(next_), kLength);
    }
    CheckStatus send(const rig::Frame& frame) { return sut_.check(rig::view(frame)); }
    CheckStatus send_number(std::uint64_t number) { return send(make(number)); }
    CheckStatus wait() { return sut_.check_silence(); }
    std::uint64_t get_next() const { return next_; }
    CheckStatus get_last() const { return last_; }
    static std::uint64_t get_period() { return std::uint64_t{Profile::kCounterMax} + 1U; }

  private:
    E2eChecker<Profile> sut_{Case::make(kLength), {}};
    std::uint64_t next_{0U};
    CheckStatus last_{CheckStatus::kError};
};

std::string judge(CheckStatus status) {
    return status == CheckStatus::kOk ? "not claimed" : "seen";
}

template <typename Case>
std::string make_row() {
    std::vector<std::string> cells{"each"};
    const auto add = [&cells](const std::function<std::string(Line<Case>&)>& fault) {
        Line<Case> line;
        EXPECT_EQ(line.get_last(), CheckStatus::kOk);
        cells.push_back(fault(line));
    };
    add([](Line<Case>& line) {  // corruption
        rig::Frame frame = line.make(line.get_next());
        frame[20] ^= std::byte{0x10U};
        return judge(line.send(frame));
    });
    add([](Line<Case>& line) {
        return judge(line.send_number(line.get_next() - 1U));
    });  // unintended repetition
    add([](Line<Case>& line) {
        return judge(line.send_number(line.get_next() - 2U));
    });  // incorrect sequence
    add([](Line<Case>& line) { return judge(line.send_number(line.get_next() + 5U)); });  // loss
    add([](Line<Case>& line) {  // loss of a whole period
        return judge(line.send_number(line.get_next() + Line<Case>::get_period()));
    });
    add([](Line<Case>& line) {  // unacceptable delay: while it lasts, and when the frame comes at last
        const bool is_seen = line.wait() == CheckStatus::kNoNewData;
        return is_seen && line.send_number(line.get_next()) == CheckStatus::kOk ? "as silence only" : "seen";
    });
    add([](Line<Case>& line) { return judge(line.send(line.make_foreign())); });  // insertion, addressing
    add([](Line<Case>& line) {
        return judge(line.send(rig::Frame(kLength, std::byte{0x3CU})));
    });                                                                              // masquerade by chance
    add([](Line<Case>& line) { return judge(line.send_number(line.get_next())); });  // masquerade on purpose
    std::string row = "|";
    for (const std::string& cell : cells) {
        row += " ";
        row += cell;
        row += " |";
    }
    return row;
}

TEST(E2eEightErrorsTest, TableOfTheDesignNoteIsWhatHappens) {
    verifies("SWR-E2E-004", Technique::kFaultInjection, Polarity::kViolation);
    std::ifstream file{MAMORI_SOURCE_FOLDER "/docs/design/e2e.md"};
    std::stringstream note;
    note << file.rdbuf();
    const auto expect_row = [&note](const char* profile, const std::string& row) {
        EXPECT_NE(note.str().find(row + "\n"), std::string::npos)
            << "profile " << profile << ": docs/design/e2e.md lacks the row\n"
            << row;
    };

    expect_row("1, both", make_row<rig::P01Both>());
    expect_row("1, alternating", make_row<rig::P01Alternating>());
    expect_row("1, low", make_row<rig::P01Low>());
    expect_row("1, nibble", make_row<rig::P01Nibble>());
    expect_row("2", make_row<rig::P02>());
    expect_row("4", make_row<rig::P04>());
    expect_row("5", make_row<rig::P05>());
    expect_row("6", make_row<rig::P06>());
    expect_row("7", make_row<rig::P07>());
    expect_row("8", make_row<rig::P08>());
    expect_row("11, both", make_row<rig::P11Both>());
    expect_row("11, nibble", make_row<rig::P11Nibble>());
    expect_row("22", make_row<rig::P22>());
    expect_row("44", make_row<rig::P44>());
}

}  // namespace
}  // namespace mamori::safety
