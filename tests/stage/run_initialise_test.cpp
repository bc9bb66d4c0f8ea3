// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/options.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"
#include "support/drawn_cuboids.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/points_on_objects.h"
#include "support/printed.h"
#include "support/scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// CubeSLAM's cuboids of drawn cuboids. Labels have no entry in the semantic table.
class RunInitialiseCuboidsTest : public FolderTest {
 protected:
  RunInitialiseCuboidsTest() {
    options_.method = InitialisationMethod::kCuboidProposals;
    for (Frame& frame : sequence_.frames) frame.image = "drawn";
    WriteBytes(files_.at("table"), R"({"labels": {}})");
  }

  cv::Mat Draw(int frame_index) const {
    std::vector<Landmark> cuboids;
    for (const Detection& detection : sequence_.detections) {
      if (detection.frame_index != frame_index) continue;
      cuboids.push_back(*TrueLandmarkInCamera(sequence_, detection));
    }
    std::ranges::sort(cuboids, std::greater(),
                      [](const Landmark& cuboid) { return cuboid.Centre().norm(); });
    return DrawCuboids(sequence_.camera, cuboids);
  }
  // Edge maps of all frames; `plain`: of this frame's image nothing is drawn.
  void WriteEdges(int plain = -1) const {
    EdgesWriter writer(files_.at("edges"), {});
    for (size_t i = 0; i < sequence_.frames.size(); ++i) {
      const auto index = static_cast<int>(i);
      const cv::Mat grey =
          index == plain ? cv::Mat(480, 640, CV_8UC1, cv::Scalar(50)) : Draw(index);
      writer.Write(sequence_.frames[i].id, ComputeEdgeMaps(grey, {}));
    }
    writer.Commit();
  }
  LandmarkEstimates Run(int threads = 2) const {
    WriteSequence(files_.at("sequence"), sequence_, {});
    PrintedBy([&] { RunInitialise(options_, files_, threads); });
    return ReadLandmarks(files_.at("output"), sequence_);
  }

  StageFiles files_ = {{"sequence", folder_ / "sequence.json"},
                       {"table", folder_ / "table.json"},
                       {"edges", folder_ / "edges.h5"},
                       {"output", folder_ / "initial.json"}};
  Sequence sequence_ = CuboidSequence(3, 5);
  InitialiseOptions options_;
};

TEST_F(RunInitialiseCuboidsTest, FindsCuboidsThatOverlapTheTruth) {
  WriteEdges();
  double sum = 0.0;
  const LandmarkEstimates estimates = Run();
  ASSERT_EQ(estimates.observations.size(), sequence_.detections.size());
  for (const ObservationEstimate& estimate : estimates.observations) {
    EXPECT_EQ(estimate.failure, "");
    ASSERT_FALSE(estimate.hypotheses.empty());
    EXPECT_TRUE(std::ranges::is_sorted(estimate.hypotheses, {}, &Hypothesis::cost));
    EXPECT_LE(estimate.hypotheses.size(), static_cast<size_t>(options_.cuboids.yaw_samples));
    sum += BoxIou(estimate.hypotheses.front().landmark_in_camera,
                  *TrueLandmarkInCamera(sequence_, sequence_.detections[estimate.detection_index]));
  }
  EXPECT_GT(sum / static_cast<double>(estimates.observations.size()), 0.5);
}

TEST_F(RunInitialiseCuboidsTest, GivesTheSameBytesForAnyNumberOfThreads) {
  WriteEdges();
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {files_.at("output")});
}

TEST_F(RunInitialiseCuboidsTest, NamesWhatHasNoCuboid) {
  constexpr int kPlain = 0, kWithoutImage = 1;
  sequence_.frames[kWithoutImage].image.clear();
  Detection& in_the_sky = sequence_.detections.back();
  in_the_sky.box = {300, 5, 340, 30};
  WriteEdges(kPlain);
  const LandmarkEstimates estimates = Run();
  for (const ObservationEstimate& estimate : estimates.observations) {
    const Detection& detection = sequence_.detections[estimate.detection_index];
    const std::string expected = detection.frame_index == kPlain          ? "no_edges"
                                 : detection.frame_index == kWithoutImage ? "frame_without_image"
                                 : &detection == &in_the_sky              ? "no_solution"
                                                                          : "";
    EXPECT_EQ(estimate.failure, expected);
    EXPECT_EQ(estimate.hypotheses.empty(), !expected.empty());
  }
}

TEST_F(RunInitialiseCuboidsTest, RefusesToRunWithoutEdges) {
  files_.erase("edges");
  ExpectError<SettingsError>([&] { Run(); }, {"method = cuboid_proposals needs --edges FILE"});
}

// edges.h5 of images of another size, as after a camera.json was replaced.
TEST_F(RunInitialiseCuboidsTest, AllStagesRefuseEdgesOfImagesOfAnotherSize) {
  WriteEdges();
  const LandmarkEstimates estimates = Run();
  sequence_.camera.width = 1280;
  const std::vector<std::string> words = {files_.at("edges").string(), "640", "1280"};
  ExpectError<InputError>([&] { Run(); }, words);
  WriteLandmarks(files_.at("output"), estimates, sequence_, {{}, {files_.at("sequence")}});
  StageFiles files = files_;
  files["initial"] = files["landmarks"] = files_.at("output");
  files["output"] = folder_ / "later.json";
  files["curves"] = folder_ / "symmetry.h5";
  ExpectError<InputError>([&] { RunRefine({}, files, 2); }, words);
  OptimiseOptions optimise;
  optimise.detection_model = DetectionModel::kTangency;
  optimise.edge_alignment = true;
  ExpectError<InputError>([&] { RunOptimise(optimise, files, 2); }, words);
}

TEST(PointEvidenceInFrames, NeedsPointsAndAMethodThatUsesThem) {
  const StageFiles with_points = {{"points", "points.h5"}};
  InitialiseOptions initialise;
  initialise.points.point_evidence = true;
  const auto run_initialise = [&](const StageFiles& files) { RunInitialise(initialise, files, 1); };
  ExpectError<SettingsError>([&] { run_initialise(with_points); },
                             {"point_evidence", "yaw_sweep", "found single_frame"});
  initialise.method = InitialisationMethod::kYawSweep;
  ExpectError<SettingsError>([&] { run_initialise({}); }, {"point_evidence", "--points"});

  OrientationOptions refine;
  refine.profile.points.point_evidence = true;
  const auto run_refine = [&](const StageFiles& files) { RunRefine(refine, files, 1); };
  ExpectError<SettingsError>([&] { run_refine(with_points); },
                             {"point_evidence", "profile", "found turn"});
  refine.method = RefinementMethod::kProfile;
  ExpectError<SettingsError>([&] { run_refine({}); }, {"point_evidence", "--points"});
}

}  // namespace
}  // namespace soslam
