// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/association/association.h"
#include "soslam/base/error.h"
#include "soslam/ground/options.h"
#include "soslam/planes/options.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/prior_scene.h"
#include "support/scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

// The stage on cuboids on a floor and a shelf, with their true ratios.
class RunPlanesTest : public FolderTest {
 protected:
  RunPlanesTest() {
    options_.planes = PlaneSource::kEstimated;
    options_.verticals.are_used = false;  // there are no images
    for (const Object& object : sequence_.objects) WriteLabel(object);
    WriteTable();
    WriteSequence(File("sequence"), sequence_, {});
  }

  void WriteLabel(const Object& object) {
    const Eigen::Vector3d& half_axes = object.ground_truth->landmark_in_world.half_axes;
    labels_[object.label] = {{"a_by_c", half_axes.x() / half_axes.z()},
                             {"b_by_c", half_axes.y() / half_axes.z()},
                             {"a_by_c_log_sigma", 0.1},
                             {"b_by_c_log_sigma", 0.1},
                             {"shape_exponent", 1.0},
                             {"mount", "standing"},
                             {"source", "the test"}};
  }
  void WriteTable() const { WriteBytes(File("table"), json{{"labels", labels_}}.dump()); }

  std::filesystem::path File(const std::string& name) const { return folder_ / (name + ".json"); }
  void Run(int threads = 1) const {
    StageFiles files;
    for (const char* name : {"sequence", "table", "output", "report"}) files[name] = File(name);
    RunPlanes(options_, files, threads);
  }

  PlanesOptions options_;
  json labels_;
  Sequence sequence_ =
      SyntheticSequence(WithShelf(RandomScene(1, 4, 16, {Shape::kBox}), 0.3), false);
};

// The back end twice.
using SlowRunPlanesTest = RunPlanesTest;

TEST_F(RunPlanesTest, LaterStagesReadTheEstimatedPlanesAndTheReportSaysWhyAndHowSure) {
  Run();
  const Sequence output = ReadSequence(File("output"));
  EXPECT_EQ(output.detections.size(), sequence_.detections.size());
  ASSERT_EQ(output.planes.size(), 2u);
  const json report = ReadArtefact(File("report"), "planes");
  ASSERT_EQ(report.at("planes").size(), 2u);
  for (const json& plane : report.at("planes")) {
    EXPECT_GT(plane.at("tilt_sigma_deg").get<double>(), 0.0);
    EXPECT_GT(plane.at("height_sigma_m").get<double>(), 0.0);
    EXPECT_LT(plane.at("error").at("angle_deg").get<double>(), 0.6);
    EXPECT_LT(std::abs(plane.at("error").at("offset_m").get<double>()), 0.02);
  }
  ASSERT_EQ(report.at("objects").size(), sequence_.objects.size());
  EXPECT_EQ(report.at("objects")[0].at("reason"), "own_height");
  EXPECT_EQ(report.at("artefact").at("inputs").size(), 2u);
}

// Odometry that sinks by a millimetre a frame: bodies are seen where they are once poses follow.
TEST_F(SlowRunPlanesTest, PosesAreRefinedWithThePlanes) {
  for (size_t i = 0; i < sequence_.frames.size(); ++i) {
    sequence_.frames[i].world_from_camera.translation.z() -= 1e-3 * static_cast<double>(i);
  }
  WriteSequence(File("sequence"), sequence_, {});
  const auto error_in_last_frames = [&](bool refine_poses) {
    options_.refine_poses = refine_poses;
    Run();
    const Sequence output = ReadSequence(File("output"));
    double sum = 0.0;
    int count = 0;
    for (size_t i = 0; i < output.detections.size(); ++i) {
      const Detection& found = output.detections[i];
      if (2 * found.frame_index < static_cast<int>(output.frames.size())) continue;
      const Plane& exact = sequence_.detections[i].plane_in_camera;
      const Eigen::Vector3d foot = TrueLandmarkInCamera(sequence_, found)->Centre();
      sum += std::abs(found.plane_in_camera.SignedDistance(foot) - exact.SignedDistance(foot));
      ++count;
    }
    return sum / count;
  };
  EXPECT_LT(error_in_last_frames(true), 0.7 * error_in_last_frames(false));
}

TEST_F(SlowRunPlanesTest, SameBytesWithAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {File("output"), File("report")});
}

TEST_F(RunPlanesTest, WhatIsOnAWallIsLeftOutAndCounted) {
  const Detection& first = sequence_.detections.front();
  labels_[sequence_.ObjectOf(first).label]["mount"] = "on_wall";
  WriteTable();
  for (const PlaneSource source : {PlaneSource::kEstimated, PlaneSource::kCameraHeight}) {
    options_.planes = source;
    Run();
    const Sequence output = ReadSequence(File("output"));
    const auto left_out =
        std::ranges::count(sequence_.detections, first.object_index, &Detection::object_index);
    EXPECT_EQ(output.rejected_detections.at("no_support"), left_out);
    EXPECT_EQ(
        std::ranges::count(output.rejected, RejectingStage::kPlanes, &RejectedDetection::stage),
        left_out);
    EXPECT_EQ(output.detections.size() + static_cast<size_t>(left_out),
              sequence_.detections.size());
    EXPECT_EQ(std::ranges::count(output.detections, first.object_index, &Detection::object_index),
              0);
    const json report = ReadArtefact(File("report"), "planes");
    EXPECT_EQ(report.at("objects").at(first.object_index).at("reason"), "none");
  }
}

TEST_F(RunPlanesTest, RefusesObjectsOfWhichNoneIsOnAPlane) {
  for (const Object& object : sequence_.objects) labels_[object.label]["mount"] = "on_wall";
  WriteTable();
  options_.planes = PlaneSource::kCameraHeight;
  ExpectError<NothingUsableError>(
      [&] { Run(); },
      {"sequence.json", fmt::format("none of {} detections", sequence_.detections.size())});
  EXPECT_FALSE(std::filesystem::exists(File("output")));
}

TEST_F(RunPlanesTest, RefusesSettingsThatItCannotFollow) {
  const auto expect_refused = [&](const PlanesOptions& options,
                                  const std::vector<std::string>& words) {
    options_ = options;
    ExpectError<SettingsError>([&] { Run(); }, words);
  };
  PlanesOptions given = options_, verticals = options_;
  given.planes = PlaneSource::kGiven;
  expect_refused(given, {"given", "estimated, where_missing or camera_height"});
  verticals.verticals.are_used = true;
  expect_refused(verticals, {"--dataset", "verticals = false"});
}

TEST_F(RunPlanesTest, WhereMissingKeepsThePlanesThatAreThereAndEstimatesOthers) {
  options_.planes = PlaneSource::kWhereMissing;
  Run();
  const Sequence output = ReadSequence(File("output"));
  ASSERT_EQ(output.planes.size(), sequence_.planes.size());
  for (size_t i = 0; i < output.planes.size(); ++i) {
    EXPECT_EQ(output.planes[i].plane_in_world.Homogeneous(),
              sequence_.planes[i].plane_in_world.Homogeneous());
  }
  const json report = ReadArtefact(File("report"), "planes");
  EXPECT_EQ(report.at("objects").at(0).at("reason"), "given");
  EXPECT_EQ(report.at("settled"), true);
  EXPECT_TRUE(report.at("planes").at(0).at("error").is_null()) << "with themselves";

  WriteSequence(File("sequence"), WithoutPlanes(sequence_), {});
  Run();
  EXPECT_EQ(ReadArtefact(File("report"), "planes").at("objects")[0].at("reason"), "own_height");
}

TEST_F(RunPlanesTest, RefusesSeveralSegments) {
  for (size_t i = 10; i < sequence_.frames.size(); ++i) sequence_.frames[i].segment = 3;
  WriteSequence(File("sequence"), sequence_, {});
  ExpectError<InputError>([&] { Run(); },
                          {"sequence.json", "/frames/10", "segment 3", "one segment"});
  EXPECT_FALSE(std::filesystem::exists(File("output")));
}

// The stage on a room in a world of any up direction and scale.
class RunGroundTest : public FolderTest {
 protected:
  RunGroundTest() {
    options_.ground = GroundSource::kEstimated;
    options_.verticals.are_used = false;  // there are no images
    WriteSequence(files_.at("sequence"), scene_.sequence, {});
    WritePoints(files_.at("points"), scene_.points, {});
  }

  StageFiles files_ = {{"sequence", folder_ / "sequence.json"},
                       {"points", folder_ / "points.h5"},
                       {"table", SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json"},
                       {"output", folder_ / "ground.json"},
                       {"world", folder_ / "world.json"}};
  GroundOptions options_;
  PriorScene scene_ = PriorSceneBuilder(ReadSemanticTable(files_.at("table")), 1, {}).Build();
};

TEST_F(RunGroundTest, WritesTheWorldAndTheSequenceInIt) {
  RunGround(options_, files_, 1);
  const Sequence output = ReadSequence(files_.at("output"), PlaneNeed::kNotNeeded);
  EXPECT_EQ(output.detections.size(), scene_.sequence.detections.size());
  EXPECT_TRUE(output.planes.empty());
  ASSERT_TRUE(output.ground);
  EXPECT_EQ(output.ground->up_in_world, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(output.ground->up_information(2, 2), 0.0, 1e-9);
  EXPECT_GT(output.ground->up_information.trace(), 0.0);
  ASSERT_EQ(output.ground->planes.size(), 2u);
  EXPECT_EQ(output.ground->planes[0].point_in_world.z(), 0.0);
  EXPECT_GT(output.ground->planes[1].point_in_world.z(), 0.2);
  for (const HeightPrior& plane : output.ground->planes) EXPECT_GT(plane.sigma_m, 0.0);
  const json world = ReadArtefact(files_.at("world"), "world");
  EXPECT_EQ(world.at("planes").size(), 2u);
  EXPECT_GT(world.at("up").at("sigma_deg").get<double>(), 0.0);
  const json& scale = world.at("scale");
  EXPECT_LT(scale.at("interval_95")[0].get<double>(), scene_.metres_per_unit);
  EXPECT_GT(scale.at("interval_95")[1].get<double>(), scene_.metres_per_unit);
  EXPECT_THAT(scale.at("found_by"), testing::ElementsAre("objects"));
  EXPECT_GE(scale.at("labels").size(), 3u);
  EXPECT_EQ(world.at("artefact").at("inputs").size(), 3u);
  const double step = (output.frames[1].world_from_camera.translation -
                       output.frames[0].world_from_camera.translation)
                          .norm();
  const double step_in_input = (scene_.sequence.frames[1].world_from_camera.translation -
                                scene_.sequence.frames[0].world_from_camera.translation)
                                   .norm();
  EXPECT_NEAR(step / step_in_input, scale.at("metres_per_unit").get<double>(), 1e-6);
}

TEST_F(RunGroundTest, ResultsDoNotDependOnThreads) {
  ExpectSameBytesForThreads([&](int threads) { RunGround(options_, files_, threads); },
                            {files_.at("world"), files_.at("output")});
}

TEST_F(RunGroundTest, RefusesSeveralSegmentsAndAGivenWorld) {
  scene_.sequence.frames.back().segment = 1;
  WriteSequence(files_.at("sequence"), scene_.sequence, {});
  ExpectError<InputError>([&] { RunGround(options_, files_, 1); }, {"segment 1", "one segment"});
  options_.ground = GroundSource::kGiven;
  ExpectError<SettingsError>([&] { RunGround(options_, files_, 1); },
                             {"ground is given", "expected estimated"});
}

TEST_F(RunGroundTest, SharedPointsNeedMatches) {
  options_.shared_points = true;
  ExpectError<SettingsError>([&] { RunGround(options_, files_, 1); },
                             {"shared_points", "--matches", "soslam-match"});
}

TEST_F(RunGroundTest, ACameraHeightAboveNoPlaneIsNotWhatTheScaleIsFoundBy) {
  options_.scale = scene_.metres_per_unit;
  options_.camera_height_m = 1.5;
  WritePoints(files_.at("points"), {}, {});
  RunGround(options_, files_, 1);
  const json world = ReadArtefact(files_.at("world"), "world");
  EXPECT_THAT(world.at("scale").at("found_by"), testing::ElementsAre("objects", "scale"));
  EXPECT_EQ(world.at("findings")[0].at("check"), "camera_height_unused");
}

}  // namespace
}  // namespace soslam
