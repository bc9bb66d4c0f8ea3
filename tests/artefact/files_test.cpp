// SPDX-License-Identifier: BSD-3-Clause
// The three JSON artefacts of the model: what is written is read back bit for bit.
#include "artefact/files.h"

#include <gtest/gtest.h>

#include <limits>

#include "artefact/model_json.h"
#include "base/error.h"
#include "model/occlusion.h"
#include "support/edited_json.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/random_estimates.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class ArtefactFilesTest : public FolderTest {
 protected:
  std::filesystem::path file = folder_ / "artefact.json";
  std::filesystem::path again = folder_ / "again.json";
  Sequence sequence = RandomSequence();
};

TEST_F(ArtefactFilesTest, SequenceWithoutPlanesComesBackToThoseWhoNeedNone) {
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  WriteSequence(file, sequence, {});
  const Sequence read = ReadSequence(file, PlaneNeed::kNotNeeded);
  EXPECT_TRUE(read.planes.empty());
  EXPECT_EQ(read.objects.at(0).plane_index, kNoPlane);
  EXPECT_EQ(read.detections.size(), sequence.detections.size());
  ExpectError<InputError>([&] { ReadSequence(file); }, {file.string(), "no support planes"});
}

// Planes are there, but it is not known which of them objects stand on.
TEST_F(ArtefactFilesTest, UnknownSupportsComeBackToThoseWhoNeedNone) {
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  WriteSequence(file, sequence, {});
  const Sequence read = ReadSequence(file, PlaneNeed::kNotNeeded);
  EXPECT_EQ(read.planes.size(), sequence.planes.size());
  EXPECT_EQ(read.objects.at(0).plane_index, kNoPlane);
  EXPECT_FALSE(read.HasSupports());
  ExpectError<InputError>([&] { ReadSequence(file); }, {file.string(), "\"associate\""});
}

TEST_F(ArtefactFilesTest, MapsSayWhatAnObjectMayBe) {
  const MapEstimate map = RandomMap();
  const auto index = static_cast<size_t>(map.objects.front().object_index);
  sequence.objects[index].labels = {{"chair", 0.75}, {"armchair", 0.25}};
  WriteMap(file, map, sequence, {});
  const nlohmann::json row = nlohmann::json::parse(FileBytes(file)).at("objects").at(0);
  EXPECT_EQ(row.at("labels"), nlohmann::json::parse(R"([{"label": "chair", "probability": 0.75},
                                              {"label": "armchair", "probability": 0.25}])"));
  EXPECT_EQ(ReadMap(file, sequence).objects.size(), map.objects.size());
}

TEST_F(ArtefactFilesTest, PlanesAreKnownForAllOrNone) {
  WriteSequence(file, sequence, {});
  ExpectEditsRefused(file,
                     {{"/detections/1/plane_in_camera", "null",
                       "/detections/1/plane_in_camera is null; expected a plane"}},
                     [&] { ReadSequence(file); });
}

TEST_F(ArtefactFilesTest, WhatASequenceMayHaveComesBack) {
  const GroundTruth truth{RandomLandmarkInCamera(), false, true, true};
  HeldOutFrame held_out{sequence.frames.back(), {{"cup", 0.7, {10.5, 20.0, 30.0, 40.25}}}};
  held_out.frame.id = sequence.frames.back().id + 1;
  sequence.held_out = {held_out};
  sequence.objects[0].labels = {{"chair", 0.75}, {"armchair", 0.25}};
  sequence.image_distortion = Distortion{0.1, -0.2, 0.003, -0.004, 0.5, 0.25};
  sequence.image_orientation = ImageOrientation::kStored;
  sequence.true_objects = {{-3, "cup", truth, 0, true, true}, {7, "car", truth, 2, false, false}};
  sequence.ignored = {{"mouse", std::nullopt}, {std::nullopt, RandomLandmarkInCamera()}};
  sequence.odometry_world = OdometryWorld::kOwnWithScale;
  sequence.detections[0].true_object_id = 7;
  sequence.truth_in_frames = {{1, 7, RandomLandmarkInCamera()}};
  sequence.rejected = {
      {1, "cup", 0.25, {1, 2, 3, 4.5}, -3, RejectingStage::kImport, "near_border"},
      {0, "bed", 0.5, {1, 2, 3, 4}, std::nullopt, RejectingStage::kAssociate, "near_border"},
      {0, "cup", 0.5, {9, 2, 10, 4}, std::nullopt, RejectingStage::kPlanes, "no_support"}};
  sequence.findings = {{"a", Severity::kWarning, "found \u00fc", "expected", "cause", "remedy"},
                       {"b", Severity::kError, "2 of 3", "all", "", "none"}};
  WriteSequence(file, sequence, {});
  const Sequence read = ReadSequence(file);
  WriteSequence(again, read, {});
  EXPECT_EQ(FileBytes(file), FileBytes(again));
  EXPECT_EQ(read.findings, sequence.findings);
}

TEST_F(ArtefactFilesTest, RowsOfRejectedDetectionsAreChecked) {
  sequence.rejected = {{0, "cup", 0.5, {1, 2, 3, 4}, {}, RejectingStage::kImport, "low_box"}};
  WriteSequence(file, sequence, {});
  ExpectEditsRefused(file,
                     {{"/rejected/rows/0/0", "99999", "frame 99999"},
                      {"/rejected/rows/0/1", "1", "/rejected/rows/0/1 is 1; expected less than 1"},
                      {"/rejected/rows/0/2", "7", "/rejected/rows/0/2 is 7"}},
                     [&] { ReadSequence(file); });
}

TEST_F(ArtefactFilesTest, BeforeVersion17ObjectsSaidWhatIsTrue) {
  WriteSequence(file, sequence, {});
  nlohmann::json edited = ParseJsonFile(file);
  edited.erase("true_objects");
  edited.erase("odometry_world");
  std::ofstream(file) << edited;
  const Sequence read = ReadSequence(file);
  size_t with_truth = 0;
  for (const Object& object : sequence.objects) with_truth += object.ground_truth ? 1 : 0;
  ASSERT_GT(with_truth, 0u);
  EXPECT_EQ(read.true_objects.size(), with_truth);
  EXPECT_EQ(read.odometry_world, OdometryWorld::kOfTruth);
}

// Files of older versions have values that the golden tests compare one by one.
TEST_F(ArtefactFilesTest, WhatIsReadIsWrittenAgainBitForBit) {
  const auto expect_same = [&] { EXPECT_EQ(FileBytes(file), FileBytes(again)); };
  WriteSequence(file, sequence, {});
  WriteSequence(again, ReadSequence(file), {});
  expect_same();
  LandmarkEstimates estimates = RandomLandmarkEstimates();
  // The range of shape exponents includes its ends.
  std::vector<Hypothesis>& hypotheses = estimates.observations[0].hypotheses;
  hypotheses.at(0).landmark_in_camera.shape_exponents = kCuboidExponent;
  hypotheses.at(1).landmark_in_camera.shape_exponents = {kEllipsoidExponent, kCuboidExponent};
  WriteLandmarks(file, estimates, sequence, {});
  WriteLandmarks(again, ReadLandmarks(file, sequence), sequence, {});
  expect_same();
  EXPECT_EQ(ParseJsonFile(file).at("failures").dump(),
            R"({"plane_behind_camera":1,"too_few_views":1})");
  WriteMap(file, RandomMap(), sequence, {});
  WriteMap(again, ReadMap(file, sequence), sequence, {});
  expect_same();
}

TEST_F(ArtefactFilesTest, WhatIsNearerComesBack) {
  ListBoxesInView(sequence, &sequence);
  sequence.detections[1].own_in_view = 0;
  sequence.detections[2].nearer_boxes = {{1.0, 2.0, 3.0, 4.0}};  // of an older file
  WriteSequence(file, sequence, {});
  const Sequence read = ReadSequence(file);
  size_t boxes = 0;
  for (size_t i = 0; i < read.detections.size(); ++i) {
    const auto nearer = BoxesInFront(read, read.detections[i]);
    EXPECT_EQ(nearer, BoxesInFront(sequence, sequence.detections[i]));
    boxes += nearer.size();
  }
  EXPECT_GT(boxes, 1u);
}

TEST_F(ArtefactFilesTest, RefusesMoreNearerBoxesThanAreInView) {
  sequence.detections[1].nearer_in_view = 1;
  WriteSequence(file, sequence, {});
  ExpectError<InputError>([&] { ReadSequence(file); },
                          {"/detections/1/nearer_in_view is 1", "at most the 0 boxes_in_view"});
}

TEST_F(ArtefactFilesTest, WithoutNearerBoxesTheyAreThoseOfTheSequencesOwnDetections) {
  WriteSequence(file, sequence, {});
  nlohmann::json document = ParseJsonFile(file);
  for (auto& detection : document["detections"]) {
    detection.erase("nearer_boxes");
    detection.erase("nearer_in_view");
  }
  std::ofstream(file) << document;
  size_t boxes = 0;
  for (const Detection& detection : ReadSequence(file).detections) {
    EXPECT_EQ(detection.nearer_boxes, NearerBoxes(sequence, detection));
    boxes += detection.nearer_boxes.size();
  }
  EXPECT_GT(boxes, 0u);
}

TEST_F(ArtefactFilesTest, NonFiniteNumbersAreRefusedWithTheirPlace) {
  MapEstimate map = RandomMap();
  (*map.objects[0].covariance)(3, 1) = kNan;
  ExpectError<NumericalError>([&] { WriteMap(file, map, sequence, {}); },
                              {"artefact.json: /objects/0/covariance/3/1 would be nan"});
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace soslam
