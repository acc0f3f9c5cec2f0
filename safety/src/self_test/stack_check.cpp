// SPDX-License-Identifier: Apache-2.0
#include "mamori/safety/self_test/stack_check.hpp"

namespace mamori::safety {

namespace {

constexpr RamArea::Word kPaint =
    0xC5A3695CU;  ///< odd-looking, no address, no small number, no sign extension

}  // namespace

void StackCheck::paint(std::size_t unused_words) noexcept {
    MAMORI_REQUIRE(4, unused_words >= calc_margin() && unused_words <= stack_.size());
    for (std::size_t i = 0U; i < unused_words; ++i) {
        stack_.write(i, kPaint);
    }
}

bool StackCheck::is_painted(std::size_t from, std::size_t to) const noexcept {
    bool is_intact = true;
    for (std::size_t i = from; i < to; ++i) {
        is_intact = is_intact && stack_.read(i) == kPaint;
    }
    return is_intact;
}

SelfTestStatus StackCheck::step() noexcept {
    const std::size_t rest = calc_margin() - next_;
    const std::size_t end = next_ + (rest < limits_.words_per_step ? rest : limits_.words_per_step);
    if (!is_painted(0U, limits_.guard_words) || !is_painted(next_, end)) {
        return SelfTestStatus::kFailed;
    }
    next_ = end;
    return next_ == calc_margin() ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
}

std::size_t StackCheck::calc_used_words() const noexcept {
    std::size_t painted = 0U;
    bool is_untouched = true;
    for (std::size_t i = 0U; i < stack_.size(); ++i) {
        is_untouched = is_untouched && stack_.read(i) == kPaint;
        painted += is_untouched ? 1U : 0U;
    }
    return stack_.size() - painted;
}

}  // namespace mamori::safety
