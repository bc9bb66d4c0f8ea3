// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/hdf5_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/random.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class Hdf5FileTest : public FolderTest {
 protected:
  // A file with whatever `fill` writes into it.
  template <typename Fill>
  std::filesystem::path Make(const std::string& name, Fill fill) {
    Hdf5File file = Hdf5File::Create(folder_ / name);
    fill(file);
    file.Close();
    return folder_ / name;
  }
};

cv::Mat RandomMatrix(int rows, int columns, int type) {
  cv::Mat matrix(rows, columns, type);
  cv::RNG random(TestRandom()());
  if (!matrix.empty()) random.fill(matrix, cv::RNG::UNIFORM, -100, 300, true);
  return matrix;
}

TEST_F(Hdf5FileTest, MatricesComeBackExactly) {
  for (const int type : {CV_8UC1, CV_16SC1, CV_16SC2, CV_32SC1, CV_32FC1, CV_32FC2, CV_64FC1}) {
    for (const cv::Size size : {cv::Size(7, 5), cv::Size(1, 1), cv::Size(2, 0)}) {
      const cv::Mat matrix = RandomMatrix(size.height, size.width, type);
      const auto path = Make("a.h5", [&](Hdf5File& file) { file.WriteMatrix("/a/b/c", matrix); });
      const Hdf5File file = Hdf5File::Open(path);
      const cv::Mat read = file.ReadMatrix("/a/b/c", type);
      ASSERT_EQ(read.type(), type);
      ASSERT_EQ(read.size(), size);
      const Hdf5File::Numbers numbers = file.ReadNumbers("/a/b/c");
      EXPECT_EQ(numbers.values.size(), matrix.total() * matrix.elemSize() / matrix.elemSize1());
      if (size.height == 0) continue;
      EXPECT_EQ(cv::norm(read, matrix, cv::NORM_INF), 0.0);
      cv::Mat expected;
      matrix.reshape(1, 1).convertTo(expected, CV_64F);
      EXPECT_EQ(cv::norm(expected, cv::Mat(numbers.values).t(), cv::NORM_INF), 0.0);
    }
  }
}

TEST_F(Hdf5FileTest, AttributesComeBackExactly) {
  const std::string long_text(300'000, 'x');  // older formats end at 64 KiB
  const auto path = Make("a.h5", [&](Hdf5File& file) {
    file.WriteGroup("/group");
    file.WriteText("/", "long", long_text);
    file.WriteText("/group", "name", "M\u00f6bel");
    file.WriteText("/group", "empty", "");
    file.WriteNumber("/group", "third", 1.0 / 3.0);
  });
  const Hdf5File file = Hdf5File::Open(path);
  EXPECT_EQ(file.ReadText("/", "long"), long_text);
  EXPECT_EQ(file.ReadText("/group", "name"), "M\u00f6bel");
  EXPECT_EQ(file.ReadText("/group", "empty"), "");
  EXPECT_EQ(file.ReadNumber("/group", "third"), 1.0 / 3.0);
  EXPECT_TRUE(file.HasAttribute("/", "long"));
  EXPECT_FALSE(file.HasAttribute("/", "name"));
  EXPECT_FALSE(file.HasAttribute("/nowhere", "name"));
}

TEST_F(Hdf5FileTest, SameCallsGiveTheSameBytes) {
  const cv::Mat matrix = RandomMatrix(30, 40, CV_32FC1);
  const auto fill = [&](Hdf5File& file) {
    file.WriteText("/", "artefact", std::string(100'000, 'h'));
    for (int i = 0; i < 50; ++i) {
      const std::string group = "/frames/" + std::to_string(i);
      file.WriteMatrix(group + "/m", matrix);
      file.WriteVector(group + "/v", std::vector<double>(static_cast<size_t>(i), 0.5));
      file.WriteNumber(group, "number", i);
    }
  };
  const std::string first = FileBytes(Make("a.h5", fill));
  const std::vector<std::string> garbage(100,
                                         std::string(10'000, '\x5a'));  // for unused heap bytes
  EXPECT_EQ(FileBytes(Make("b.h5", fill)), first);
}

TEST_F(Hdf5FileTest, WrongTypesAndShapesAreNamed) {
  const auto path = Make("a.h5", [](Hdf5File& file) {
    file.WriteMatrix("/m", cv::Mat::zeros(3, 4, CV_8UC1));
    file.WriteText("/", "text", "t");
    file.WriteNumber("/", "number", 1);
  });
  const Hdf5File file = Hdf5File::Open(path);
  ExpectError<InputError>([&] { file.ReadMatrix("/m", CV_8UC1, 3, 5); },
                          {"a.h5", "/m", "is 3 x 4 of uint8", "expected 3 x 5 of uint8"});
  ExpectError<InputError>([&] { file.ReadMatrix("/m", CV_32FC1); },
                          {"/m", "another type", "expected any x any of float32"});
  ExpectError<InputError>([&] { file.ReadMatrix("/m", CV_8UC2); }, {"/m", "any x any x 2"});
  ExpectError<InputError>([&] { file.ReadVector<double>("/m"); }, {"/m", "any of float64"});
  ExpectError<InputError>([&] { file.ReadVector<int>("/none"); }, {"/none", "missing"});
  ExpectError<InputError>([&] { file.ReadText("/", "number"); }, {"number", "text"});
  ExpectError<InputError>([&] { file.ReadNumber("/", "text"); }, {"text", "float64"});
  ExpectError<InputError>([&] { file.ReadText("/", "none"); }, {"none", "missing"});
  ExpectError<InputError>([&] { file.ReadNumber("/none", "none"); }, {"none", "missing"});
}

// A group in the place of a data set, and the other way round.
TEST_F(Hdf5FileTest, GroupsAndDataSetsAreToldApart) {
  const auto path =
      Make("a.h5", [](Hdf5File& file) { file.WriteVector("/g/v", std::vector<int>{1}); });
  const Hdf5File file = Hdf5File::Open(path);
  ExpectError<InputError>([&] { file.ReadVector<int>("/g"); }, {"a.h5", "/g"});
  ExpectError<InputError>([&] { file.Children("/g/v"); }, {"a.h5", "/g/v"});
}

TEST_F(Hdf5FileTest, BadFilesAreNamed) {
  const auto refused = [](const std::filesystem::path& file, std::vector<std::string> words) {
    words.push_back(file.string());
    ExpectError<InputError>([&] { Hdf5File::Open(file); }, words);
  };
  refused(folder_ / "none.h5", {"no such file"});
  refused(folder_.path(), {});
  refused(Write("empty.h5", ""), {"not an HDF5 file"});
  refused(Write("text.h5", "hello"), {"not an HDF5 file"});
  refused(Write("json.h5", "{}"), {"is JSON; expected an HDF5 file"});
  const std::string whole = FileBytes(
      Make("a.h5", [](Hdf5File& file) { file.WriteMatrix("/m", RandomMatrix(20, 20, CV_64FC1)); }));
  refused(Write("cut.h5", whole.substr(0, whole.size() - 1)), {"cut short"});
}

TEST_F(Hdf5FileTest, CannotBeWritten) {
  ExpectError<SettingsError>([&] { Hdf5File::Create(folder_ / "no/such/folder.h5"); },
                             {"folder.h5", "cannot be written"});
  ExpectError<SettingsError>(
      [&] {
        Hdf5File file = Hdf5File::Create(folder_ / "a.h5");
        file.WriteVector("/twice", std::vector<int>{1});
        file.WriteVector("/twice", std::vector<int>{2});
      },
      {"a.h5", "/twice", "cannot be written"});
}

// In a process of its own, which must also get to its end: the HDF5 library is left with a file
// that it cannot close.
TEST_F(Hdf5FileTest, FullDiskIsAnErrorAndNotACrash) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto write_beyond_limit = [&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20'000, 20'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      Make("a.h5", [](Hdf5File& file) {
        for (int i = 0; i < 10; ++i) {
          file.WriteMatrix("/m" + std::to_string(i), RandomMatrix(100, 100, CV_64FC1));
        }
      });
    } catch (const SettingsError& error) {
      std::exit(static_cast<int>(error.exit_code()));
    }
    std::exit(0);
  };
  EXPECT_EXIT(write_beyond_limit(), testing::ExitedWithCode(2), "");
}

}  // namespace
}  // namespace soslam
