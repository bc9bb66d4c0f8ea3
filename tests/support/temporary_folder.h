// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace soslam {

// An empty folder of the running test's own, removed with everything in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "soslam-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot create " + name);
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string FileBytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream) << path;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Expects that run(threads) writes the same bytes to these files for any number of threads.
template <typename Run>
void ExpectSameBytesForThreads(const Run& run, const std::vector<std::filesystem::path>& files) {
  run(1);
  std::vector<std::string> bytes;
  for (const std::filesystem::path& file : files) {
    bytes.push_back(FileBytes(file));
    EXPECT_FALSE(bytes.back().empty()) << file;
    std::filesystem::remove(file);
  }
  run(3);
  for (size_t i = 0; i < files.size(); ++i) EXPECT_EQ(FileBytes(files[i]), bytes[i]) << files[i];
}

// Writes a file; returns its path.
inline std::filesystem::path WriteBytes(const std::filesystem::path& path,
                                        const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

}  // namespace soslam
