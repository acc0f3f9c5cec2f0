// SPDX-License-Identifier: Apache-2.0
/// @file
/// March C- over memory: 10 accesses per word and data background. `RamMarch` takes a reserved area over
/// many steps; `TransparentMarch` takes live data block by block and leaves it as it was.
///
/// @satisfies SWR-SLF-005, SWR-SLF-006      Design: docs/design/self_tests.md#memory
/// Source:   March C- after A. J. van de Goor (1991); IEC 61508-7:2010 A.5 (RAM march)
#ifndef MAMORI_SAFETY_SELF_TEST_MARCH_HPP
#define MAMORI_SAFETY_SELF_TEST_MARCH_HPP

#include <array>
#include <cstddef>
#include <limits>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

namespace detail {

/// One element of a march: what is done at every word before the next element begins.
struct MarchElement {
    bool goes_up;
    bool does_read;
    bool expects_inverse;  ///< of the background
    bool does_write;
    bool writes_inverse;
};

/// {any(w0); up(r0,w1); up(r1,w0); down(r0,w1); down(r1,w0); any(r0)}
inline constexpr std::array<MarchElement, 6U> kMarchCMinus{{
    {true, false, false, true, false},
    {true, true, false, true, true},
    {true, true, true, true, false},
    {false, true, false, true, true},
    {false, true, true, true, false},
    {true, true, false, false, false},
}};

/// Number of data backgrounds: one plain one, and one for each power of two below the width, so that any two
/// bits of a word differ in at least one of them.
template <typename Word>
constexpr std::size_t calc_background_count() noexcept {
    std::size_t count = 1U;
    for (unsigned int power = 0U; power < 6U; ++power) {
        count += (1 << power) < std::numeric_limits<Word>::digits ? 1U : 0U;
    }
    return count;
}

/// @return 00, 55, 33, 0F, ... for the numbers 0, 1, 2, 3, ...
template <typename Word>
constexpr Word make_background(std::size_t number) noexcept {
    constexpr std::size_t kBits = std::numeric_limits<Word>::digits;
    Word result = 0U;
    for (std::size_t bit = 0U; bit < kBits; ++bit) {
        const bool is_set = number != 0U && ((bit >> (number - 1U)) & 1U) == 0U;
        result = static_cast<Word>(result | static_cast<Word>(static_cast<Word>(is_set ? 1U : 0U) << bit));
    }
    return result;
}

template <typename Word>
constexpr auto make_backgrounds() noexcept {
    std::array<Word, calc_background_count<Word>()> backgrounds{};
    for (std::size_t number = 0U; number < backgrounds.size(); ++number) {
        backgrounds[number] = make_background<Word>(number);
    }
    return backgrounds;
}

/// A march over one kind of memory.
template <typename Memory>
struct March {
    using Word = typename Memory::Word;
    static constexpr auto kBackgrounds = make_backgrounds<Word>();
    /// Words visited, per word: each element visits each word once, under each background.
    static constexpr std::size_t kVisitsPerWord = kBackgrounds.size() * kMarchCMinus.size();

    /// One element over the words `first` .. `first` + `count` - 1.
    /// @return false at the first word that does not hold what was written into it.
    static bool run_element(Memory& memory, std::size_t first, std::size_t count, MarchElement element,
                            Word background) noexcept {
        const auto inverse = static_cast<Word>(~background);
        const Word expected = element.expects_inverse ? inverse : background;
        const Word written = element.writes_inverse ? inverse : background;
        for (std::size_t place = 0U; place < count; ++place) {
            const std::size_t index = first + (element.goes_up ? place : count - 1U - place);
            if (element.does_read && memory.read(index) != expected) {
                return false;
            }
            if (element.does_write) {
                memory.write(index, written);
            }
        }
        return true;
    }

    /// Does the visits `from` .. `to` - 1 of the march over the words `first` .. `first` + `count` - 1.
    /// @return false at the first word that is faulty.
    static bool run(Memory& memory, std::size_t first, std::size_t count, std::size_t from,
                    std::size_t to) noexcept {
        for (std::size_t visit_number = from; visit_number < to; ++visit_number) {
            const std::size_t pass = visit_number / count;
            const std::size_t place = visit_number % count;
            const MarchElement& element = kMarchCMinus[pass % kMarchCMinus.size()];
            const Word background = kBackgrounds[pass / kMarchCMinus.size()];
            const std::size_t index = first + (element.goes_up ? place : count - 1U - place);
            if (!run_element(memory, index, 1U, element, background)) {
                return false;
            }
        }
        return true;
    }
};

}  // namespace detail

/// March C- over a reserved area, which holds the last background afterwards.
///
/// Thread safety: none; nobody else may use the area from begin() to the end of the pass.
/// Time:          a step visits at most `visits_per_step` words. Memory: no heap.
/// @tparam Memory has Word, size(), read(index) and write(index, word); RamArea for real memory.
template <typename Memory>
class RamMarch final : public SelfTest {
  public:
    /// @param[in] memory          must outlive this object.
    /// @param[in] visits_per_step words per step, >= 1.
    constexpr RamMarch(Memory& memory, std::size_t visits_per_step) noexcept
        : memory_(memory), visits_per_step_(visits_per_step) {
        MAMORI_REQUIRE(1, visits_per_step >= 1U);
    }

    void begin() noexcept override { next_ = 0U; }
    SelfTestStatus step() noexcept override {
        const std::size_t rest = calc_visits() - next_;
        const std::size_t end = next_ + (rest < visits_per_step_ ? rest : visits_per_step_);
        if (!detail::March<Memory>::run(memory_, 0U, memory_.size(), next_, end)) {
            return SelfTestStatus::kFailed;
        }
        next_ = end;
        return next_ == calc_visits() ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    std::size_t get_step_count() const noexcept override {
        return (calc_visits() + visits_per_step_ - 1U) / visits_per_step_;
    }

  private:
    std::size_t calc_visits() const noexcept {
        return memory_.size() * detail::March<Memory>::kVisitsPerWord;
    }

    Memory& memory_;
    std::size_t visits_per_step_;
    std::size_t next_{0U};
};

/// March C- over live data: a step takes one block away, tests its words under one background, and puts it
/// back. Blocks overlap by half, so any two words up to half a block apart are tested together.
///
/// Thread safety: the caller excludes every other access to the area, interrupts and other masters of the bus
///                included, during step(); between two steps the data may be used. A step that is aborted
///                leaves its block damaged.
/// Time:          a step does 13 accesses per word of the block. Memory: the block, no heap.
/// @tparam kBlockWords even, >= 2.
template <typename Memory, std::size_t kBlockWords>
class TransparentMarch final : public SelfTest {
    static_assert(kBlockWords >= 2U && kBlockWords % 2U == 0U, "blocks overlap by half");

  public:
    /// @param[in] memory at least one block; must outlive this object, which must not lie in it.
    explicit constexpr TransparentMarch(Memory& memory) noexcept : memory_(memory) {
        MAMORI_REQUIRE(1, memory.size() >= kBlockWords);
    }

    void begin() noexcept override { step_ = 0U; }
    SelfTestStatus step() noexcept override {
        const std::size_t last = memory_.size() - kBlockWords;
        const std::size_t wanted = step_ / kBackgroundCount * kStride;
        const std::size_t first = wanted < last ? wanted : last;
        for (std::size_t i = 0U; i < kBlockWords; ++i) {
            saved_[i] = memory_.read(first + i);
        }
        const typename Memory::Word background = Engine::kBackgrounds[step_ % kBackgroundCount];
        bool is_good = true;
        for (const detail::MarchElement& element : detail::kMarchCMinus) {
            is_good = is_good && Engine::run_element(memory_, first, kBlockWords, element, background);
        }
        // Put back in any case: what is still sound is needed for the stop.
        for (std::size_t i = 0U; i < kBlockWords; ++i) {
            memory_.write(first + i, saved_[i]);
        }
        for (std::size_t i = 0U; i < kBlockWords; ++i) {
            is_good = memory_.read(first + i) == saved_[i] && is_good;
        }
        ++step_;
        if (!is_good) {
            return SelfTestStatus::kFailed;
        }
        return step_ == get_step_count() ? SelfTestStatus::kPassed : SelfTestStatus::kRunning;
    }
    std::size_t get_step_count() const noexcept override {
        return ((memory_.size() - kBlockWords + kStride - 1U) / kStride + 1U) * kBackgroundCount;
    }

  private:
    using Engine = detail::March<Memory>;
    static constexpr std::size_t kStride = kBlockWords / 2U;
    static constexpr std::size_t kBackgroundCount = Engine::kBackgrounds.size();

    Memory& memory_;
    std::size_t step_{0U};
    std::array<typename Memory::Word, kBlockWords> saved_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_MARCH_HPP
