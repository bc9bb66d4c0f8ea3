// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "dataset/labelled_box.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

constexpr const char* kDataset = R"({
    "images": [{"id": 7, "file_name": "rgb/a.png"}, {"id": 3, "file_name": "rgb/b.png"}],
    "categories": [{"id": 1, "name": "milk carton"}, {"id": 2, "name": "cup"}]})";

class CocoResultsTest : public testing::Test {
 protected:
  std::vector<LabelledBox> Read(const std::string& results) {
    WriteBytes(folder_ / "results.json", results);
    return ReadCocoResults(folder_ / "results.json");
  }
  std::vector<LabelledBox> ReadWith(const std::string& dataset, const std::string& results) {
    WriteBytes(folder_ / "results.json", results);
    WriteBytes(folder_ / "dataset.json", dataset);
    return ReadCocoResults(folder_ / "results.json", folder_ / "dataset.json");
  }
  TemporaryFolder folder_;
};

TEST_F(CocoResultsTest, DatasetSaysWhatIdsMean) {
  const auto boxes = ReadWith(
      kDataset, R"([{"image_id": 3, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 0.5}])");
  ASSERT_EQ(boxes.size(), 1u);
  ExpectLabelledBox(boxes[0], "rgb/b.png", "milk carton", 0.5, {0.5, 1.5, 3.5, 5.5});
}

TEST_F(CocoResultsTest, WithoutScoreItIsOne) {
  EXPECT_EQ(Read(R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4]}])").at(0).score, 1.0);
}

TEST_F(CocoResultsTest, ADataSetHoldsItsBoxesItself) {
  nlohmann::json dataset = nlohmann::json::parse(kDataset);
  dataset["annotations"] = nlohmann::json::parse(R"([
      {"id": 0, "image_id": 3, "category_id": 1, "bbox": [1, 2, 3, 4], "iscrowd": 0},
      {"id": 1, "image_id": 3, "category_id": 1, "bbox": [0, 0, 9, 9], "iscrowd": 1},
      {"id": 2, "image_id": 7, "category_id": 2, "bbox": [1, 2, 3, 4], "track_id": 5},
      {"id": 3, "image_id": 7, "category_id": 2, "bbox": [1, 2, 3, 4],
       "attributes": {"track_id": 6}}])");
  const auto boxes = Read(dataset.dump());
  ASSERT_EQ(boxes.size(), 3u);
  ExpectLabelledBox(boxes[0], "rgb/b.png", "milk carton", 1.0, {0.5, 1.5, 3.5, 5.5});
  EXPECT_EQ(boxes[0].place, (folder_ / "results.json").string() + "#/annotations/0");
  EXPECT_FALSE(boxes[0].object_id);
  EXPECT_EQ(boxes[1].object_id, 5);
  EXPECT_EQ(boxes[2].object_id, 6);
}

TEST_F(CocoResultsTest, NamesOfImagesAreTakenAlsoWithADataset) {
  const auto boxes =
      ReadWith(kDataset, R"([{"image_id": "a.png", "category_id": 2, "bbox": [1, 2, 3, 4]}])");
  ExpectLabelledBox(boxes.at(0), "a.png", "cup", 1.0, {0.5, 1.5, 3.5, 5.5});
}

TEST_F(CocoResultsTest, BadResultsAreNamed) {
  const BadTexts cases = {
      {R"({"image_id": 0})", {"results.json", "not a list", "annotations"}},
      {R"([3])", {"results.json#/0", "not an object"}},
      {R"([{"category_id": 1, "bbox": [1, 2, 3, 4], "score": 1}])", {"#/0", "image_id is missing"}},
      {R"([{"image_id": 0.5, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 1}])",
       {"#/0", "image_id is 0.5"}},
      {R"([{"image_id": 0, "category_id": 12, "bbox": [1, 2, 3, 4], "score": 1}])",
       {"#/0", "category_id is 12", "1 to 90"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3], "score": 1}])",
       {"#/0", "bbox is [1,2,3]", "4 numbers"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, -3, 4], "score": 1}])",
       {"#/0", "[x, y, width, height]"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "score": "1"}])",
       {"score is \"1\""}}};
  ExpectBadTexts(cases, "results.json", [&](const std::string& text) { Read(text); });
}

TEST_F(CocoResultsTest, BadDatasetsAreNamed) {
  const std::string result =
      R"([{"image_id": 7, "category_id": 2, "bbox": [1, 2, 3, 4], "score": 1}])";
  const BadTexts cases = {
      {R"({"images": []})", {"dataset.json", "categories is missing"}},
      {R"({"images": {}, "categories": []})", {"dataset.json", "images is {}", "a list"}},
      {R"({"images": [{"id": 7}], "categories": []})",
       {"dataset.json#/images/0", "file_name is missing"}},
      {R"({"images": [], "categories": [{"id": 2, "name": "cup"}]})",
       {"results.json#/0", "image_id is 7"}},
      {R"({"images": [{"id": 7, "file_name": "a"}], "categories": [{"id": 1, "name": "cup"}]})",
       {"results.json#/0", "category_id is 2"}},
      {R"({"images": [], "categories": [{"id": 1, "name": "cup"}, {"id": 1, "name": "box"}]})",
       {"dataset.json#/categories/1", "id is 1"}}};
  ExpectBadTexts(cases, ".json", [&](const std::string& text) { ReadWith(text, result); });
}

TEST_F(CocoResultsTest, LongValuesAreCutInMessages) {
  const std::string dataset = R"({"images": {"a": ")" + std::string(5000, 'x') + R"("}})";
  try {
    ReadWith(dataset, "[]");
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_LT(std::string(error.what()).size(), 500u);
  }
}

}  // namespace
}  // namespace soslam
