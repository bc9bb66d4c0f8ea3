// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "soslam/appearance/appearance_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/one_body.h"
#include "support/pictures.h"
#include "support/printed.h"

namespace soslam {
namespace {

// A body that is as wide as it is deep, whose yaw neither boxes nor the grey images tell.
class RunRefineWithPicturesTest : public FolderTest {
 protected:
  RunRefineWithPicturesTest() {
    options_.method = RefinementMethod::kProfile;
    options_.profile.edge_alignment = options_.profile.texture_symmetry = false;
    options_.profile.upright.axes_weight = 0.0;
    options_.profile.pictures.yaw = true;
    sequence_.objects[0].label = "pot";
    const nlohmann::json pot = {{"a_by_c", 0.75},
                                {"b_by_c", 0.75},
                                {"a_by_c_log_sigma", 0.05},
                                {"b_by_c_log_sigma", 0.05},
                                {"shape_exponent", kEllipsoidExponent},
                                {"source", "the test"}};
    WriteBytes(files_.at("table"), nlohmann::json{{"labels", {{"pot", pot}}}}.dump());
    EdgesWriter edges(files_.at("edges"), {});
    const cv::Mat grey(sequence_.camera.height, sequence_.camera.width, CV_8UC1, cv::Scalar(50));
    for (Frame& frame : sequence_.frames) {
      frame.image = "grey";
      edges.Write(frame.id, ComputeEdgeMaps(grey, {}));
    }
    edges.Commit();
    WriteSequence(files_.at("sequence"), sequence_, {});
    LandmarkEstimates initial;
    for (int i = 0; i < static_cast<int>(sequence_.detections.size()); ++i) {
      const Landmark truth = *TrueLandmarkInCamera(sequence_, sequence_.detections[i]);
      initial.observations.push_back({i, {{truth, 0.0}}, ""});
    }
    WriteLandmarks(files_.at("initial"), initial, sequence_, info_);
  }
  static Landmark Body() {
    return {
        {Eigen::Quaterniond::Identity(), {0.1, -0.2, 0.4}}, {0.3, 0.3, 0.4}, kEllipsoidExponent};
  }
  // What pictures say that show the body turned by an angle (rad) about its z axis, and as deep and
  // wide as told, relative to its height.
  void WritePictures(double turn, double ratio = 0.75) {
    AddTruePictures(&sequence_, turn);
    std::vector<AppearanceRecord> records;
    for (const Detection& detection : sequence_.detections) {
      records.push_back({sequence_.FrameOf(detection).id, 0, *detection.appearance,
                         Eigen::VectorXf::Ones(1), 0.0F});
      const auto log_ratio = static_cast<float>(std::log(ratio));
      records.back().appearance.log_ratios =
          LogRatios{Eigen::Vector2f::Constant(log_ratio), Eigen::Vector2f::Constant(1e-3F)};
    }
    WriteAppearance(files_.at("appearance"), records, info_);
  }
  void Run() const {
    PrintedBy([&] { RunRefine(options_, files_, 2); });
  }
  // How far (rad) each refined landmark is turned from the true one.
  std::vector<double> Turns() const {
    Run();
    std::vector<double> turns;
    for (const auto& observation : ReadLandmarks(files_.at("output"), sequence_).observations) {
      const Detection& detection = sequence_.detections[observation.detection_index];
      const auto yaw = [&](const Landmark& landmark) {
        return Yaw(detection.plane_in_camera.normal, landmark.frame_from_object.rotation);
      };
      turns.push_back(YawDifferenceModuloPi(yaw(observation.hypotheses.at(0).landmark_in_camera),
                                            yaw(*TrueLandmarkInCamera(sequence_, detection))));
    }
    return turns;
  }

  Sequence sequence_ = ViewsOfBody(Body(), CamerasOnArc(3, 2.0));
  OrientationOptions options_;
  StageFiles files_ = {
      {"sequence", folder_ / "sequence.json"},   {"table", folder_ / "table.json"},
      {"initial", folder_ / "initial.json"},     {"edges", folder_ / "edges.h5"},
      {"appearance", folder_ / "appearance.h5"}, {"output", folder_ / "refined.json"},
      {"curves", folder_ / "symmetry.h5"}};
  ArtefactInfo info_ = {{}, {files_.at("sequence")}};
};

TEST_F(RunRefineWithPicturesTest, LandmarksTurnToTheYawThatPicturesTell) {
  constexpr double kHalfBinDeg = 180.0 / kAzimuthBins;
  for (const double turn : {-70.0, -20.0, 40.0}) {
    WritePictures(turn * kRadPerDeg);
    const auto turns = Turns();
    ASSERT_EQ(turns.size(), sequence_.detections.size());
    for (const double found : turns) EXPECT_NEAR(found * kDegPerRad, turn, kHalfBinDeg);
    EXPECT_THAT(FileBytes(files_.at("output")), testing::HasSubstr("appearance.h5"));
  }
}

TEST_F(RunRefineWithPicturesTest, PicturesSayNothingOfYawUnlessAsked) {
  options_.profile.pictures = {.yaw = false, .ratios = true};
  WritePictures(0.5);
  const auto turns = Turns();
  WritePictures(-0.9);
  EXPECT_EQ(Turns(), turns);
}

TEST_F(RunRefineWithPicturesTest, LandmarksHaveTheRatiosThatPicturesTellIfAsked) {
  const auto ratios = [&](bool are_asked, double told) {
    options_.profile.pictures = {.yaw = true, .ratios = are_asked};
    WritePictures(0.0, told);
    Run();
    const auto estimates = ReadLandmarks(files_.at("output"), sequence_);
    const Landmark& landmark = estimates.observations.at(0).hypotheses.at(0).landmark_in_camera;
    return Eigen::Vector2d(landmark.half_axes.head<2>() / landmark.half_axes.z());
  };
  EXPECT_LT((ratios(true, 0.5) - Eigen::Vector2d(0.5, 0.5)).norm(), 0.01);
  EXPECT_LT((ratios(true, 0.9) - Eigen::Vector2d(0.9, 0.9)).norm(), 0.01);
  EXPECT_EQ(ratios(false, 0.5), ratios(false, 0.9));
}

TEST_F(RunRefineWithPicturesTest, PicturesThatAreMissingOrOfAnotherSequenceAreRefused) {
  sequence_.name = "another";
  WriteSequence(folder_ / "another.json", sequence_, {});
  WriteAppearance(files_.at("appearance"), {}, {{}, {folder_ / "another.json"}});
  ExpectError<InputError>([&] { Run(); }, {"appearance.h5", "was not made of", "sequence.json"});
  files_.erase("appearance");
  ExpectError<SettingsError>([&] { Run(); }, {"picture_yaw", "--appearance"});
}

}  // namespace
}  // namespace soslam
