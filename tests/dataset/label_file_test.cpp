// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/label_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class LabelFileTest : public testing::Test {
 protected:
  std::vector<std::string> Read(const std::string& text) {
    WriteBytes(folder_ / "labels.txt", text);
    return ReadLabelFile(folder_ / "labels.txt");
  }
  TemporaryFolder folder_;
};

TEST_F(LabelFileTest, OneNameALine) {
  EXPECT_THAT(Read("# mine\r\nmilk carton\r\n\r\n  cup \n"),
              testing::ElementsAre("milk carton", "cup"));
}

TEST_F(LabelFileTest, BadFilesAreNamed) {
  ExpectError<InputError>([&] { Read("cup\nbox, large\n"); }, {"labels.txt:2", "'box, large'"});
  ExpectError<InputError>([&] { Read("\n# none\n"); }, {"labels.txt", "no label"});
  ExpectError<InputError>([&] { ReadLabelFile(folder_ / "none.txt"); }, {"none.txt"});
}

}  // namespace
}  // namespace soslam
