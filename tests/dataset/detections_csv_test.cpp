// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/error.h"
#include "dataset/labelled_box.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class DetectionsCsvTest : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) {
    WriteBytes(folder_ / "detections.csv", text);
    return folder_ / "detections.csv";
  }
  TemporaryFolder folder_;
};

TEST_F(DetectionsCsvTest, WithAndWithoutObjectIds) {
  for (const char* text : {"frame,label,score,x1,y1,x2,y2\n3,cup,0.5,1,2,3.25,4\n",
                           "# a comment\nscore,frame,object_id,label,x1,y1,x2,y2\n"
                           "0.5,3,7,cup,1,2,3.25,4\n"}) {
    const auto boxes = ReadDetectionsCsv(Write(text));
    ASSERT_EQ(boxes.size(), 1u);
    ExpectLabelledBox(boxes[0], 3, "cup", 0.5, {1, 2, 3.25, 4});
  }
}

TEST_F(DetectionsCsvTest, ObjectIds) {
  const auto boxes = ReadDetectionsCsv(
      Write("frame,object_id,label,score,x1,y1,x2,y2\n3,7,cup,0.5,1,2,3,4\n3,,cup,0.5,1,2,3,4\n"
            "3,8.0,cup,0.5,1,2,3,4\n"));
  EXPECT_EQ(boxes.at(0).object_id, 7);
  EXPECT_FALSE(boxes.at(1).object_id);
  EXPECT_EQ(boxes.at(2).object_id, 8);
}

TEST_F(DetectionsCsvTest, AsSpreadsheetsAndOtherProgramsWriteIt) {
  for (const char* text :
       {"\"frame\",\"label\",\"score\",\"x1\",\"y1\",\"x2\",\"y2\"\n3,\"milk "
        "carton\",0.5,1,2,3.25,4\n",
        "frame;label;score;x1;y1;x2;y2\n3;milk carton;0.5;1;2;3.25;4\n",
        "Frame \tLABEL\tScore\tX1\ty1\tx2\ty2\n3\tmilk carton\t0.5\t1\t2\t3.25\t4\n",
        "frame,label,score,x1,y1,x2,y2\r3,milk carton,0.5,1,2,3.25,4\r"}) {
    const auto boxes = ReadDetectionsCsv(Write(text));
    ASSERT_EQ(boxes.size(), 1u) << text;
    ExpectLabelledBox(boxes[0], 3, "milk carton", 0.5, {1, 2, 3.25, 4});
  }
  const auto boxes =
      ReadDetectionsCsv(Write("frame,Object ID,label,score,x1,y1,x2,y2\n3,7,cup,0.5,1,2,3,4\n"));
  EXPECT_EQ(boxes.at(0).object_id, 7);
}

TEST_F(DetectionsCsvTest, WrittenBoxesComeBackRounded) {
  const std::string text = LabelledBoxesText(
      {{"", 0, "milk carton", 0.123456, {-0.5, 10.126, 20, 30}}, {"", 12, "cup", 1, {1, 2, 3, 4}}});
  EXPECT_EQ(text,
            "frame,label,score,x1,y1,x2,y2\n"
            "0,milk carton,0.1235,-0.50,10.13,20.00,30.00\n"
            "12,cup,1.0000,1.00,2.00,3.00,4.00\n");
  const auto boxes = ReadDetectionsCsv(Write(text));
  ASSERT_EQ(boxes.size(), 2u);
  ExpectLabelledBox(boxes[0], 0, "milk carton", 0.1235, {-0.5, 10.13, 20, 30});
}

TEST_F(DetectionsCsvTest, LabelsWithCommasAndQuotesComeBack) {
  for (const char* label : {"box, large", "12\" screen", "\"cup\""}) {
    const auto boxes =
        ReadDetectionsCsv(Write(LabelledBoxesText({{"", 0, label, 1, {1, 2, 3, 4}}})));
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_EQ(boxes[0].label, label);
  }
}

TEST_F(DetectionsCsvTest, FirstAndLastFieldBetweenTabsMayBeEmpty) {
  const auto boxes =
      ReadDetectionsCsv(Write("object_id\tframe\tlabel\tscore\tx1\ty1\tx2\ty2\tnote\n"
                              "\t3\tcup\t0.5\t1\t2\t3\t4\t\r\n\t\t\n"));
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_FALSE(boxes[0].object_id);
  EXPECT_EQ(boxes[0].label, "cup");
}

TEST_F(DetectionsCsvTest, OnlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  ExpectError<InputError>([&] { ReadDetectionsCsv(folder_ / "pipe"); }, {"pipe", "cannot be read"});
  Write("");
  std::filesystem::resize_file(folder_ / "detections.csv", (1u << 30) + 1);  // of no blocks
  ExpectError<InputError>([&] { ReadDetectionsCsv(folder_ / "detections.csv"); },
                          {"detections.csv", "1073741825 bytes", "at most 1073741824"});
}

TEST_F(DetectionsCsvTest, BadFilesAreNamed) {
  const std::string header = "frame,label,score,x1,y1,x2,y2\n";
  const BadTexts cases = {
      {header + "a.png,cup,0.5,1,2,3,4\n", {"detections.csv:2", "frame is 'a.png'"}},
      {"frame;label;score;x1;y1;x2;y2\n0;cup;0,5;1;2;3;4\n",
       {"detections.csv:2", "score is '0,5'", "a decimal point"}},
      {header + "0,\"cup,0.5,1,2,3,4\n", {"detections.csv:2", "not closed"}},
      {header + "0,\"cup\"s,0.5,1,2,3,4\n", {"detections.csv:2", "'s' after a quoted field"}}};
  ExpectBadTexts(cases, "detections.csv",
                 [&](const std::string& text) { ReadDetectionsCsv(Write(text)); });
}

}  // namespace
}  // namespace soslam
