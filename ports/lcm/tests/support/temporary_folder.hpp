// SPDX-License-Identifier: Apache-2.0
// A folder of one test, also if tests with the same process id run in other namespaces.
#ifndef MAMORI_PORTS_LCM_TEMPORARY_FOLDER_HPP
#define MAMORI_PORTS_LCM_TEMPORARY_FOLDER_HPP

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace lcm_sample {

class TemporaryFolder final {
  public:
    TemporaryFolder() { EXPECT_NE(::mkdtemp(path_.data()), nullptr); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    std::string get_path(const std::string& file) const { return path_ + "/" + file; }

  private:
    std::string path_{::testing::TempDir() + "mamori_lcm_XXXXXX"};
};

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_TEMPORARY_FOLDER_HPP
