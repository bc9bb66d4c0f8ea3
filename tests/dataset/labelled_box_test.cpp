// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/labelled_box.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/dataset/class_names.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

class DetectionsCsvTest : public FolderTest {
 protected:
  std::vector<LabelledBox> Read(const std::string& text) const {
    return ReadDetectionsCsv(Write("detections.csv", text));
  }
};

TEST_F(DetectionsCsvTest, WithAndWithoutObjectIds) {
  for (const char* text : {"frame,label,score,x1,y1,x2,y2\n3,cup,0.5,1,2,3.25,4\n",
                           "# a comment\nscore,frame,object_id,label,x1,y1,x2,y2\n"
                           "0.5,3,7,cup,1,2,3.25,4\n"}) {
    ExpectLabelledBox(Only(Read(text)), 3, "cup", 0.5, {1, 2, 3.25, 4});
  }
}

TEST_F(DetectionsCsvTest, AsSpreadsheetsAndOtherProgramsWriteIt) {
  for (const char* text :
       {"\"frame\",\"label\",\"score\",\"x1\",\"y1\",\"x2\",\"y2\"\n3,\"milk "
        "carton\",0.5,1,2,3.25,4\n",
        "frame;label;score;x1;y1;x2;y2\n3;milk carton;0.5;1;2;3.25;4\n",
        "Frame \tLABEL\tScore\tX1\ty1\tx2\ty2\n3\tmilk carton\t0.5\t1\t2\t3.25\t4\n",
        "frame,label,score,x1,y1,x2,y2\r3,milk carton,0.5,1,2,3.25,4\r"}) {
    SCOPED_TRACE(text);
    ExpectLabelledBox(Only(Read(text)), 3, "milk carton", 0.5, {1, 2, 3.25, 4});
  }
  const auto boxes = Read("frame,Object ID,label,score,x1,y1,x2,y2\n3,7.0,cup,0.5,1,2,3,4\n");
  EXPECT_EQ(boxes.at(0).object_id, 7);
}

TEST_F(DetectionsCsvTest, WithoutScoreItIsOne) {
  ExpectLabelledBox(Only(Read("frame,label,x1,y1,x2,y2\n3,cup,1,2,3.25,4\n")), 3, "cup", 1.0,
                    {1, 2, 3.25, 4});
}

TEST_F(DetectionsCsvTest, WrittenBoxesComeBackRounded) {
  const std::string text = LabelledBoxesText(
      {{"", 0, "milk carton", 0.123456, {-0.5, 10.126, 20, 30}}, {"", 12, "cup", 1, {1, 2, 3, 4}}});
  EXPECT_EQ(text,
            "frame,label,score,x1,y1,x2,y2\n"
            "0,milk carton,0.1235,-0.50,10.13,20.00,30.00\n"
            "12,cup,1.0000,1.00,2.00,3.00,4.00\n");
  const auto boxes = Read(text);
  ASSERT_EQ(boxes.size(), 2u);
  ExpectLabelledBox(boxes[0], 0, "milk carton", 0.1235, {-0.5, 10.13, 20, 30});
}

TEST_F(DetectionsCsvTest, LabelsWithCommasAndQuotesComeBack) {
  for (const char* label : {"box, large", "12\" screen", "\"cup\""}) {
    EXPECT_EQ(Only(Read(LabelledBoxesText({{"", 0, label, 1, {1, 2, 3, 4}}}))).label, label);
  }
}

TEST_F(DetectionsCsvTest, FirstAndLastFieldBetweenTabsMayBeEmpty) {
  const LabelledBox box =
      Only(Read("object_id\tframe\tlabel\tscore\tx1\ty1\tx2\ty2\tnote\n"
                "\t3\tcup\t0.5\t1\t2\t3\t4\t\r\n\t\t\n"));
  EXPECT_FALSE(box.object_id);
  EXPECT_EQ(box.label, "cup");
}

TEST_F(DetectionsCsvTest, OnlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  ExpectError<InputError>([&] { ReadDetectionsCsv(folder_ / "pipe"); }, {"pipe", "cannot be read"});
  const auto large = Write("detections.csv", "");
  std::filesystem::resize_file(large, (1u << 30) + 1);  // of no blocks
  ExpectError<InputError>([&] { ReadDetectionsCsv(large); },
                          {"detections.csv", "1073741825 bytes", "at most 1073741824"});
}

TEST_F(DetectionsCsvTest, BadFilesAreNamed) {
  const std::string header = "frame,label,score,x1,y1,x2,y2\n";
  const BadTexts cases = {
      {header + "a.png,cup,0.5,1,2,3,4\n", {"detections.csv:2", "frame is 'a.png'"}},
      {"frame;label;score;x1;y1;x2;y2\n0;cup;0,5;1;2;3;4\n",
       {"detections.csv:2", "score is '0,5'", "a decimal point"}},
      {header + "0,\"cup,0.5,1,2,3,4\n", {"detections.csv:2", "not closed"}},
      {header + "0,\"cup\"s,0.5,1,2,3,4\n", {"detections.csv:2", "'s' after a quoted field"}},
      {"frame,label,x1,y1,x2,y2,angle\n0,cup,1,2,3,4,0\n0,cup,1,2,3,4,30\n",
       {"detections.csv:3", "angle is 30", "oriented boxes are not read"}},
      {"frame,label,confidence,x1,y1,x2,y2\n0,cup,1,2,3,4,5\n",
       {"detections.csv:1: ", "'confidence' would be ignored", "score"}},
      {"frame,track_id,label,x1,y1,x2,y2\n0,1,cup,2,3,4,5\n",
       {"detections.csv:1: ", "'track_id' would be ignored", "object_id"}},
      {"filename,class,confidence,xmin,ymin,xmax,ymax\na.png,cup,1,1,2,3,4\n",
       {"detections.csv:1", "frame,label,x1,y1,x2,y2 missing",
        "filename for frame (the row of its image in the image list, from 0), class for label",
        "xmin for x1", "ymax for y2"}},
      {"Image,label,x1,y1,x2,y2\na.png,cup,1,2,3,4\n",
       {"detections.csv:1: frame missing", "it may have image for frame (the row of its image"}},
      {"frame,x1,y1,right,bottom,label\n0,1,2,3,4,cup\n",
       {": x2,y2 missing", "; it may have right for x2, bottom for y2"}},
      {"frame,id,bb_left,bb_top,bb_width,bb_height,conf\n1,1,2,3,4,5,1\n",
       {"label,x1,y1,x2,y2 missing", "MOTChallenge", "docs/detections.md"}},
      {"[{\"image_id\": 0, \"bbox\": [1, 2, 3, 4]}]",
       {"is JSON", "a table in CSV, with columns frame,label", "detections_format"}},
      {"<annotation>\n<object/>\n</annotation>\n", {"is XML", "a table in CSV"}},
      {"0,1,cup,0.9,1,2,3,4\n",
       {"detections.csv:1", "no header, but '0,1,cup,0.9,1,2,3,4'; expected"}},
      {"1,3,794.27,247.59,71.245,174.88,-1,-1,-1,-1\n",
       {"detections.csv:1", "no header", "MOTChallenge", "frame from 1", "docs/detections.md"}},
      {"1 3 794 247 71 174 -1 -1 -1 -1\n", {"detections.csv:1", "no header", "MOTChallenge"}}};
  ExpectBadTexts(cases, "detections.csv", [&](const std::string& text) { Read(text); });
}

constexpr const char* kDataset = R"({
    "images": [{"id": 7, "file_name": "rgb/a.png"}, {"id": 3, "file_name": "rgb/b.png"}],
    "categories": [{"id": 1, "name": "milk carton"}, {"id": 2, "name": "cup"}]})";

class CocoResultsTest : public FolderTest {
 protected:
  std::vector<LabelledBox> Read(const std::string& results) {
    return ReadCocoResults(Write("results.json", results)).boxes;
  }
  std::vector<LabelledBox> ReadWith(const std::string& dataset, const std::string& results) {
    return ReadCocoResults(Write("results.json", results), Write("dataset.json", dataset)).boxes;
  }
};

TEST_F(CocoResultsTest, DatasetSaysWhatIdsMean) {
  const auto boxes = ReadWith(
      kDataset, R"([{"image_id": 3, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 0.5}])");
  ExpectLabelledBox(Only(boxes), "rgb/b.png", "milk carton", 0.5, {0.5, 1.5, 3.5, 5.5});
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

bool IsOblique(const LabelledBox& box) { return box.as_drawn && box.as_drawn->IsOblique(); }

// Attributes of CVAT: a box of 40 x 20 pixels, whose centre is 30, 20, by quarter turns, by one of
// 30 degrees, and by one that nobody sees.
TEST_F(CocoResultsTest, TurnedBoxesBecomeUpright) {
  const auto turned = [&](double angle_deg) {
    return ReadCocoResults(Write(
        "results.json", fmt::format(R"([{{"image_id": 0, "category_id": 1, "bbox": [10, 10, 40, 20],
                          "attributes": {{"rotation": {}, "occluded": true}}}}])",
                                    angle_deg)));
  };
  for (const double half_turn_deg : {0.0, 180.0, 360.0}) {
    ExpectBox(Only(turned(half_turn_deg).boxes).box, {9.5, 9.5, 49.5, 29.5});
    const FolderBoxes quarter = turned(half_turn_deg + 90.0);
    ExpectBox(Only(quarter.boxes).box, {19.5, -0.5, 39.5, 39.5});
    EXPECT_FALSE(IsOblique(quarter.boxes[0]));
  }
  for (const double angle_deg : {30.0, 150.0, 330.0}) {
    const FolderBoxes oblique = turned(angle_deg);
    const double half_width = 20.0 * std::sqrt(0.75) + 5.0;
    const double half_height = 10.0 + 10.0 * std::sqrt(0.75);
    ExpectBox(Only(oblique.boxes).box,
              {29.5 - half_width, 19.5 - half_height, 29.5 + half_width, 19.5 + half_height});
    EXPECT_TRUE(IsOblique(oblique.boxes[0]));
  }
  EXPECT_FALSE(IsOblique(turned(0.2).boxes.at(0)));
}

TEST_F(CocoResultsTest, NumbersMayBeTextOrNull) {
  const FolderBoxes read = ReadCocoResults(Write("results.json", R"([
      {"image_id": 0, "category_id": 1, "bbox": [10, 10, 40, 20], "score": null, "angle": null,
       "rotation": "0.0", "bbox_mode": null, "track_id": null, "iscrowd": null,
       "attributes": {"rotation": "90", "track_id": "7", "outside": "false"}},
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "attributes": {"track_id": ""}},
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "attributes": {"track_id": null}},
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "attributes": {"outside": "True"}}])"));
  ASSERT_EQ(read.boxes.size(), 3u);
  ExpectLabelledBox(read.boxes[0], 0, "person", 1.0, {19.5, -0.5, 39.5, 39.5});
  EXPECT_EQ(read.boxes[0].object_id, 7);
  EXPECT_FALSE(read.boxes[1].object_id);
  EXPECT_FALSE(read.boxes[2].object_id);
  EXPECT_THAT(read.left_out, ElementsAre(Pair("out_of_view", 1)));
}

TEST_F(CocoResultsTest, WordsAsAttributesAreNoAngles) {
  for (const char* value : {R"("front")", R"("")", R"("30 degrees")", "true", "null", "[30]"}) {
    SCOPED_TRACE(value);
    const FolderBoxes read = ReadCocoResults(Write(
        "results.json", fmt::format(R"([{{"image_id": 0, "category_id": 1, "bbox": [10, 10, 40, 20],
                          "attributes": {{"rotation": {}}}}}])",
                                    value)));
    ExpectBox(Only(read.boxes).box, {9.5, 9.5, 49.5, 29.5});
    EXPECT_FALSE(IsOblique(read.boxes[0]));
  }
}

TEST_F(CocoResultsTest, WhatIsNoSingleObjectInTheImageIsLeftOut) {
  const FolderBoxes read = ReadCocoResults(Write("results.json", R"([
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "iscrowd": 1},
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "ignore": 1},
      {"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "attributes": {"outside": true}},
      {"image_id": 5, "category_id": 1, "bbox": [1, 2, 3, 4], "iscrowd": 0, "ignore": 0,
       "attributes": {"outside": false}}])"));
  EXPECT_EQ(Only(read.boxes).frame, FrameKey(5));
  EXPECT_THAT(read.left_out, ElementsAre(Pair("crowd", 2), Pair("out_of_view", 1)));
}

TEST_F(CocoResultsTest, TwoFilesMayNotContradictEachOther) {
  const auto with_categories = [](const std::string& name) {
    return R"({"images": [], "annotations": [], "categories": [{"id": 1, "name": ")" + name +
           R"("}]})";
  };
  EXPECT_THAT(ReadWith(kDataset, with_categories("Milk_Carton")), IsEmpty());
  ExpectError<InputError>(
      [&] { ReadWith(kDataset, with_categories("cup")); },
      {"dataset.json", "category 1 is 'milk carton'", "'cup' in", "results.json"});
}

// Images are those of the boxes' own file. Folders, endings and what tools add to the names of
// copies make no other image.
TEST_F(CocoResultsTest, ImagesOfTwoFilesThatContradictEachOtherAreAFinding) {
  const auto read = [&](const std::string& own_name, const std::string& other_name) {
    return ReadCocoResults(
        Write("results.json",
              R"({"annotations": [{"image_id": 3, "category_id": 1, "bbox": [1, 2, 3, 4]}],
                  "images": [{"id": 3, "file_name": ")" +
                  own_name + R"("}]})"),
        Write("dataset.json", R"({"images": [{"id": 3, "file_name": ")" + other_name +
                                  R"("}, {"id": 4, "file_name": "d.png"}],
                                  "categories": [{"id": 1, "name": "cup"}]})"));
  };
  for (const char* same :
       {"rgb/b.png", "b.png", "b", "images/b.png", "b_png.rf.0123456789ab.jpg"}) {
    EXPECT_THAT(read("rgb/b.png", same).findings, IsEmpty()) << same;
    EXPECT_THAT(read(same, "rgb/b.png").findings, IsEmpty()) << same;
  }
  const FolderBoxes boxes = read("rgb/b.png", "rgb/c.png");
  EXPECT_EQ(Only(boxes.boxes).frame, FrameKey("rgb/b.png"));
  EXPECT_THAT(
      Only(boxes.findings).found,
      testing::AllOf(testing::HasSubstr("results.json: image 3 is 'rgb/b.png', but 'rgb/c.png' in"),
                     testing::HasSubstr("dataset.json")));
}

// A data set may leave its images, its categories or both to the file that is given beside it.
TEST_F(CocoResultsTest, ADataSetHoldsWhatTheOtherFileDoesNot) {
  const std::string annotations =
      R"("annotations": [{"image_id": 3, "category_id": 1, "bbox": [1, 2, 3, 4]}])";
  const std::string categories = R"("categories": [{"id": 1, "name": "milk carton"}])";
  const std::string images = R"("images": [{"id": 3, "file_name": "rgb/b.png"}])";
  const std::pair<std::string, std::string> files[] = {
      {"{" + annotations + "}", kDataset},
      {"{" + annotations + "," + categories + "}", kDataset},
      {"{" + annotations + "," + categories + "}", "{" + images + "}"},
      {"{" + annotations + "," + images + "}", "{" + categories + "}"},
      // Entries without a name, and those of other images, say nothing of this image.
      {"{" + annotations + R"(, "images": [{"id": 3}, {"id": 1, "file_name": ""}]})", kDataset},
      {"{" + annotations + R"(, "images": [{"id": 9, "file_name": "z.png"}]})", kDataset}};
  for (const auto& [boxes, dataset] : files) {
    SCOPED_TRACE(boxes + dataset);
    const LabelledBox box = Only(ReadWith(dataset, boxes));
    EXPECT_EQ(box.frame, FrameKey("rgb/b.png"));
    EXPECT_EQ(box.label, "milk carton");
  }
  const std::string by_name =
      R"({"annotations": [{"image_id": "b.png", "category_id": 1, "bbox": [1, 2, 3, 4]}],)" +
      categories + "}";
  EXPECT_EQ(Only(Read(by_name)).frame, FrameKey("b.png"));
}

TEST_F(CocoResultsTest, NamesOfImagesAreTakenAlsoWithADataset) {
  const auto boxes =
      ReadWith(kDataset, R"([{"image_id": "a.png", "category_id": 2, "bbox": [1, 2, 3, 4]}])");
  ExpectLabelledBox(boxes.at(0), "a.png", "cup", 1.0, {0.5, 1.5, 3.5, 5.5});
}

TEST_F(CocoResultsTest, BadResultsAreNamed) {
  const BadTexts cases = {
      {R"({"image_id": 0})", {"results.json", "not a list", "annotations"}},
      {R"([{"image_id": 0.5, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 1}])",
       {"#/0", "image_id is 0.5"}},
      {R"([{"image_id": 0, "category_id": 12, "bbox": [1, 2, 3, 4], "score": 1}])",
       {"#/0", "category_id is 12", "1 to 90"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, -3, 4], "score": 1}])",
       {"#/0", "[x, y, width, height]"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "score": "1"}])",
       {"score is \"1\""}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "confidence": 0.5}])",
       {"#/0", "confidence is 0.5", "the score as score"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4, 30]}])",
       {"#/0", "bbox is [1,2,3,4,30]", "[x, y, width, height]", "oriented boxes are not read"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "bbox_mode": 0}])",
       {"#/0", "bbox_mode is 0", "XYWH_ABS"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "rotation": 30}])",
       {"#/0", "rotation is 30", "oriented boxes are not read"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "rotation": "30"}])",
       {"#/0", "rotation is \"30\"", "oriented boxes are not read"}},
      {R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4],
            "attributes": {"track_id": "cup 1"}}])",
       {"#/0/attributes", "track_id is 'cup 1'", "an integer"}},
      {"<?xml version=\"1.0\"?>\n<annotations/>\n", {"is XML; expected JSON"}},
      {"0 0.5 0.5 0.1 0.1\n", {"begins with neither { nor [; expected JSON"}}};
  ExpectBadTexts(cases, "results.json", [&](const std::string& text) { Read(text); });
}

TEST_F(CocoResultsTest, BadDatasetsAreNamed) {
  const std::string result =
      R"([{"image_id": 7, "category_id": 2, "bbox": [1, 2, 3, 4], "score": 1}])";
  const BadTexts cases = {
      {R"({"images": []})", {"dataset.json", "categories is missing"}},
      {R"({"categories": [{"id": 2, "name": "cup"}]})",
       {"results.json#/0", "image_id is 7", "\"images\"", "has none"}},
      {"cup\nbook\n", {"dataset.json", "expected JSON", "class_names", "\"categories\""}},
      {R"({"images": [], "categories": [{"id": 2, "name": "cup"}]})",
       {"results.json#/0", "image_id is 7"}},
      {R"({"images": [{"id": 7, "file_name": "a"}], "categories": [{"id": 1, "name": "cup"}]})",
       {"results.json#/0", "category_id is 2"}},
      {R"({"images": [], "categories": [{"id": 1, "name": "cup"}, {"id": 1, "name": "box"}]})",
       {"dataset.json#/categories/1", "id is 1"}}};
  ExpectBadTexts(cases, ".json", [&](const std::string& text) { ReadWith(text, result); });
}

TEST(OaSlamBoxesTest, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto detection = [](const std::string& category, const std::string& box) {
    return R"([{"file_name": "a.png", "detections": []}, {"file_name": "b.png", "detections": [
               {"detection_score": 1, "category_id": )" +
           category + R"(, "bbox": )" + box + "}]}]";
  };
  const std::string where = "boxes.json#/1/detections/0";
  const BadTexts cases = {
      {"{}", {"boxes.json", "not a list"}},
      {detection("80", "[1, 2, 3, 4]"), {where, "category_id is 80", "0 to 79"}},
      {detection("-1", "[1, 2, 3, 4]"), {where, "category_id is -1"}},
      {detection("1", "[300, 68, 59, 97]"), {where, "x1 <= x2"}},
      {detection("1", "[1, 2, 3, 4, 30]"), {where, "oriented boxes are not read"}}};
  ExpectBadTexts(cases, "boxes.json", [&](const std::string& text) {
    ReadOaSlamBoxes(WriteBytes(folder / "boxes.json", text), CocoLabels());
  });
}

class LabelFileTest : public FolderTest {
 protected:
  std::vector<std::string> Read(const std::string& text) {
    return ReadLabelFile(Write("labels.txt", text));
  }
};

TEST_F(LabelFileTest, BadFilesAreNamed) {
  ExpectError<InputError>([&] { Read("cup\nbox, large\n"); }, {"labels.txt:2", "'box, large'"});
  ExpectError<InputError>([&] { Read("\n# none\n"); }, {"labels.txt", "no label"});
  ExpectError<InputError>([&] { ReadLabelFile(folder_ / "none.txt"); }, {"none.txt"});
  ExpectError<InputError>([&] { Read("[\"cup\"]\n"); }, {"labels.txt: is JSON", "one a line"});
  ExpectError<InputError>([&] { Read("<?xml version=\"1.0\"?>\n<a/>\n"); }, {"is XML"});
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

TEST_F(LabelFileTest, SearchEndsAtTheRoot) {
  EXPECT_THAT(FindLabelFiles("/proc/self", "/"), testing::IsEmpty());
}

TEST_F(LabelFileTest, TheNearestListCounts) {
  const ClassNames near{"a/b/classes.txt", {"coffee table", "cup"}};
  const ClassNames beside{"a/b/data.yaml", {"coffee table", "book"}};
  const ClassNames far{"a/data.yaml", {"cup", "coffee table"}};
  const ClassNames broken{"a/b/obj.names", {}, "obj.names: broken"};
  std::vector<Finding> findings;
  const auto nearest = [&](const std::vector<ClassNames>& lists) {
    findings.clear();
    return NearestNames(lists, &findings);
  };
  EXPECT_FALSE(nearest({}));
  EXPECT_FALSE(nearest({{"data.yaml", {}}}));
  EXPECT_EQ(nearest({{"a/data.yaml", {"Coffee_Table", "cup", "book"}}, near})->place, near.place);
  EXPECT_THAT(findings, IsEmpty());
  EXPECT_EQ(nearest({broken, near})->names, near.names);
  EXPECT_EQ(Only(findings).found, "obj.names: broken");
  EXPECT_EQ(nearest({near, {"data.yaml", {}, "broken"}})->names, near.names);
  EXPECT_EQ(findings.size(), 1u);
  ExpectError<InputError>(
      [&] {
        nearest({near, beside});
      },
      {"class 1 is 'cup'", "'book' in a/b/data.yaml", "class_names"});
  ExpectError<InputError>(
      [&] {
        nearest({far, near});
      },
      {"a/b/classes.txt: class 0 is 'coffee table'", "'cup' in a/data.yaml", "class_names"});
  ExpectError<InputError>([&] { nearest({far, broken}); }, {"obj.names: broken"});
}

TEST_F(LabelFileTest, LabelImgsTemplateYieldsToOtherNames) {
  ClassNames labelimg{"a/labels/classes.txt",
                      {"dog", "person", "cat", "tv", "car", "meatballs", "marinara sauce",
                       "tomato sauce", "chicken noodle soup", "french onion soup", "chicken breast",
                       "ribs", "pulled pork", "hamburger", "cavity"}};
  const ClassNames right{"a/data.yaml", {"cup", "book"}};
  std::vector<Finding> findings;
  EXPECT_EQ(NearestNames({labelimg}, &findings)->names, labelimg.names);
  EXPECT_EQ(NearestNames({labelimg, {"a/data.yaml", {"dog"}}}, &findings)->names, labelimg.names);
  EXPECT_THAT(findings, IsEmpty());
  EXPECT_EQ(NearestNames({labelimg, right}, &findings)->names, right.names);
  EXPECT_EQ(Only(findings).found,
            "a/labels/classes.txt: class 0 is 'dog', but 'cup' in a/data.yaml");
  // labelImg appends the classes that it is used for.
  labelimg.names.push_back("cup");
  ExpectError<InputError>(
      [&] {
        NearestNames({labelimg, right}, &findings);
      },
      {"class 0 is 'dog'"});
}

TEST_F(LabelFileTest, LatinLettersOfOneByteAreRefused) {
  ExpectError<InputError>([&] { ParseLabels("nc: 1\nnames: [t\xFCr]\n", "data.yaml"); },
                          {"data.yaml:2", "not UTF-8"});
  EXPECT_THAT(ParseLabels("# t\xFCr\nnames: [door]\n", "data.yaml"), testing::ElementsAre("door"));
}

TEST_F(LabelFileTest, IsFoundAmongOrAroundLabels) {
  const auto dataset = folder_ / "dataset";
  const auto labels = dataset / "labels" / "train";
  Write("dataset/labels/train/1.txt", "");
  Write("classes.txt", "of another\n");
  EXPECT_THAT(FindLabelFiles(labels, dataset), IsEmpty());
  Write("dataset/data.yaml", "names: [cup]\n");
  EXPECT_THAT(FindLabelFiles(labels, dataset), ElementsAre(dataset / "data.yaml"));
  EXPECT_THAT(FindLabelFiles(dataset / "labels.zip", dataset), ElementsAre(dataset / "data.yaml"));
  Write("dataset/labels/train/obj.names", "cup\n");
  Write("dataset/labels/train/classes.txt", "cup\n");
  EXPECT_THAT(FindLabelFiles(labels, dataset),
              ElementsAre(labels / "classes.txt", labels / "obj.names", dataset / "data.yaml"));
  const auto elsewhere = Write("elsewhere/labels/1.txt", "").parent_path();
  EXPECT_THAT(FindLabelFiles(elsewhere, dataset), IsEmpty());
  const auto classes = Write("elsewhere/classes.txt", "cup\n");
  EXPECT_THAT(FindLabelFiles(elsewhere, dataset), ElementsAre(classes));
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

// Lists of large vocabularies: a class at its number, and enough names that the semantic table
// knows.
TEST(ProjectLabelsTest, ListsHaveAllClassesInTheirOrder) {
  struct List {
    const char* file;
    size_t classes;
    size_t number;
    const char* name;
    int known;
  };
  const std::filesystem::path pipelines = SOSLAM_SOURCE_DIR "/pipelines";
  const SemanticTable table = ReadSemanticTable(pipelines / "priors/semantic_table.json");
  for (const List& list : {List{"coco_ids.txt", 91, 62, "chair", 55},
                           List{"objects365.txt", 365, 121, "nightstand", 130},
                           List{"objects365_ids.txt", 366, 122, "nightstand", 130},
                           List{"open_images.txt", 601, 576, "trash can", 170},
                           List{"lvis.txt", 1203, 19, "wardrobe", 250}}) {
    const auto names = ReadLabelFile(pipelines / "labels" / list.file);
    EXPECT_EQ(names.size(), list.classes) << list.file;
    EXPECT_EQ(names.at(list.number), list.name) << list.file;
    EXPECT_GE(std::ranges::count_if(names, [&](const auto& name) { return table.Contains(name); }),
              list.known)
        << list.file;
  }
}

}  // namespace
}  // namespace soslam
