// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/ground/options.h"
#include "soslam/inspection/canvas.h"
#include "soslam/inspection/overlay.h"
#include "soslam/stage/stages.h"
#include "soslam/synthesis/simulate.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/scene.h"
#include "support/temporary_folder.h"
#include "support/true_map.h"

namespace soslam {
namespace {

using testing::HasSubstr;

class RunInspectTest : public FolderTest {
 protected:
  RunInspectTest() {
    for (Frame& frame : sequence_.frames) frame.image.clear();
    WriteSequence(File("sequence.json"), sequence_, {});
    WriteLandmarks(File("initial.json"), {}, sequence_, {{}, {File("sequence.json")}});
    WriteMetrics(File("metrics.json"), {}, sequence_, {});
  }
  std::filesystem::path File(const std::string& name) const { return folder_ / name; }
  InspectRequest RequestOf(const std::string& name) const {
    InspectRequest request;
    request.file = File(name);
    return request;
  }
  InspectRequest PictureOf(const std::string& name) const {
    InspectRequest request = RequestOf(name);
    request.image = File("picture.png");
    request.frame_id = sequence_.frames.front().id;
    return request;
  }
  // Expects that the request is refused with these words.
  static void ExpectRefused(const InspectRequest& request, const std::vector<std::string>& words) {
    ExpectError<SettingsError>([&] { RunInspect(request, false); }, words);
  }
  cv::Mat Picture() const { return cv::imread(File("picture.png").string()); }

  Sequence sequence_ = SyntheticSequence(RandomScene(1, 3, 5), false);
};

TEST_F(RunInspectTest, ADamagedStageIsRefused) {
  nlohmann::json document = ReadArtefact(File("metrics.json"), "metrics");
  document["artefact"]["stage"] = 5;
  WriteBytes(File("metrics.json"), document.dump());
  ExpectError<InputError>([&] { RunInspect(RequestOf("metrics.json"), false); },
                          {"metrics.json", "stage"});
}

TEST_F(RunInspectTest, WordsAndTableAreReturned) {
  const std::string text = RunInspect(RequestOf("sequence.json"), false);
  EXPECT_THAT(text, HasSubstr("sequence.json: sequence"));
  EXPECT_THAT(text, HasSubstr("\nobject  label"));
  EXPECT_THAT(text, HasSubstr("... and 2 more (--table detections)"));
  EXPECT_THAT(text, testing::Not(HasSubstr("\x1b")));
  EXPECT_THAT(RunInspect(RequestOf("sequence.json"), true), HasSubstr("\x1b["));
}

TEST_F(RunInspectTest, CsvIsReturnedOrWritten) {
  InspectRequest request = RequestOf("sequence.json");
  request.csv = "-";
  EXPECT_THAT(RunInspect(request, true), testing::StartsWith("frame,timestamp,"));
  request.table = "objects";
  const std::string csv = RunInspect(request, true);
  EXPECT_THAT(csv, testing::StartsWith("object,label,plane,"));
  request.csv = File("table.csv");
  EXPECT_EQ(RunInspect(request, true), "");
  EXPECT_EQ(FileBytes(File("table.csv")), csv);
}

TEST_F(RunInspectTest, OneObjectHasItsRowsAlone) {
  Associations associations;
  associations.tracks.resize(2);
  for (int i = 0; i < 2; ++i) {
    associations.tracks[i] = {.track = i, .boxes = 3, .detections = 3};
    associations.objects.push_back({i + 1, i, i == 0 ? "cup" : "sofa", {}, 3});
    const Associations::DetectionName box = {i, i, {1.0, 2.0, 3.0, 4.0}};
    associations.held_least.push_back({i + 1, box, box, {3, 77 + i}});
    associations.kept_out.push_back({i + 1, 1 - i, 3, 2, box, {}});
  }
  WriteAssociations(File("associations.json"), associations, {});
  InspectRequest request = RequestOf("associations.json");
  request.object_id = 2;
  const std::string text = RunInspect(request, false);
  EXPECT_THAT(text, testing::AllOf(HasSubstr("sofa"), testing::Not(HasSubstr("cup"))));
  EXPECT_THAT(text, HasSubstr("\nheld_least, 1 row"));
  EXPECT_THAT(text, testing::Not(HasSubstr("\ntracks, ")));
  request.table = "held_least";
  EXPECT_THAT(RunInspect(request, false),
              testing::AllOf(HasSubstr("78"), testing::Not(HasSubstr("77"))));
  request.object_id = 3;
  ExpectRefused(request, {"--object 3", "associations.json", "no row"});
}

TEST_F(RunInspectTest, AnotherSequenceThanTheArtefactsIsRefused) {
  InspectRequest request = RequestOf("initial.json"), picture = PictureOf("initial.json");
  request.sequence = picture.sequence = File("sequence.json");
  EXPECT_THAT(RunInspect(request, false), HasSubstr("initial.json: landmarks"));
  sequence_.name = "another";
  WriteSequence(File("sequence.json"), sequence_, {});
  for (const InspectRequest& refused : {request, picture}) {
    ExpectError<InputError>([&] { RunInspect(refused, false); },
                            {"initial.json: was not made of", "sequence.json"});
  }
  // Edges do not depend on what else is in a sequence.
  EdgesWriter(File("edges.h5"), {}).Commit();
  request.file = File("edges.h5");
  EXPECT_THAT(RunInspect(request, false), HasSubstr("edges.h5: edges"));
}

TEST_F(RunInspectTest, TheHeadlineOfAMapIsALine) {
  MapEstimate map = TrueMap(sequence_);
  // Its place is known to a kilometre.
  map.objects[1].covariance = Covariance9(1e6 * Covariance9::Identity());
  map.objects[1].covariance->block<3, 3>(6, 6) *= 1e-9;
  WriteMap(File("map.json"), map, sequence_, {{}, {File("sequence.json")}});
  InspectRequest request = RequestOf("map.json");
  request.headline = true;
  EXPECT_EQ(RunInspect(request, true), "3 objects, 1 object uncertain\n");
  GroundEstimate ground;
  ground.scale = ScalePosterior{.log_sigma = 0.05, .low = -0.1, .high = 0.1};
  ground.known_scales = {{0.0, 0.1, "camera_height_m"}};
  const std::vector<Finding> findings = {
      {kObjectsAgainstSettingsCheck, Severity::kWarning, "", "", "", ""}};
  WriteWorld(File("world.json"), MakeReport(ground, sequence_, findings),
             {OptionsToJson(GroundOptions()), {}, findings});
  EXPECT_EQ(RunInspect(request, true),
            "3 objects, scale +- 11 % (uncertain: the heights of objects contradict the camera's "
            "height given), 1 object uncertain\n");
  EXPECT_THAT(RunInspect(RequestOf("world.json"), false), HasSubstr(kObjectsAgainstSettingsCheck));
  Sequence other = sequence_;
  other.name = "another";
  WriteSequence(File("other.json"), other, {});
  request.sequence = File("other.json");
  ExpectError<InputError>([&] { RunInspect(request, false); },
                          {"map.json: was not made of", "other.json"});
  request.file = File("metrics.json");
  ExpectRefused(request, {"metrics", "expected a map"});
}

TEST_F(RunInspectTest, FramesWithoutImagesHavePicturesToo) {
  EXPECT_EQ(RunInspect(PictureOf("sequence.json"), false), "");
  EXPECT_GE(Picture().cols, kPictureWidth);
  EXPECT_GT(Picture().rows * sequence_.camera.width, Picture().cols * sequence_.camera.height)
      << "there is a caption";
}

TEST_F(RunInspectTest, TheImageOfTheDatasetIsBelow) {
  const Camera& camera = sequence_.camera;
  Write("data/0.png",
        EncodedImage(".png", cv::Mat(camera.height, camera.width, CV_8UC1, cv::Scalar(200))));
  sequence_.frames.front().image = "0.png";
  sequence_.detections.clear();
  WriteSequence(File("sequence.json"), sequence_, {});
  InspectRequest request = PictureOf("sequence.json");
  request.dataset = File("data");
  RunInspect(request, false);
  EXPECT_EQ(Picture().at<cv::Vec3b>(50, 50), cv::Vec3b(200, 200, 200));
}

TEST_F(RunInspectTest, PicturesOfEstimatesNeedTheSequence) {
  InspectRequest request = PictureOf("initial.json");
  ExpectRefused(request, {"needs --sequence"});
  request.sequence = File("sequence.json");
  RunInspect(request, false);
  EXPECT_FALSE(Picture().empty());
}

TEST_F(RunInspectTest, PicturesOfEdgesShowOneLayerOrAll) {
  EdgesWriter writer(File("edges.h5"), {});
  writer.Write(3, ComputeEdgeMaps(cv::Mat(90, 120, CV_8UC1, cv::Scalar(7)), {}));
  writer.Commit();
  InspectRequest request = PictureOf("edges.h5");
  request.frame_id = 3;
  RunInspect(request, false);
  const cv::Mat all = Picture();
  request.layer = EdgeLayer::kGrey;
  RunInspect(request, false);
  EXPECT_EQ(all.cols, kPictureWidth);
  EXPECT_EQ(Picture().at<cv::Vec3b>(10, 10), cv::Vec3b(7, 7, 7));
  request.frame_id = 4;
  ExpectRefused(request, {"--frame 4", "3 to 3"});
}

TEST_F(RunInspectTest, PicturesOfSymmetryNeedFrameAndObject) {
  SymmetryRecord record;
  record.frame_id = sequence_.frames.front().id;
  record.object_id = 7;
  WriteSymmetry(File("symmetry.h5"), {record}, {{}, {File("sequence.json")}});
  InspectRequest request = PictureOf("symmetry.h5");
  request.sequence = File("sequence.json");
  ExpectRefused(request, {"needs --object"});
  request.object_id = 8;
  ExpectRefused(request, {"--object 8", "no observation"});
  request.object_id = 7;
  RunInspect(request, false);
  EXPECT_FALSE(Picture().empty());
}

TEST_F(RunInspectTest, WhatHasNoPictureIsRefused) {
  ExpectRefused(PictureOf("metrics.json"), {"no picture of kind 'metrics'"});
  InspectRequest request = PictureOf("sequence.json");
  request.frame_id = 99;
  ExpectRefused(request, {"--frame 99", "0 to 4"});
  request.frame_id.reset();
  ExpectRefused(request, {"needs --frame"});
  request = PictureOf("sequence.json");
  request.image = File("picture.jpg");
  ExpectRefused(request, {".png"});
  EXPECT_FALSE(std::filesystem::exists(File("picture.png")));
}

}  // namespace
}  // namespace soslam
