// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <ctime>
#include <filesystem>
#include <vector>

#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(SOSLAM_SOURCE_DIR) / "tests" / "fuzz" / "corpus";

double PeakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // ru_maxrss is in KiB
}

std::vector<std::string> TargetNames() {
  std::vector<std::string> names;
  for (const auto& [name, read] : FuzzTarget::All()) names.push_back(name);
  return names;
}

class CorpusTest : public testing::TestWithParam<std::string> {};

// The kept inputs are small, so memory and time beyond these bounds do not come from their size.
TEST_P(CorpusTest, EveryInputIsReadOrRefused) {
  constexpr double kMaxMemoryMb = 1024.0;
  constexpr double kMaxSeconds = 5.0;
  const FuzzTarget::Read read = FuzzTarget::All().at(GetParam());
  int inputs = 0;
  for (const auto& entry : fs::directory_iterator(kCorpus / GetParam())) {
    const std::string bytes = FileBytes(entry.path());
    const std::clock_t start = std::clock();  // of this process: others may keep it waiting
    EXPECT_NO_THROW(read(HostileInput(bytes))) << entry.path();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LT(seconds, kMaxSeconds) << entry.path();
    EXPECT_LT(PeakMemoryMb(), kMaxMemoryMb) << entry.path();
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, CorpusTest, testing::ValuesIn(TargetNames()),
                         [](const auto& info) { return info.param; });

TEST(CorpusFolderTest, HasAFolderForEachTargetOnly) {
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    EXPECT_TRUE(FuzzTarget::All().contains(entry.path().filename().string())) << entry.path();
  }
}

}  // namespace
}  // namespace soslam
