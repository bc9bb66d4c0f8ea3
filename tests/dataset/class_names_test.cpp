// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/class_names.h"

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

TEST_F(LabelFileTest, BadFilesAreNamed) {
  ExpectError<InputError>([&] { Read("cup\nbox, large\n"); }, {"labels.txt:2", "'box, large'"});
  ExpectError<InputError>([&] { Read("\n# none\n"); }, {"labels.txt", "no label"});
  ExpectError<InputError>([&] { ReadLabelFile(folder_ / "none.txt"); }, {"none.txt"});
}

TEST_F(LabelFileTest, NamesOfYolosYaml) {
  for (const char* text :
       {"path: x\nnames: [milk carton, 'cup']\n", "names:\n  - milk carton\n  - cup\nnc: 2\n",
        "names:\n  0: milk carton\n  1: cup\n", "names: {1: cup, 0: milk carton}\n"}) {
    EXPECT_THAT(ParseLabels(text, "data.yaml"), testing::ElementsAre("milk carton", "cup")) << text;
  }
  ExpectError<InputError>([&] { ParseLabels("names: {0: cup, 2: box}\n", "data.yaml"); },
                          {"data.yaml", "none for class 1"});
  ExpectError<InputError>([&] { ParseLabels("nc: 2\n", "data.yaml"); }, {"data.yaml", "no label"});
  ExpectError<InputError>([&] { ParseLabels("names: ['a, b']\n", "data.yaml"); }, {"'a, b'"});
}

TEST_F(LabelFileTest, SearchEndsAtTheRoot) { EXPECT_FALSE(FindLabelFile("/proc/self", "/")); }

TEST_F(LabelFileTest, LatinLettersOfOneByteAreRefused) {
  ExpectError<InputError>([&] { ParseLabels("nc: 1\nnames: [t\xFCr]\n", "data.yaml"); },
                          {"data.yaml:2", "not UTF-8"});
  EXPECT_THAT(ParseLabels("# t\xFCr\nnames: [door]\n", "data.yaml"), testing::ElementsAre("door"));
}

TEST_F(LabelFileTest, IsFoundAmongOrAroundLabels) {
  const auto dataset = folder_ / "dataset";
  const auto labels = dataset / "labels" / "train";
  std::filesystem::create_directories(labels);
  WriteBytes(folder_ / "classes.txt", "of another\n");
  EXPECT_FALSE(FindLabelFile(labels, dataset));
  WriteBytes(dataset / "data.yaml", "names: [cup]\n");
  EXPECT_EQ(FindLabelFile(labels, dataset), dataset / "data.yaml");
  EXPECT_EQ(FindLabelFile(dataset / "labels.zip", dataset), dataset / "data.yaml");
  WriteBytes(labels / "obj.names", "cup\n");
  WriteBytes(labels / "classes.txt", "cup\n");
  EXPECT_EQ(FindLabelFile(labels, dataset), labels / "classes.txt");
  std::filesystem::create_directories(folder_ / "elsewhere" / "labels");
  EXPECT_FALSE(FindLabelFile(folder_ / "elsewhere" / "labels", dataset));
  WriteBytes(folder_ / "elsewhere" / "classes.txt", "cup\n");
  EXPECT_EQ(FindLabelFile(folder_ / "elsewhere" / "labels", dataset),
            folder_ / "elsewhere" / "classes.txt");
}

// Indices as detectors give them, and category ids as COCO's annotation files have them.
TEST(CocoLabelsTest, IndicesAndCategoryIds) {
  const std::vector<std::tuple<int, int, const char*>> published = {
      {0, 1, "person"},         {10, 11, "fire hydrant"}, {11, 13, "stop sign"},
      {24, 27, "backpack"},     {25, 28, "umbrella"},     {26, 31, "handbag"},
      {39, 44, "bottle"},       {40, 46, "wine glass"},   {56, 62, "chair"},
      {60, 67, "dining table"}, {61, 70, "toilet"},       {62, 72, "tv"},
      {72, 82, "refrigerator"}, {73, 84, "book"},         {79, 90, "toothbrush"}};
  for (const auto& [index, id, label] : published) {
    EXPECT_EQ(CocoClassIndex(id), index);
    EXPECT_EQ(CocoLabels()[index], label);
  }
}

TEST(CocoLabelsTest, EachClassHasOneCategoryId) {
  std::vector<int> indices;
  for (int id = -5; id < 200; ++id) {
    if (const auto index = CocoClassIndex(id)) indices.push_back(*index);
  }
  ASSERT_EQ(indices.size(), 80u);
  for (int i = 0; i < 80; ++i) {
    EXPECT_EQ(indices[i], i);
    EXPECT_EQ(CocoClassIndex(CocoCategoryId(i)), i);
  }
}

}  // namespace
}  // namespace soslam
