// SPDX-License-Identifier: Apache-2.0
// A temporary file for the output of a program, and what was written to it.
#ifndef MAMORI_PORTS_LCM_TEXT_FILE_HPP
#define MAMORI_PORTS_LCM_TEXT_FILE_HPP

#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

namespace lcm_sample {

class TextFile final {
  public:
    TextFile() = default;
    TextFile(const TextFile&) = delete;
    TextFile& operator=(const TextFile&) = delete;
    ~TextFile() {
        if (file_ != nullptr) {
            static_cast<void>(std::fclose(file_));
        }
    }
    bool is_open() const { return file_ != nullptr; }
    int get_file() const { return ::fileno(file_); }
    /// The first 64 KiB.
    std::string read() const {
        std::array<char, 65536U> text{};
        const ssize_t size = ::pread(get_file(), text.data(), text.size(), 0);
        return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0U};
    }

  private:
    std::FILE* file_{std::tmpfile()};
};

/// Number of occurrences of `part` in `text`.
inline int count_parts(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1U)) {
        ++found;
    }
    return found;
}

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_TEXT_FILE_HPP
