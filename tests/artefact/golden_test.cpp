// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "artefact/files.h"
#include "artefact/json_file.h"
#include "artefact/run_file.h"
#include "model/occlusion.h"
#include "support/edited_json.h"
#include "support/folder_test.h"
#include "support/random_estimates.h"

namespace soslam {
// Files of every schema version that was ever released stay readable.
namespace {

const std::filesystem::path kGolden = SOSLAM_SOURCE_DIR "/tests/golden";

TEST(GoldenTest, Version10) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.0.json");
  ASSERT_EQ(sequence.frames.size(), 5u);
  EXPECT_EQ(sequence.frames[4].id, 30);
  EXPECT_EQ(sequence.objects.at(1).id, 4);
  EXPECT_EQ(sequence.detections.size(), 10u);
  EXPECT_EQ(sequence.rejected_detections.at("near_border"), 17);
  // What this version did not have yet.
  EXPECT_EQ(sequence.image_orientation, ImageOrientation::kStored);
  EXPECT_EQ(sequence.objects.at(0).ground_truth->landmark_in_world.shape_exponents, 2.0);
  size_t nearer_boxes = 0;
  for (const Detection& detection : sequence.detections) {
    EXPECT_EQ(detection.is_one_sided, (std::array<bool, 4>{}));
    EXPECT_FALSE(detection.true_landmark_in_camera);
    EXPECT_EQ(detection.nearer_boxes, NearerBoxes(sequence, detection));
    nearer_boxes += detection.nearer_boxes.size();
  }
  EXPECT_GT(nearer_boxes, 0u);
  for (const Frame& frame : sequence.frames) {
    EXPECT_EQ(frame.segment, 0);
    EXPECT_FALSE(frame.camera);
  }
  for (const Object& object : sequence.objects) EXPECT_TRUE(object.is_static);
  EXPECT_EQ(sequence.true_objects.size(), 2u);  // of four objects
  EXPECT_EQ(sequence.detections[0].true_object_id, sequence.ObjectOf(sequence.detections[0]).id);
  EXPECT_EQ(sequence.odometry_world, OdometryWorld::kOfTruth);
  EXPECT_TRUE(sequence.rejected.empty());

  const LandmarkEstimates estimates = ReadLandmarks(kGolden / "landmarks-1.0.json", sequence);
  ASSERT_EQ(estimates.observations.size(), 3u);
  EXPECT_EQ(estimates.observations[0].hypotheses.at(1).cost, 1.0 / 3.0);
  EXPECT_EQ(estimates.objects.at(2).failure, "too_few_views");
  const MapEstimate map = ReadMap(kGolden / "map-1.0.json", sequence);
  EXPECT_EQ(map.world_from_camera.size(), 5u);
  EXPECT_EQ(map.solver.cost_per_iteration.at(1), 1.0 / 7.0);
  EXPECT_EQ(map.solver.detector_bias_px, (std::array<double, 4>{}));  // not in this version yet
  EXPECT_EQ(ReadArtefact(kGolden / "metrics-1.0.json", "metrics").at("objects").size(), 8u);
}

TEST(GoldenTest, Version11) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.1.json");
  EXPECT_EQ(sequence.objects.at(0).ground_truth->landmark_in_world.shape_exponents,
            1.2026355410146854);
  ASSERT_EQ(sequence.detections.size(), 10u);
  EXPECT_EQ(sequence.detections[0].is_one_sided, (std::array<bool, 4>{}));
  EXPECT_EQ(sequence.detections[6].is_one_sided, (std::array<bool, 4>{false, true, true, false}));
  EXPECT_EQ(sequence.detections[9].is_one_sided, (std::array<bool, 4>{true, false, false, true}));

  const LandmarkEstimates estimates = ReadLandmarks(kGolden / "landmarks-1.1.json", sequence);
  EXPECT_EQ(estimates.observations.at(0).hypotheses.at(1).landmark_in_camera.shape_exponents,
            1.807951443160171);
  const MapEstimate map = ReadMap(kGolden / "map-1.1.json", sequence);
  EXPECT_EQ(map.solver.detector_bias_px, (std::array<double, 4>{1.5, -0.25, 1.0 / 3.0, 0.0}));
  const auto metrics = ReadArtefact(kGolden / "metrics-1.1.json", "metrics");
  EXPECT_TRUE(metrics.at("objects").at(2).at("centre_m").is_null());
}

TEST(GoldenTest, SemanticTableOfPeople) {
  const SemanticTable table = ReadSemanticTable(kGolden / "semantic_table-1.0.json");
  const ShapePrior dining_table = table.Find("dining table").value();
  EXPECT_EQ(dining_table.ratio, Eigen::Vector2d(1.16, 2.1));
  EXPECT_EQ(dining_table.log_sigma, Eigen::Vector2d(0.17, 0.14));
  EXPECT_EQ(dining_table.shape_exponents, 1.0);
  EXPECT_EQ(table.Find("cup")->shape_exponents, 1.1);
  // What this version did not have yet.
  EXPECT_EQ(dining_table.log_correlation, 0.0);
  EXPECT_FALSE(dining_table.height_m);
}

// Several recordings, moving objects, frames without images.
TEST(GoldenTest, Sequence12Segments) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.2-segments.json");
  ASSERT_EQ(sequence.frames.size(), 4u);
  EXPECT_EQ(sequence.frames[1].segment, 3);
  EXPECT_EQ(sequence.frames[2].segment, 7);
  EXPECT_EQ(sequence.frames[0].image, "");
  EXPECT_EQ(sequence.frames[2].image, "image_02/0007/000000.png");
  EXPECT_EQ(sequence.CameraOf(sequence.frames[1]).width, 1242);
  EXPECT_EQ(sequence.CameraOf(sequence.frames[2]).width, 1200);
  ASSERT_EQ(sequence.objects.size(), 3u);
  EXPECT_TRUE(sequence.objects[0].is_static);
  EXPECT_FALSE(sequence.objects[1].is_static);
  ASSERT_EQ(sequence.detections.size(), 6u);
  EXPECT_EQ(sequence.detections[3].true_landmark_in_camera->Centre().z(), 12.01);
}

TEST(GoldenTest, Sequence17) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.7.json");
  ASSERT_EQ(sequence.true_objects.size(), 3u);
  EXPECT_EQ(sequence.true_objects[2].segment, 7);
  EXPECT_FALSE(sequence.true_objects[1].is_static);
  ASSERT_EQ(sequence.truth_in_frames.size(), 6u);
  EXPECT_EQ(sequence.truth_in_frames[3].landmark_in_camera.Centre().z(), 12.01);
  ASSERT_EQ(sequence.rejected.size(), 2u);
  EXPECT_EQ(sequence.rejected[0].reason, "near_border");
  EXPECT_FALSE(sequence.rejected[0].true_object_id);
  EXPECT_EQ(sequence.rejected[1].stage, RejectingStage::kAssociate);
  EXPECT_EQ(sequence.rejected[1].frame_index, 2);
  EXPECT_EQ(sequence.rejected[1].true_object_id, 30000);
  EXPECT_EQ(sequence.ignored.at(0).label, "van");
  EXPECT_TRUE(sequence.ignored.at(1).volume_in_world);
  EXPECT_EQ(sequence.odometry_world, OdometryWorld::kOwn);
  EXPECT_EQ(sequence.detections[0].true_object_id, 30000);
}

TEST(GoldenTest, Run14) {
  const RunRecord record = ReadRun(kGolden / "run-1.4.json");
  EXPECT_EQ(record.stage, "soslam-refine");
  EXPECT_EQ(record.software.libraries.at("ceres"), "2.1.0");
  ASSERT_EQ(record.inputs.size(), 5u);
  EXPECT_EQ(record.inputs[0].argument, "edges");
  EXPECT_EQ(record.inputs[0].relative_to, kRelativeToRun);
  EXPECT_EQ(record.inputs[0].path, "../edges-897d07c6c6/edges.h5");
  EXPECT_EQ(record.outputs.at(1).argument, "curves");
  EXPECT_EQ(record.settings->at("asymmetry_cost").origin, "settings file");
  EXPECT_TRUE(record.called_in.empty());  // not in this version yet
}

}  // namespace

// The three JSON artefacts of the model: a file with a mistake is refused.
namespace {

class EditedFileTest : public FolderTest {
 protected:
  const std::filesystem::path file = folder_ / "artefact.json";
  const Sequence sequence = RandomSequence();
};

TEST_F(EditedFileTest, SequencesAreRefused) {
  WriteSequence(file, sequence, {});
  ExpectEditsRefused(
      file,
      {{"/frames/1/colour", "3", "/frames/1"},
       {"/camera/fx", nullptr, "/camera"},
       {"/detections/2/box/1", "\"7\"", "/detections/2/box/1 is \"7\""},
       {"/detections/2/score", "null", "/detections/2/score is null"},
       {"/frames/0/world_from_camera/translation", "[1, 2]",
        "/frames/0/world_from_camera/translation is [1,2]"},
       {"/camera/fx", "0", "/camera/fx is 0"},
       {"/objects/0/ground_truth/landmark/half_axes/2", "-1",
        "/objects/0/ground_truth/landmark/half_axes/2 is -1"},
       {"/objects/0/ground_truth/landmark/shape_exponent", "0.99",
        "/objects/0/ground_truth/landmark/shape_exponent is 0.99"},
       {"/detections/1/bounds", R"(["left", "front"])", "/detections/1/bounds/1 is \"front\""},
       {"/detections/1/bounds", R"(["left", "left"])",
        "/detections/1/bounds is [\"left\",\"left\"]"},
       {"/objects/0/object", "4294967297", "/objects/0/object is 4294967297"},
       {"/frames/0/world_from_camera/rotation_xyzw", "[0, 0, 0, 2]", "norm 2"},
       {"/planes/0/plane_in_world/normal", "[0, 0, 0]", "norm 0"},
       {"/objects/0/plane", "99", "plane 99 is not in the sequence"},
       {"/detections/0/frame", "11", "frame 11 is not in the sequence"},
       {"/frames/1/frame", "10", "frame 10 follows frame 10"},
       {"/detections/1/plane_in_camera", "null",
        "/detections/1/plane_in_camera is null; expected a plane"},
       {"/detections/1/nearer_in_view", "1",
        "/detections/1/nearer_in_view is 1; expected at most the 0 boxes_in_view"},
       {"/detections/3/frame", "10", "/detections/3 is out of order"}},
      [&] { ReadSequence(file); });
}

TEST_F(EditedFileTest, LandmarksAreRefused) {
  WriteLandmarks(file, RandomLandmarkEstimates(), sequence, {});
  ExpectEditsRefused(file,
                     {{"/observations/1/object", "99",
                       "/observations/1: the sequence has no detection of object 99"},
                      {"/objects/0/object", "99", "object 99 is not in the sequence"},
                      {"/objects/0/landmark/shape_exponent", "\"cuboid\"",
                       "/objects/0/landmark/shape_exponent is \"cuboid\""},
                      {"/observations/0/hypotheses/0/landmark/shape_exponent", "2.01",
                       "/observations/0/hypotheses/0/landmark/shape_exponent is 2.01"},
                      {"/objects/0/covariance/4", "[1]", "/objects/0/covariance/4 is [1]"},
                      {"/observations/0/hypotheses/0/landmark/camera_from_object", nullptr,
                       "/observations/0/hypotheses/0/landmark"}},
                     [&] { ReadLandmarks(file, sequence); });
}

TEST_F(EditedFileTest, MapsAreRefused) {
  WriteMap(file, RandomMap(), sequence, {});
  ExpectEditsRefused(
      file,
      {{"/trajectory", "[]", "has 0 rows; expected 5, one per frame"},
       {"/objects/0/landmark/shape_exponent", "3", "/objects/0/landmark/shape_exponent is 3"},
       {"/objects/0/points/1/responsibility", "1.5", "/objects/0/points/1/responsibility is 1.5"},
       {"/trajectory/2/frame", "21", "/trajectory/2/frame is 21; expected 20"},
       {"/solver/iterations", "1.5", "/solver/iterations is 1.5"}},
      [&] { ReadMap(file, sequence); });
}

}  // namespace
}  // namespace soslam
