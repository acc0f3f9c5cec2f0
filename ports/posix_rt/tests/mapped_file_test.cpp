// SPDX-License-Identifier: Apache-2.0
// Goal: a file is mapped completely or rejected with the cause, and a failed call leaves no new file. Method:
// real files in a folder of the test; as root, the permissions of another user.
#include "mamori/ports/posix_rt/mapped_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

namespace fs = std::filesystem;
using namespace verification;

constexpr std::size_t kSize = 5000U;  // not a multiple of the page size

class MappedFileTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::path{::testing::TempDir()} / ("mapped_file_" + name + std::to_string(::getpid()));
        fs::create_directories(folder_);
        path_ = (folder_ / "events.rec").string();
    }
    void TearDown() override {
        fs::permissions(folder_, fs::perms::owner_all);
        fs::remove_all(folder_);
    }
    void expect_refused(Status status, MappedFileError error) const {
        EXPECT_EQ(status == Status::kOk, false);
        EXPECT_EQ(sut_.get_error(), error) << describe(sut_.get_error());
        EXPECT_FALSE(sut_.is_open());
        EXPECT_TRUE(sut_.get_region().empty());
    }

    fs::path folder_;
    std::string path_;
    MappedFile sut_;
};

TEST_F(MappedFileTest, ANewFileIsOpenedOnceAlsoWithAStaleErrno) {
    verifies("SWR-REC-010", Technique::kErrorGuessing);
    const auto count_descriptors = [] {
        const fs::directory_iterator all{"/proc/self/fd"};
        return std::distance(begin(all), end(all));
    };
    const std::ptrdiff_t before = count_descriptors();
    errno = EEXIST;
    ASSERT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk);

    EXPECT_EQ(count_descriptors(), before + 1);
    sut_.close();
    EXPECT_EQ(count_descriptors(), before);
}

TEST_F(MappedFileTest, NewFileHasItsSizeAndIsZeroFilled) {
    verifies("SWR-REC-010");
    ASSERT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk);

    EXPECT_TRUE(sut_.is_open());
    EXPECT_EQ(sut_.get_error(), MappedFileError::kNone);
    EXPECT_EQ(sut_.get_system_error(), 0);
    EXPECT_EQ(fs::file_size(path_), kSize);
    ASSERT_EQ(sut_.get_region().size(), kSize);
    for (const std::byte byte : sut_.get_region()) {
        ASSERT_EQ(byte, std::byte{0U});
    }
}

TEST_F(MappedFileTest, StoredDataIsInTheFileAndIsReadAgain) {
    verifies("SWR-REC-010", Technique::kStateTransition);
    ASSERT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk);
    sut_.get_region()[0U] = std::byte{'a'};
    sut_.get_region()[kSize - 1U] = std::byte{'z'};
    EXPECT_EQ(sut_.flush(), Status::kOk);
    sut_.close();
    EXPECT_FALSE(sut_.is_open());

    std::ifstream file{path_, std::ios::binary};
    EXPECT_EQ(file.get(), 'a');
    ASSERT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk);
    EXPECT_EQ(sut_.get_region()[kSize - 1U], std::byte{'z'});
}

TEST_F(MappedFileTest, FileOfAnotherSizeIsRejectedAndUnchanged) {
    verifies("SWR-REC-010", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::size_t size : {kSize - 1U, kSize + 1U}) {
        std::ofstream{path_, std::ios::binary} << std::string(size, 'x');
        expect_refused(sut_.open(path_.c_str(), kSize), MappedFileError::kWrongSize);
        EXPECT_EQ(fs::file_size(path_), size);
    }
    std::ofstream{path_, std::ios::binary}.flush();
    EXPECT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk) << "an empty file is a new one";
}

TEST_F(MappedFileTest, IrregularFileIsRejected) {
    verifies("SWR-REC-010", Technique::kEquivalenceClasses, Polarity::kViolation);
    expect_refused(sut_.open(folder_.c_str(), kSize), MappedFileError::kNotRegular);
    expect_refused(sut_.open("/dev/null", kSize), MappedFileError::kNotRegular);
    ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    expect_refused(sut_.open(path_.c_str(), kSize), MappedFileError::kNotRegular);
}

TEST_F(MappedFileTest, MissingFolderIsTheCause) {
    verifies("SWR-REC-010", Technique::kErrorGuessing, Polarity::kViolation);
    expect_refused(sut_.open((folder_ / "gone" / "events.rec").c_str(), kSize), MappedFileError::kCannotOpen);
    EXPECT_EQ(sut_.get_system_error(), ENOENT);
}

TEST_F(MappedFileTest, ReadOnlyFolderIsTheCause) {
    verifies("SWR-REC-010", Technique::kErrorGuessing, Polarity::kViolation);
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_exec);
    constexpr uid_t kNobody = 65534U;  // root can write everywhere
    const bool is_root = ::geteuid() == 0U;
    ASSERT_TRUE(!is_root || ::seteuid(kNobody) == 0);

    const Status status = sut_.open(path_.c_str(), kSize);

    ASSERT_TRUE(!is_root || ::seteuid(0U) == 0);
    expect_refused(status, MappedFileError::kCannotOpen);
    EXPECT_EQ(sut_.get_system_error(), EACCES);
}

TEST_F(MappedFileTest, SecondUserIsRejectedUntilTheFirstHasClosedTheFile) {
    verifies("SWR-REC-010", Technique::kStateTransition, Polarity::kViolation);
    {
        MappedFile first;
        ASSERT_EQ(first.open(path_.c_str(), kSize), Status::kOk);
        EXPECT_EQ(first.open(path_.c_str(), kSize), Status::kPreconditionNotMet);
        expect_refused(sut_.open(path_.c_str(), kSize), MappedFileError::kInUse);
        EXPECT_TRUE(fs::exists(path_));
    }
    EXPECT_EQ(sut_.open(path_.c_str(), kSize), Status::kOk);
}

TEST_F(MappedFileTest, FileWithoutSpaceIsRemovedAgain) {
    verifies("SWR-REC-010", Technique::kFaultInjection, Polarity::kViolation);
    const Status status = sut_.open(path_.c_str(), std::size_t{1U} << 60U);

    EXPECT_EQ(status, Status::kOutOfResources);
    expect_refused(status, MappedFileError::kCannotReserve);
    EXPECT_NE(sut_.get_system_error(), 0);
    EXPECT_FALSE(fs::exists(path_));
}

TEST_F(MappedFileTest, ArgumentsOutOfRangeAreRejected) {
    verifies("SWR-REC-010", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(sut_.open(nullptr, kSize), Status::kBadParameter);
    EXPECT_EQ(sut_.open(path_.c_str(), 0U), Status::kBadParameter);
    EXPECT_EQ(sut_.open(path_.c_str(), ~std::size_t{0U}), Status::kBadParameter);
    EXPECT_EQ(sut_.flush(), Status::kPreconditionNotMet);
    sut_.close();
    EXPECT_FALSE(fs::exists(path_));
    EXPECT_EQ(sut_.open(path_.c_str(), 1U), Status::kOk);
}

TEST_F(MappedFileTest, AFileOfOneByteAndNoneAboveTheLimitOfLinuxIsOpened) {
    verifies("SWR-REC-010", Technique::kBoundaryValues);
    constexpr auto kLast = static_cast<std::size_t>(std::numeric_limits<off_t>::max());
    EXPECT_EQ(sut_.open(path_.c_str(), kLast + 1U), Status::kBadParameter);
    EXPECT_FALSE(fs::exists(path_));
    EXPECT_EQ(sut_.open(path_.c_str(), 1U), Status::kOk);
    EXPECT_EQ(sut_.get_system_error(), 0);
    EXPECT_EQ(sut_.get_region().size(), 1U);
    sut_.close();
    EXPECT_EQ(sut_.get_region().size(), 0U);
}

TEST_F(MappedFileTest, EachErrorHasAMessage) {
    verifies("SWR-REC-010");
    for (int error = 0; error <= static_cast<int>(MappedFileError::kCannotMap); ++error) {
        EXPECT_GT(std::string{describe(static_cast<MappedFileError>(error))}.size(), 5U);
    }
}

}  // namespace
}  // namespace mamori::ports::posix_rt
