// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/base/assert.hpp"

#include <atomic>

#if defined(__unix__)
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cstddef>

#include "mamori/kernel/base/text.hpp"
#endif

namespace mamori {
namespace {

std::atomic<AssertionHandler> g_handler{nullptr};
std::atomic<AssertionGate> g_gate{nullptr};
std::atomic<bool> g_has_handler{false};       ///< remains true after a failure has removed the handler
std::atomic<std::uint32_t> g_is_handled{0U};  ///< 1 once the handler has returned

/// Waits because a halt of this context also stops the context that sets `is_done`. The read-modify-write
/// makes each poll take about the same time on every processor. The compiler must not remove it.
void wait_until_set(std::atomic<std::uint32_t>& is_done) noexcept {
    for (std::uint32_t look = 0U; look < kFailureLooks; ++look) {
        if (is_done.fetch_or(0U, std::memory_order_acq_rel) != 0U) {
            return;
        }
    }
}

#if defined(__unix__)

/// Record that the handler received; in the stack frame of fail_assertion(), which never returns.
std::atomic<const AssertionRecord*> g_handled{nullptr};
std::atomic<bool> g_is_line_begun{false};
std::atomic<std::uint32_t> g_is_line_printed{0U};  ///< 1 once the line is printed

/// One line of text that contains every part, even when condition and path are long.
class FailureLine final {
  public:
    explicit FailureLine(const AssertionRecord& record) noexcept {
        append("mamori: failed check: '");
        append(record.condition == nullptr ? "" : record.condition);
        append("', ");
        append(skip_to_end(record.file));
        append(":");
        append_number(record.line);
        append(" (id ");
        append_number(record.id);
        append(")\n");
    }
    const char* get_text() const noexcept { return text_.data(); }
    std::size_t get_length() const noexcept { return length_; }

  private:
    static constexpr std::size_t kPartMax = 200U;    ///< maximum characters of a condition or a path
    static constexpr std::size_t kOtherParts = 80U;  ///< upper bound of the characters of all other parts

    /// Keeps the end of a long path, because the end identifies the file.
    static const char* skip_to_end(const char* path) noexcept {
        const std::size_t length = make_text(path).size();
        return length > kPartMax ? path + (length - kPartMax) : path;
    }
    void append(const char* text) noexcept {
        const std::size_t length = make_text(text).size();
        const std::size_t count = length < kPartMax ? length : kPartMax;
        for (std::size_t i = 0U; i < count; ++i) {
            text_[length_] = text[i];  // a checked access could fail within a failed check
            ++length_;
        }
    }
    void append_number(std::uint32_t number) noexcept {
        std::array<char, 11U> digits{};  // ten for the maximum number, and the NUL
        std::size_t first = digits.size() - 1U;
        for (std::size_t count = 0U; count < digits.size() - 1U; ++count) {
            --first;
            digits[first] = static_cast<char>('0' + number % 10U);
            number /= 10U;
            if (number == 0U) {
                break;
            }
        }
        append(&digits[first]);
    }

    std::array<char, 2U * kPartMax + kOtherParts> text_{};
    std::size_t length_{0U};
};

/// Uses only async-signal-safe calls. Prints nothing when standard error is full or closed: a blocked write
/// would keep a failed program alive, and SIGPIPE would end it without its crash handlers.
void write_line(const FailureLine& line) noexcept {
    int former = 0;
    // Without this call, cancellation of the thread in a system call below would end it without the halt.
    static_cast<void>(::pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &former));
    pollfd output{STDERR_FILENO, POLLOUT, 0};
    if (::poll(&output, 1U, 0) == 1 && output.revents == POLLOUT) {
        const ssize_t written = ::write(STDERR_FILENO, line.get_text(), line.get_length());
        static_cast<void>(written);  // no other output is available for a report
    }
}

/// Prints the line of the failure that the handler received; without one, the line of `record`. One context
/// prints; the others wait until the line is printed.
void print_once(const AssertionRecord& record) noexcept {
    if (g_is_line_begun.exchange(true, std::memory_order_acq_rel)) {
        wait_until_set(g_is_line_printed);
        return;
    }
    const AssertionRecord* const handled = g_handled.load(std::memory_order_acquire);
    write_line(FailureLine{handled == nullptr ? record : *handled});
    g_is_line_printed.store(1U, std::memory_order_release);
}

#endif

[[noreturn]] void fail(const AssertionRecord& record) noexcept {
    const AssertionGate gate = g_gate.load(std::memory_order_acquire);
    if (gate != nullptr) {
        gate(record);
    }
    // Removed before its call: a check that fails inside the handler does not call the handler again.
    const AssertionHandler handler = g_handler.exchange(nullptr, std::memory_order_acq_rel);
    if (handler != nullptr) {
#if defined(__unix__)
        g_handled.store(&record, std::memory_order_release);
#endif
        handler(record);
        g_is_handled.store(1U, std::memory_order_release);
    } else if (gate == nullptr && g_has_handler.load(std::memory_order_relaxed)) {
        wait_until_set(g_is_handled);
    }
#if defined(__unix__)
    print_once(record);
#endif
    // A halt that no debugger setting can disable. From here on, the watchdog is no longer serviced.
    __builtin_trap();
}

}  // namespace

void set_assertion_handler(AssertionHandler handler) noexcept {
    g_has_handler.store(handler != nullptr, std::memory_order_relaxed);
    g_handler.store(handler, std::memory_order_release);
}

void set_assertion_gate(AssertionGate gate) noexcept {
    g_gate.store(gate, std::memory_order_release);
}

namespace detail {

#if defined(__unix__)
void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line, const char* condition) noexcept {
    const AssertionRecord record{file, id, line, condition};
#else
void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept {
    const AssertionRecord record{file, id, line};
#endif
    fail(record);
}

}  // namespace detail
}  // namespace mamori
