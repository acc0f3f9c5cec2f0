// SPDX-License-Identifier: Apache-2.0
/// @file
/// Writes logs in the published format of lcm-logger by hand.
#ifndef MAMORI_PORTS_LCM_LOG_WRITER_HPP
#define MAMORI_PORTS_LCM_LOG_WRITER_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lcm_sample {

class LogWriter final {
  public:
    static constexpr std::int64_t kBeginUs = 1'700'000'000'000'000;  // UTC, as lcm-logger writes it

    /// @param[in] time_us since the begin of the log.
    void add_event(std::int64_t time_us, const std::string& channel, const std::vector<std::byte>& message) {
        add_number(0xEDA1DA01U, 4);
        add_number(event_count, 8);
        add_number(static_cast<std::uint64_t>(kBeginUs + time_us), 8);
        add_number(channel.size(), 4);
        add_number(message.size(), 4);
        log += channel;
        for (const std::byte octet : message) {
            log.push_back(std::to_integer<char>(octet));
        }
        ++event_count;
    }

    std::string log{};
    std::uint64_t event_count{0U};

  private:
    void add_number(std::uint64_t number, int octets) {
        for (int i = octets - 1; i >= 0; --i) {
            log.push_back(static_cast<char>(number >> (8 * i)));
        }
    }
};

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_LOG_WRITER_HPP
