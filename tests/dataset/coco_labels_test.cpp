// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "dataset/class_names.h"

namespace soslam {
namespace {

// Class indices as they are published with detections of OA-SLAM and EAO-SLAM.
TEST(CocoLabelsTest, DetectorIndices) {
  const std::vector<std::pair<size_t, const char*>> published = {
      {0, "person"},      {2, "car"},           {39, "bottle"}, {41, "cup"},
      {42, "fork"},       {43, "knife"},        {44, "spoon"},  {45, "bowl"},
      {56, "chair"},      {58, "potted plant"}, {62, "tv"},     {64, "mouse"},
      {66, "keyboard"},   {67, "cell phone"},   {73, "book"},   {75, "vase"},
      {77, "teddy bear"}, {79, "toothbrush"}};
  for (const auto& [index, label] : published) EXPECT_EQ(CocoLabels()[index], label);
}

// Category ids as COCO's annotation files have them.
TEST(CocoLabelsTest, CategoryIds) {
  const std::vector<std::pair<int, const char*>> published = {
      {1, "person"},        {11, "fire hydrant"}, {13, "stop sign"}, {27, "backpack"},
      {28, "umbrella"},     {31, "handbag"},      {44, "bottle"},    {46, "wine glass"},
      {62, "chair"},        {67, "dining table"}, {70, "toilet"},    {72, "tv"},
      {82, "refrigerator"}, {84, "book"},         {90, "toothbrush"}};
  for (const auto& [id, label] : published) {
    ASSERT_TRUE(CocoClassIndex(id)) << id;
    EXPECT_EQ(CocoLabels()[static_cast<size_t>(*CocoClassIndex(id))], label);
  }
}

TEST(CocoLabelsTest, EachClassHasOneCategoryId) {
  std::vector<int> indices;
  for (int id = -5; id < 200; ++id) {
    if (const auto index = CocoClassIndex(id)) indices.push_back(*index);
  }
  ASSERT_EQ(indices.size(), 80u);
  for (int i = 0; i < 80; ++i) {
    EXPECT_EQ(indices[static_cast<size_t>(i)], i);
    EXPECT_EQ(CocoClassIndex(CocoCategoryId(i)), i);
  }
}

}  // namespace
}  // namespace soslam
