// SPDX-License-Identifier: Apache-2.0
// Fills payloads with random values that have an encoding: any bits in numbers, declared values in
// enumerations and booleans, any length in sequences and strings.
#ifndef MAMORI_PORTS_LCM_RANDOM_VALUE_HPP
#define MAMORI_PORTS_LCM_RANDOM_VALUE_HPP

#include <cstddef>
#include <cstdint>
#include <random>
#include <type_traits>

#include "mamori/kernel/payload/cdr_scalar.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace lcm_sample {

class RandomFiller final {
  public:
    explicit RandomFiller(std::mt19937_64& random) noexcept : random_(random) {}

    template <typename T>
    bool run(T* first, std::size_t count) {
        for (std::size_t i = 0U; i < count; ++i) {
            if constexpr (std::is_same_v<T, bool>) {
                first[i] = random_() % 2U == 1U;
            } else if constexpr (std::is_enum_v<T>) {
                first[i] = static_cast<T>(random_() % mamori::Enumerators<T>::kCount);
            } else {
                first[i] = mamori::detail::from_bits<T>(static_cast<mamori::detail::WireBits<T>>(random_()));
            }
        }
        return true;
    }
    template <typename Sequence>
    bool open(Sequence& sequence, std::size_t& count) {
        count = random_() % (Sequence::capacity() + 1U);
        return sequence.resize(count) == mamori::Status::kOk;
    }
    template <typename String>
    bool text(String& string) {
        string.clear();
        const std::size_t length = random_() % (String::capacity() + 1U);
        bool is_ok = true;
        for (std::size_t i = 0U; i < length; ++i) {
            is_ok =
                is_ok && string.push_back(static_cast<char>(1U + random_() % 255U)) == mamori::Status::kOk;
        }
        return is_ok;
    }

  private:
    std::mt19937_64& random_;
};

template <typename T>
T make_random(std::mt19937_64& random) {
    T value{};
    RandomFiller filler(random);
    static_cast<void>(mamori::detail::walk(value, filler));
    return value;
}

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_RANDOM_VALUE_HPP
