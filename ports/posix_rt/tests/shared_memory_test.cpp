// SPDX-License-Identifier: Apache-2.0
// Goal: the reading side cannot write, the writing side cannot remove the memory, and invalid descriptors are
// rejected with the cause. Method: both sides in one process, as two mappings; the forbidden write in a
// separate process; process limits simulate an exhausted system.
#include "mamori/ports/posix_rt/shared_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <limits>
#include <string>

#include "mamori/trace/verifies.hpp"
#include "support/refused_call.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr std::size_t kSize = 5000U;  // not a multiple of the page size

/// Changes a limit of the process during its lifetime.
class LimitFor final {
  public:
    LimitFor(__rlimit_resource_t resource, rlim_t limit) : resource_(resource) {
        EXPECT_EQ(::getrlimit(resource_, &before_), 0);
        const rlimit lower{limit, before_.rlim_max};
        EXPECT_EQ(::setrlimit(resource_, &lower), 0);
    }
    LimitFor(const LimitFor&) = delete;
    LimitFor& operator=(const LimitFor&) = delete;
    ~LimitFor() { static_cast<void>(::setrlimit(resource_, &before_)); }

  private:
    __rlimit_resource_t resource_;
    rlimit before_{};
};

int duplicate(const SharedMemory& memory) {
    return ::fcntl(memory.get_descriptor(), F_DUPFD_CLOEXEC, 0);
}

std::byte* to_writable(const SharedMemory& memory) {
    return const_cast<std::byte*>(memory.get_region().data());
}

TEST(SharedMemoryTest, TheReaderSeesWhatTheOtherSideWrites) {
    verifies("SWR-PRT-012");
    SharedMemory reader;
    SharedMemory writer;
    ASSERT_EQ(reader.create("test", kSize, SharedAccess::kRead), Status::kOk);
    EXPECT_EQ(reader.get_region().size(), kSize);
    EXPECT_EQ(reader.get_writable_region().size(), 0U);
    EXPECT_EQ(reader.get_region().data()[kSize - 1U], std::byte{0U});

    ASSERT_EQ(writer.adopt(duplicate(reader), kSize, SharedAccess::kWrite), Status::kOk);
    EXPECT_EQ(writer.get_descriptor(), -1);
    writer.get_writable_region().data()[kSize - 1U] = std::byte{7U};

    EXPECT_EQ(reader.get_region().data()[kSize - 1U], std::byte{7U});
    writer.close();
    EXPECT_FALSE(writer.is_open());
    EXPECT_EQ(reader.get_region().data()[kSize - 1U], std::byte{7U});
}

TEST(SharedMemoryTest, TheAdoptingReaderSeesTheWritesOfTheTrustedSide) {
    verifies("SWR-PRT-012");
    SharedMemory writer;
    SharedMemory reader;
    ASSERT_EQ(writer.create("test", kSize, SharedAccess::kWrite), Status::kOk);
    ASSERT_EQ(reader.adopt(duplicate(writer), kSize, SharedAccess::kRead), Status::kOk);

    writer.get_writable_region().data()[0U] = std::byte{9U};

    EXPECT_EQ(reader.get_region().data()[0U], std::byte{9U});
    EXPECT_EQ(reader.get_writable_region().size(), 0U);
}

using SharedMemoryDeathTest = ::testing::Test;

TEST(SharedMemoryDeathTest, AWriteByTheReaderEndsInASegmentationFault) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    SharedMemory reader;
    ASSERT_EQ(reader.create("test", kSize, SharedAccess::kRead), Status::kOk);
    const auto attempt = [&reader] {
        static_cast<void>(std::signal(SIGSEGV, SIG_DFL));  // a sanitizer installs a handler
        *static_cast<volatile std::byte*>(to_writable(reader)) = std::byte{1U};
    };

    // Not a failed check: the processor rejects the write, and nothing is printed. The signal is the
    // evidence.
    EXPECT_EXIT(attempt(), ::testing::KilledBySignal(SIGSEGV), "^$");
}

TEST(SharedMemoryTest, NoMappingForReadingBecomesWritable) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    SharedMemory own;
    SharedMemory adopted;
    SharedMemory writer;
    ASSERT_EQ(own.create("test", kSize, SharedAccess::kRead), Status::kOk);
    ASSERT_EQ(writer.create("test", kSize, SharedAccess::kWrite), Status::kOk);
    ASSERT_EQ(adopted.adopt(duplicate(writer), kSize, SharedAccess::kRead), Status::kOk);

    EXPECT_EQ(::mprotect(to_writable(own), kSize, PROT_READ | PROT_WRITE), -1);
    EXPECT_EQ(::mprotect(to_writable(adopted), kSize, PROT_READ | PROT_WRITE), -1);
}

TEST(SharedMemoryTest, OnlyTheCreatorCanWriteItsMemory) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    SharedMemory writer;
    SharedMemory other;
    ASSERT_EQ(writer.create("test", kSize, SharedAccess::kWrite), Status::kOk);
    const int descriptor = duplicate(writer);
    const char byte = 1;

    EXPECT_EQ(other.adopt(descriptor, kSize, SharedAccess::kWrite), Status::kOutOfResources);
    EXPECT_EQ(other.get_error(), SharedMemoryError::kCannotMap);
    EXPECT_EQ(other.get_system_error(), EPERM);
    EXPECT_FALSE(other.is_open());
    EXPECT_EQ(::pwrite(descriptor, &byte, 1U, 0), -1);
    EXPECT_EQ(::close(descriptor), 0) << "a rejected descriptor stays open";
}

TEST(SharedMemoryTest, TheSizeCannotBeChanged) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    SharedMemory reader;
    SharedMemory writer;
    ASSERT_EQ(reader.create("test", kSize, SharedAccess::kRead), Status::kOk);
    ASSERT_EQ(writer.create("test", kSize, SharedAccess::kWrite), Status::kOk);

    for (const SharedMemory* memory : {&reader, &writer}) {
        EXPECT_EQ(::ftruncate(memory->get_descriptor(), 0), -1);
        EXPECT_EQ(::ftruncate(memory->get_descriptor(), 1 << 20), -1);
        EXPECT_EQ(::fcntl(memory->get_descriptor(), F_ADD_SEALS, F_SEAL_WRITE), -1);
    }
}

/// Checks that a descriptor is rejected with the expected error.
void expect_refused(int descriptor, std::size_t size, SharedMemoryError error) {
    SharedMemory sut;
    EXPECT_EQ(sut.adopt(descriptor, size, SharedAccess::kRead), Status::kError);
    EXPECT_EQ(sut.get_error(), error) << describe(sut.get_error());
    EXPECT_FALSE(sut.is_open());
}

TEST(SharedMemoryTest, UnsealedMemoryOrAWrongSizeIsRejected) {
    verifies("SWR-PRT-012", Technique::kEquivalenceClasses, Polarity::kViolation);
    SharedMemory memory;
    ASSERT_EQ(memory.create("test", kSize, SharedAccess::kRead), Status::kOk);
    const int unsealed = ::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    ASSERT_EQ(::ftruncate(unsealed, static_cast<off_t>(kSize)), 0);
    const int device = ::open("/dev/null", O_RDWR | O_CLOEXEC);

    expect_refused(memory.get_descriptor(), kSize - 1U, SharedMemoryError::kWrongSize);
    expect_refused(memory.get_descriptor(), kSize + 1U, SharedMemoryError::kWrongSize);
    expect_refused(unsealed, kSize, SharedMemoryError::kNotSealed);
    expect_refused(device, kSize, SharedMemoryError::kNoMemory);
    expect_refused(-1, kSize, SharedMemoryError::kNoMemory);
    static_cast<void>(::close(unsealed));
    static_cast<void>(::close(device));
}

TEST(SharedMemoryTest, ArgumentsOutOfRangeAndASecondOpeningChangeNothing) {
    verifies("SWR-PRT-012", Technique::kBoundaryValues, Polarity::kViolation);
    SharedMemory sut;

    EXPECT_EQ(sut.create(nullptr, kSize, SharedAccess::kRead), Status::kBadParameter);
    EXPECT_EQ(sut.create("test", 0U, SharedAccess::kRead), Status::kBadParameter);
    EXPECT_EQ(sut.create("test", ~std::size_t{0U}, SharedAccess::kRead), Status::kBadParameter);
    EXPECT_EQ(sut.adopt(0, 0U, SharedAccess::kRead), Status::kBadParameter);
    EXPECT_FALSE(sut.is_open());
    ASSERT_EQ(sut.create("test", 1U, SharedAccess::kWrite), Status::kOk);
    EXPECT_EQ(sut.create("test", kSize, SharedAccess::kRead), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.adopt(0, kSize, SharedAccess::kRead), Status::kPreconditionNotMet);
    EXPECT_EQ(sut.get_region().size(), 1U);
}

TEST(SharedMemoryTest, AMemoryOfOneByteAndNoneAboveTheLimitOfLinuxIsCreated) {
    verifies("SWR-PRT-012", Technique::kBoundaryValues);
    constexpr auto kLast = static_cast<std::size_t>(std::numeric_limits<off_t>::max());
    SharedMemory sut;
    EXPECT_EQ(sut.create("test", kLast + 1U, SharedAccess::kWrite), Status::kBadParameter);
    EXPECT_EQ(sut.adopt(-1, 1U, SharedAccess::kRead), Status::kError);
    EXPECT_EQ(sut.get_system_error(), EBADF);
    EXPECT_EQ(sut.create("test", 1U, SharedAccess::kWrite), Status::kOk) << "after a failure";
    EXPECT_EQ(sut.get_system_error(), 0);
    EXPECT_EQ(sut.get_error(), SharedMemoryError::kNone);
    SharedMemory other;
    EXPECT_EQ(other.adopt(::dup(sut.get_descriptor()), 1U, SharedAccess::kRead), Status::kOk);
    EXPECT_EQ(other.get_region().size(), 1U);
    EXPECT_EQ(other.get_writable_region().size(), 0U);
    other.close();
    EXPECT_EQ(other.get_region().size(), 0U);
    sut.close();
    EXPECT_EQ(sut.get_descriptor(), -1);
}

TEST(SharedMemoryTest, AnExhaustedSystemIsReported) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    SharedMemory sut;
    {
        const LimitFor files{RLIMIT_NOFILE, 0U};
        EXPECT_EQ(sut.create("test", kSize, SharedAccess::kRead), Status::kError);
        EXPECT_EQ(sut.get_error(), SharedMemoryError::kCannotCreate);
        EXPECT_EQ(sut.get_system_error(), EMFILE);
    }
    {
        static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
        const LimitFor size{RLIMIT_FSIZE, kSize - 1U};
        EXPECT_EQ(sut.create("test", kSize, SharedAccess::kWrite), Status::kOutOfResources);
        EXPECT_EQ(sut.get_error(), SharedMemoryError::kCannotReserve);
        static_cast<void>(std::signal(SIGXFSZ, SIG_DFL));
    }

    EXPECT_EQ(sut.create("test", kSize, SharedAccess::kRead), Status::kOk);
    EXPECT_EQ(sut.get_error(), SharedMemoryError::kNone);
    EXPECT_EQ(sut.get_system_error(), 0);
}

TEST(SharedMemoryTest, ARejectedSystemCallIsReportedAndLeavesNothingOpen) {
    verifies("SWR-PRT-012", Technique::kFaultInjection, Polarity::kViolation);
    struct Case {
        std::uint32_t call;
        SharedAccess access;
        SharedMemoryError error;
    };
    for (const Case example : {Case{SYS_fcntl, SharedAccess::kRead, SharedMemoryError::kCannotSeal},
                               Case{SYS_fcntl, SharedAccess::kWrite, SharedMemoryError::kCannotSeal},
                               Case{SYS_openat, SharedAccess::kRead, SharedMemoryError::kCannotReopen}}) {
        EXPECT_EQ(run_in_process([&example] {
                      const int next = ::dup(0);
                      static_cast<void>(::close(next));
                      ASSERT_TRUE(refuse_call(example.call, EPERM, false));
                      SharedMemory sut;
                      for (int i = 0; i < 2; ++i) {
                          EXPECT_EQ(sut.create("test", kSize, example.access), Status::kError);
                          EXPECT_EQ(sut.get_error(), example.error) << describe(sut.get_error());
                          EXPECT_EQ(sut.get_system_error(), EPERM);
                          EXPECT_FALSE(sut.is_open());
                          EXPECT_TRUE(sut.get_region().empty());
                          EXPECT_TRUE(sut.get_writable_region().empty());
                      }
                      EXPECT_EQ(::dup(0), next) << "a descriptor is still open";
                  }),
                  0);
    }
}

TEST(SharedMemoryTest, ACauseWithoutASystemErrorClearsThePreviousSystemError) {
    verifies("SWR-PRT-012", Technique::kErrorGuessing);
    SharedMemory created;
    ASSERT_EQ(created.create("test", kSize, SharedAccess::kWrite), Status::kOk);
    SharedMemory sut;
    EXPECT_EQ(sut.adopt(-1, kSize, SharedAccess::kRead), Status::kError);
    EXPECT_EQ(sut.get_system_error(), EBADF);

    EXPECT_EQ(sut.adopt(created.get_descriptor(), kSize + 1U, SharedAccess::kRead), Status::kError);
    EXPECT_EQ(sut.get_error(), SharedMemoryError::kWrongSize);
    EXPECT_EQ(sut.get_system_error(), 0);
}

TEST(SharedMemoryTest, EachCauseHasItsOwnMessage) {
    verifies("SWR-PRT-012", Technique::kEquivalenceClasses);
    const auto last = static_cast<int>(SharedMemoryError::kCannotMap);

    for (int i = 0; i <= last; ++i) {
        const std::string text = describe(static_cast<SharedMemoryError>(i));
        EXPECT_NE(text, "failed for an unknown reason");
        for (int j = 0; j < i; ++j) {
            EXPECT_NE(text, describe(static_cast<SharedMemoryError>(j)));
        }
    }
    EXPECT_STREQ(describe(static_cast<SharedMemoryError>(last + 1)), "failed for an unknown reason");
}

}  // namespace
}  // namespace mamori::ports::posix_rt
