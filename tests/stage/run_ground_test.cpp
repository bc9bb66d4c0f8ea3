// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "artefact/json_file.h"
#include "artefact/points_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "stage/stages.h"
#include "support/expect_error.h"
#include "support/prior_scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

// The stage on a room in a world of any up direction and scale.
class RunGroundTest : public testing::Test {
 protected:
  RunGroundTest() {
    options_.ground = GroundSource::kEstimated;
    options_.verticals = false;  // there are no images
    WriteSequence(files_.at("sequence"), scene_.sequence, {});
    WritePoints(files_.at("points"), scene_.points, {});
  }

  TemporaryFolder folder_;
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
  ASSERT_EQ(output.planes.size(), 2u);
  for (const SupportPlane& plane : output.planes) {
    ASSERT_TRUE(plane.attitude_information && plane.height_prior);
    EXPECT_NEAR(plane.plane_in_world.SignedDistance(plane.height_prior->point_in_world), 0.0, 1e-9);
    EXPECT_GT(plane.height_prior->sigma_m, 0.0);
    const Eigen::Vector3d& normal = plane.plane_in_world.normal;
    EXPECT_NEAR(normal.dot(*plane.attitude_information * normal), 0.0, 1e-9);
    EXPECT_GT(plane.attitude_information->trace(), 0.0);
  }
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
  RunGround(options_, files_, 1);
  const std::string world = FileBytes(files_.at("world"));
  const std::string output = FileBytes(files_.at("output"));
  RunGround(options_, files_, 3);
  EXPECT_EQ(FileBytes(files_.at("world")), world);
  EXPECT_EQ(FileBytes(files_.at("output")), output);
}

TEST_F(RunGroundTest, RefusesSeveralSegments) {
  scene_.sequence.frames.back().segment = 1;
  WriteSequence(files_.at("sequence"), scene_.sequence, {});
  ExpectError<InputError>([&] { RunGround(options_, files_, 1); }, {"segment 1", "one segment"});
}

TEST_F(RunGroundTest, RefusesAGivenWorld) {
  options_.ground = GroundSource::kGiven;
  ExpectError<SettingsError>([&] { RunGround(options_, files_, 1); },
                             {"ground is given", "expected estimated"});
}

TEST_F(RunGroundTest, ACameraHeightAboveNoPlaneIsNotWhatTheScaleIsFoundBy) {
  options_.scale = 1.0;
  options_.camera_height_m = 1.5;
  WritePoints(files_.at("points"), {}, {});
  RunGround(options_, files_, 1);
  const json world = ReadArtefact(files_.at("world"), "world");
  EXPECT_THAT(world.at("scale").at("found_by"), testing::ElementsAre("scale"));
  EXPECT_EQ(world.at("findings")[0].at("check"), "camera_height_unused");
}

TEST_F(RunGroundTest, FindingsAreInTheArtefact) {
  for (Object& object : scene_.sequence.objects) object.label = "thing";
  WriteSequence(files_.at("sequence"), scene_.sequence, {});
  RunGround(options_, files_, 1);
  const json world = ReadArtefact(files_.at("world"), "world");
  EXPECT_TRUE(world.at("scale").is_null());
  EXPECT_EQ(world.at("findings")[0].at("check"), "scale_unknown");
}

}  // namespace
}  // namespace soslam
