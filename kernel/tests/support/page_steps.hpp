// SPDX-License-Identifier: Apache-2.0
/// @file
/// Stops a program before its next access to a page, so that a test can do there what an interrupt or another
/// core would do, at exactly that place and each time the same. The code under test is the real one.
#ifndef MAMORI_KERNEL_TESTS_SUPPORT_PAGE_STEPS_HPP
#define MAMORI_KERNEL_TESTS_SUPPORT_PAGE_STEPS_HPP

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>
#include <utility>

namespace mamori::testing_support {

/// Memory of its own for one object, from the beginning of a page on.
template <typename T>
class PagedObject {
  public:
    template <typename... Arguments>
    explicit PagedObject(Arguments&&... arguments)
        : bytes_(static_cast<std::byte*>(
              mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))),
          object_(new(bytes_) T(std::forward<Arguments>(arguments)...)) {}
    ~PagedObject() {
        object_->~T();
        munmap(bytes_, kSize);
    }
    PagedObject(const PagedObject&) = delete;
    PagedObject& operator=(const PagedObject&) = delete;

    T& operator*() { return *object_; }
    T* operator->() { return object_; }
    /// Pages `first` .. `first + count - 1` of the object.
    void protect(std::size_t first, std::size_t count, int protection) {
        ASSERT_LE((first + count) * kPage, kSize);
        ASSERT_EQ(mprotect(bytes_ + first * kPage, count * kPage, protection), 0);
    }
    bool has(const void* address, std::size_t first, std::size_t count) const {
        const auto offset =
            reinterpret_cast<std::uintptr_t>(address) - reinterpret_cast<std::uintptr_t>(bytes_);
        return offset >= first * kPage && offset < (first + count) * kPage;
    }
    static constexpr std::size_t kPage = 4096U;
    static constexpr std::size_t kPages = (sizeof(T) + kPage - 1U) / kPage;

  private:
    static constexpr std::size_t kSize = kPages * kPage;
    std::byte* bytes_;
    T* object_;
};

/// While it lives, an access that the page does not allow calls `on_fault(address)` and is then tried again.
class FaultHandler {
  public:
    explicit FaultHandler(std::function<void(const void*)> on_fault) {
        get_current() = std::move(on_fault);
        struct sigaction action{};
        action.sa_sigaction = [](int, siginfo_t* info, void*) { get_current()(info->si_addr); };
        action.sa_flags = SA_SIGINFO | SA_NODEFER;
        sigemptyset(&action.sa_mask);
        EXPECT_EQ(sigaction(SIGSEGV, &action, &before_), 0);
    }
    ~FaultHandler() { sigaction(SIGSEGV, &before_, nullptr); }
    FaultHandler(const FaultHandler&) = delete;
    FaultHandler& operator=(const FaultHandler&) = delete;

  private:
    static std::function<void(const void*)>& get_current() {
        static std::function<void(const void*)> current;
        return current;
    }
    struct sigaction before_{};
};

/// Runs `work` and counts its turns between two objects; `interrupt` is told each turn's number before it.
/// @return number of turns, at most 1000.
template <typename A, typename B>
std::size_t run_in_turns(PagedObject<A>& a, PagedObject<B>& b, const std::function<void()>& work,
                         const std::function<void(std::size_t)>& interrupt) {
    constexpr int kFree = PROT_READ | PROT_WRITE;
    std::size_t turn = 0U;
    const FaultHandler handler{[&](const void* address) {
        a.protect(0U, PagedObject<A>::kPages, kFree);
        b.protect(0U, PagedObject<B>::kPages, kFree);
        interrupt(turn);
        ++turn;
        if (turn == 1000U) {
            return;
        }
        if (a.has(address, 0U, PagedObject<A>::kPages)) {
            b.protect(0U, PagedObject<B>::kPages, PROT_NONE);
        } else {
            a.protect(0U, PagedObject<A>::kPages, PROT_NONE);
        }
    }};
    a.protect(0U, PagedObject<A>::kPages, PROT_NONE);
    work();
    a.protect(0U, PagedObject<A>::kPages, kFree);
    b.protect(0U, PagedObject<B>::kPages, kFree);
    return turn;
}

/// The same with one interrupt, before turn number `at`.
template <typename A, typename B>
std::size_t run_interrupted(PagedObject<A>& a, PagedObject<B>& b, std::size_t at,
                            const std::function<void()>& work, const std::function<void()>& interrupt) {
    return run_in_turns(a, b, work, [at, &interrupt](std::size_t turn) {
        if (turn == at) {
            interrupt();
        }
    });
}

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_SUPPORT_PAGE_STEPS_HPP
