// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "support/dataset_fixture.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// One change to a valid dataset, and what the error has to say.
struct BadCase {
  const char* file;
  const char* from;  // "" with an empty file: the whole content; nullptr: the file is removed
  const char* to;
  const char* message;
};

const std::vector<BadCase> kBadCases = {
    {"rgb.txt", "", "# nothing\n", "lists no image"},
    {"rgb.txt", "2.0 rgb/1.jpg", "2.0", "rgb.txt:3: has no file name"},
    {"rgb.txt", "2.0 rgb", "2,0 rgb", "rgb.txt:3: timestamp"},
    {"rgb.txt", "rgb/1.jpg", "rgb/\xE9.jpg", "rgb.txt:3: is not UTF-8"},
    {"odometry.txt", "0.11 0", "nan 0", "odometry.txt:2: tx is 'nan'"},
    {"odometry.txt", "0.11 0 ", "0.11 ", "odometry.txt:2: has 7 numbers"},
    {"odometry.txt", "0.11 0 ", "0.11,0,", "odometry.txt:2: has 6 words, with commas; expected"},
    {"odometry.txt", "0.11 0 ", "0.11, 0 ", "qw, with blanks between"},
    {"odometry.txt", "0.11 0 ", "0,11 0 ",
     "odometry.txt:2: tx is '0,11'; expected a finite number, with"},
    {"odometry.txt", "0.11 0 1.5 0 0 0 1", "0.11 0 1.5 0 0 0 1.02",
     "odometry.txt:2: quaternion has norm 1.02"},
    {"odometry.txt", "3.001", "2.001", "timestamp 2.001 twice"},
    {"odometry.txt", "", "", "has no pose"},
    {"detections.csv", nullptr, "", "given by detections and detections_format"},
    {"detections.csv", "", "", "is empty"},
    {"detections.csv", "score", "confidence", "column 'confidence' would be ignored"},
    {"detections.csv", "y2\n", "y2,y2\n", "column 'y2' is twice"},
    {"detections.csv", "0,2,box,0.8,", "0,2,box,", "detections.csv:3: has 7 fields; expected 8"},
    {"detections.csv", "300,100,400,200", "300,nan,400,200", "detections.csv:3: y1 is 'nan'"},
    {"detections.csv", "box,0.8", "box,", "detections.csv:3: score is ''"},
    {"detections.csv", "0,2,box", "0.5,2,box", "frame is '0.5'"},
    {"detections.csv", "0,2,box", "4,2,box",
     "detections.csv:3: frame is 4; expected a row of rgb.txt, 0 to 3"},
    {"detections.csv", "0,2,box", "-1,2,box", "frame is -1"},
    {"detections.csv", "0,2,box", "0,2,", "label is empty"},
    {"detections.csv", "",
     "\xFF\xFE"
     "f",
     "is UTF-16 text; expected UTF-8"},
    {"objects.json", "\"cup\"", "\"mug\"", "detections.csv:2: label of object 1 is 'cup'"},
    {"camera.json", "", "[]", "is not an object"},
    {"camera.json", "\"fx\"", "\"name\"", "fx is missing"},
    {"camera.json", "510.0", "-510.0", "fy is -510.0"},
    {"camera.json", "500.0", "0", "fx is 0"},
    {"camera.json", "640", "0", "width is 0"},
    {"camera.json", "480", "480.5", "height is 480.5"},
    {"camera.json", "239.5", "\"239.5\"", "cy is \"239.5\""},
    {"camera.json", "239.5", "1e999", "number overflow"},
    {"camera.json", "",
     "\xFE\xFF"
     "{",
     "is UTF-16 text"},
    {"planes.json", "", "[]", "has no plane"},
    {"planes.json", "[0, 0, 2]", "[0, 0, 1e-9]", "planes.json[0]: normal is [0,0,1e-09]"},
    {"planes.json", "[0, 0, 2]", "[0, 2]", "expected 3 numbers"},
    {"planes.json", "",
     R"([{"id": 3, "normal": [0, 0, 1], "d": 0}, {"id": 3, "normal": [0, 0, 1], "d": 1}])",
     "id 3 twice"},
    {"objects.json", "\"cup\"", "\"\"", "objects.json[0]: label is \"\""},
    {"objects.json", "\"id\": 1", "\"id\": 4294967297", "id is 4294967297"},
    {"objects.json", "", R"([{"id": 1, "label": "cup"}, {"id": 1, "label": "cup"}])", "id 1 twice"},
    {"objects.json", "0.1, 0.2, 0.3", "0.1, 0, 0.3", "objects.json[0]: half_axes is [0.1,0,0.3]"},
    {"objects.json", "\"half_axes\"", "\"name\"", "half_axes is missing"},
    {"objects.json", "0.6, 0.8", "0.6, 0.9", "objects.json[0]: quaternion has norm 1.08"},
    {"objects.json", "true", "1", "mirror_symmetric is 1"},
    {"objects.json", "\"support_plane\": 0", "\"support_plane\": 7",
     "support_plane of object 1 is 7"}};

TEST(BadDatasetTest, IsRefusedByName) {
  for (const auto& [file, from, to, message] : kBadCases) {
    SCOPED_TRACE(testing::Message() << file << ": " << message);
    DatasetFixture dataset;
    if (from == nullptr) {
      dataset.files.erase(file);
    } else if (*from == '\0') {
      dataset.files[file] = to;
    } else {
      dataset.Replace(file, from, to);
    }
    const TemporaryFolder folder;
    dataset.Write(folder.path());
    ExpectError<InputError>([&] { ImportDataset(folder.path(), {}); }, {message, file});
  }
}

TEST(BadDatasetTest, SeveralPlanesNeedASupportPlane) {
  DatasetFixture dataset;
  dataset.files["planes.json"] =
      R"([{"id": 0, "normal": [0, 0, 1], "d": 0}, {"id": 1, "normal": [0, 0, 1], "d": -0.7}])";
  const TemporaryFolder folder;
  dataset.Write(folder.path());
  ExpectError<InputError>([&] { ImportDataset(folder.path(), {}); },
                          {"object 2 ('box') has no support_plane"});
  dataset.files["objects.json"] = R"([{"id": 1, "label": "cup", "support_plane": 1},
                                      {"id": 2, "label": "box", "support_plane": 0}])";
  dataset.Write(folder.path());
  const Sequence sequence = ImportDataset(folder.path(), {});
  EXPECT_EQ(sequence.objects[0].plane_index, 1);
  EXPECT_EQ(sequence.objects[1].plane_index, 0);
}

}  // namespace
}  // namespace soslam
