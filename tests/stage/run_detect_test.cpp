// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/image/detector_options.h"
#include "soslam/image/network.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/labelled_boxes.h"
#include "support/onnx_network.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::HasSubstr;

constexpr int kImages = 5;

// Images from dark to bright, and a network that is as sure of its cup as the image is red, and
// half as sure of its box.
class RunDetectTest : public FolderTest {
 protected:
  RunDetectTest() {
    std::string list = "# timestamp filename\n";
    for (int i = 0; i < kImages; ++i) {
      const std::string name = "rgb/" + std::to_string(i) + ".png";
      list += std::to_string(0.1 * i) + " " + name + "\n";
      const cv::Mat image(64, 64, CV_8UC3, cv::Scalar(0, 0, 51 * i));  // red: 0, 0.2 ... 0.8
      Write(name, EncodedImage(".png", image));
    }
    Write("rgb.txt", list);
    Write("labels.txt", "cup\nmilk carton\n");
    MeanNetwork network = {{1, 2, 7}, {32, 32, 20, 30, 1, 0, 0, 10, 12, 8, 6, 1, 0, 0}, {}};
    network.weights.resize(14, {0.0F, 0.0F, 0.0F});
    network.weights[5][0] = 1.0F;
    network.weights[13][0] = 0.5F;
    Write("net.onnx", network.Onnx());
  }

  void Run(int threads = 1) {
    printed_ = PrintedBy([&] { RunDetect(options_, files_, threads); }).output;
  }
  // Expects that the stage refuses its input, saying these words, and writes nothing.
  void ExpectRefused(const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Run(); }, words);
    EXPECT_FALSE(std::filesystem::exists(files_.at("output")));
  }

  StageFiles files_ = {{"dataset", folder_.path()},
                       {"network", folder_ / "net.onnx"},
                       {"labels", folder_ / "labels.txt"},
                       {"output", folder_ / "detections.csv"}};
  DetectorOptions options_;
  std::string printed_;
};

TEST_F(RunDetectTest, WritesBoxesWithoutObjectIds) {
  Run();
  const auto boxes = ReadDetectionsCsv(folder_ / "detections.csv");
  ASSERT_EQ(boxes.size(), 5u);
  const Box cup{21.5, 16.5, 41.5, 46.5};
  ExpectLabelledBox(boxes[0], 2, "cup", 0.4, cup);
  ExpectLabelledBox(boxes[1], 3, "cup", 0.6, cup);
  ExpectLabelledBox(boxes[2], 3, "milk carton", 0.3, {5.5, 8.5, 13.5, 14.5});
  ExpectLabelledBox(boxes[3], 4, "cup", 0.8, cup);
  ExpectLabelledBox(boxes[4], 4, "milk carton", 0.4, {5.5, 8.5, 13.5, 14.5});
  EXPECT_THAT(printed_, HasSubstr("5 images, 5 detections"));
}

TEST_F(RunDetectTest, CommentsSayWhatItWasMadeFrom) {
  options_.min_score = 0.35;
  Run();
  const std::string text = FileBytes(folder_ / "detections.csv");
  const auto header = nlohmann::json::parse(text.substr(2, text.find('\n') - 2));
  EXPECT_EQ(header["kind"], "detections");
  EXPECT_EQ(header["backend"], std::string("OpenCV ") + CV_VERSION);
  options_.output_layout = OutputLayout::kV5;
  options_.pixel_values = PixelValues::kRgbUnit;
  options_.input_width = options_.input_height = 64;
  EXPECT_EQ(header["settings"], OptionsToJson(options_));
  for (const char* input : {"0.png", "4.png", "rgb.txt", "net.onnx", "labels.txt"}) {
    EXPECT_THAT(text, HasSubstr(std::string("# input {\"file\":\"") + input + "\",\"sha256\":"));
  }
}

TEST_F(RunDetectTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {folder_ / "detections.csv"});
  const std::string bytes = FileBytes(folder_ / "detections.csv");
  Run(50);  // more than images
  EXPECT_EQ(FileBytes(folder_ / "detections.csv"), bytes);
}

TEST_F(RunDetectTest, TheBackendIsTheOneThatIsAskedFor) {
  options_.backend = NetworkBackend::kOnnxRuntime;
  if (OnnxRuntimeVersion().empty()) {
    ExpectError<SettingsError>([&] { Run(); }, {"onnxruntime", "libonnxruntime-dev", "opencv"});
    EXPECT_FALSE(std::filesystem::exists(files_.at("output")));
    return;
  }
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {folder_ / "detections.csv"});
  EXPECT_EQ(ReadDetectionsCsv(folder_ / "detections.csv").size(), 5u);
  EXPECT_THAT(FileBytes(folder_ / "detections.csv"),
              HasSubstr("\"backend\":\"ONNX Runtime " + OnnxRuntimeVersion()));
}

TEST_F(RunDetectTest, BadInputIsNamedAndNothingIsWritten) {
  Write("rgb.txt", "1.0 ../elsewhere.png\n");
  ExpectRefused({"rgb.txt", "../elsewhere.png"});
  files_.erase("labels");
  Write("rgb.txt", "1.0 rgb/0.png\n");
  ExpectRefused({"net.onnx", "[1, 2, 7]", "80 classes"});
}

// OpenCV 4.6 crashes when it loads this one.
TEST_F(RunDetectTest, ACrashOfOpenCvIsAnError) {
  MeanNetwork network = {{1, 1, 7}, {32, 32, 20, 30, 1, 0, 0}, {}};
  network.weights_of_conv = "nothing";
  Write("net.onnx", network.Onnx());
  ExpectRefused({"net.onnx", "OpenCV"});
}

TEST_F(RunDetectTest, NamesInTheNetworkAreItsLabels) {
  MeanNetwork network = {{1, 1, 7}, {32, 32, 20, 30, 1, 0, 0.5F}, {}};
  network.metadata["names"] = "{0: 'cup', 1: 'tea pot'}";
  Write("net.onnx", network.Onnx());
  auto labels = files_.extract("labels");
  Run();
  EXPECT_EQ(ReadDetectionsCsv(folder_ / "detections.csv").at(0).label, "tea pot");
  EXPECT_THAT(printed_, HasSubstr("net.onnx: layout v5, pixel values rgb_0_1, input of 64 x 64"));
  for (const char* names : {"", "{}", "cup", "{0: 'cup'", "{0: 'cup', 2: 'book'}",
                            "['cup, saucer']", "['']", "['a\\n']", "['cup"}) {
    network.metadata["names"] = names;
    Write("net.onnx", network.Onnx());
    ExpectError<InputError>([&] { Run(); }, {"net.onnx", names, "--labels"});
  }
  files_.insert(std::move(labels));
  Run();  // the file of labels comes first
  EXPECT_EQ(ReadDetectionsCsv(folder_ / "detections.csv").at(0).label, "milk carton");
}

TEST_F(RunDetectTest, LabelsAreRenamedAndSelected) {
  options_.rename_labels = "milk carton = carton";
  options_.keep_labels = "carton";
  Run();
  const auto boxes = ReadDetectionsCsv(folder_ / "detections.csv");
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].label, "carton");
  EXPECT_EQ(boxes[0].frame, FrameKey(3));
  options_.min_score = 0.6;  // no carton is left, but cups
  ExpectError<NothingUsableError>([&] { Run(); }, {"not kept"});
}

// Raw boxes in cells, a pixel or two large, that another layout would take for pixels.
TEST_F(RunDetectTest, ImpossibleBoxesAreNotWritten) {
  WriteBytes(
      folder_ / "net.onnx",
      MeanNetwork{{1, 2, 7}, {0.5F, 0.5F, 1.5F, 2, 0.9F, 1, 0, 1, 1, 3, 2, 0.9F, 0, 1}, {}}.Onnx());
  ExpectRefused({"net.onnx", "of 10 boxes 10 are smaller", "layout v5", "rgb_0_1"});
}

TEST(LabelsForDetectorTest, GroupsForOverlaps) {
  const std::vector<std::string> classes = {"chair", "tv", "couch", "sofa"};
  DetectorOptions options;
  EXPECT_EQ(LabelsForDetector(classes, options).groups, (std::vector<int>{0, 1, 2, 3}));
  options.rename_labels = "couch=sofa";
  EXPECT_EQ(LabelsForDetector(classes, options).groups, (std::vector<int>{0, 1, 2, 2}));
  options.interchangeable_labels = "chair, sofa";
  EXPECT_EQ(LabelsForDetector(classes, options).groups, (std::vector<int>{0, 1, 0, 0}));
  options.class_agnostic = true;
  EXPECT_EQ(LabelsForDetector(classes, options).groups, (std::vector<int>{0, 0, 0, 0}));
}

TEST(LabelsForDetectorTest, BadOptionsAreRefused) {
  const auto expect_refused = [](std::string DetectorOptions::*option, const std::string& text,
                                 const std::vector<std::string>& words) {
    DetectorOptions options;
    options.*option = text;
    ExpectError<SettingsError>([&] { LabelsForDetector({"chair", "tv"}, options); }, words);
  };
  for (const char* text : {"tv", "tv=", "=tv", "tv=a, tv=b", "tv=a,"}) {
    expect_refused(&DetectorOptions::rename_labels, text, {"rename_labels"});
  }
  expect_refused(&DetectorOptions::rename_labels, "sofa=couch",
                 {"rename_labels has 'sofa'", "chair, tv"});
  expect_refused(&DetectorOptions::keep_labels, "chair, keybord",
                 {"keep_labels has 'keybord'", "chair, tv"});
  expect_refused(&DetectorOptions::interchangeable_labels, "chair; chair",
                 {"interchangeable_labels"});
}

// Boxes are those of the image as viewers show it, or as it is stored. The network sees both, and
// is as sure as the image fills its input.
TEST_F(RunDetectTest, ExifTurnsImages) {
  const cv::Mat image(32, 64, CV_8UC3, cv::Scalar(0, 0, 255));
  const std::string jpeg = EncodedImage(".jpg", image);
  Write("rgb/a.jpg", JpegWithExif(jpeg, ExifOf(6)));
  Write("rgb.txt", "0 rgb/a.jpg\n");
  const auto expect_box = [&](BoxOrientation orientation, const Box& box) {
    options_.image_orientation = orientation;
    Run();
    ExpectBox(ReadDetectionsCsv(folder_ / "detections.csv").at(0).box, box);
  };
  options_.input_width = 32;
  options_.input_height = 64;
  // (22, 17) to (32, 47) of the upright image, whose right column is the first stored row.
  expect_box(BoxOrientation::kUpright, {21.5, 16.5, 31.5, 46.5});
  expect_box(BoxOrientation::kStored, {16.5, -0.5, 46.5, 9.5});
  expect_box(BoxOrientation::kSurer, {21.5, 16.5, 31.5, 46.5});
  options_.input_width = 64;
  options_.input_height = 32;
  // (22, 17) to (42, 32) of the stored image.
  expect_box(BoxOrientation::kUpright, {-0.5, 21.5, 14.5, 41.5});
  expect_box(BoxOrientation::kStored, {21.5, 16.5, 41.5, 31.5});
  expect_box(BoxOrientation::kSurer, {21.5, 16.5, 41.5, 31.5});
  EXPECT_NE(FileBytes(folder_ / "detections.csv").find(R"("image_orientation":"stored")"),
            std::string::npos);
}

TEST_F(RunDetectTest, NothingFoundIsNotAResult) {
  options_.min_score = 0.9;
  Write("detections.csv", "old");
  ExpectError<NothingUsableError>([&] { Run(); }, {"net.onnx", "5 images", "0.9"});
  EXPECT_EQ(FileBytes(folder_ / "detections.csv"), "old");
}

}  // namespace
}  // namespace soslam
