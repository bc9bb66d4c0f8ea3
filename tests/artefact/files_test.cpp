// SPDX-License-Identifier: BSD-3-Clause
// The three JSON artefacts of the model: what is written is read back bit for bit.
#include "soslam/artefact/files.h"

#include <gtest/gtest.h>

#include <limits>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/model/occlusion.h"
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

// No planes, or planes of which it is not known which objects stand on them.
TEST_F(ArtefactFilesTest, UnknownSupportsComeBackToThoseWhoNeedNone) {
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  for (const char* words : {"\"associate\"", "no support planes"}) {
    WriteSequence(file, sequence, {});
    const Sequence read = ReadSequence(file, PlaneNeed::kNotNeeded);
    EXPECT_EQ(read.planes.size(), sequence.planes.size());
    EXPECT_EQ(read.objects.at(0).plane_index, kNoPlane);
    EXPECT_FALSE(read.HasSupports());
    ExpectError<InputError>([&] { ReadSequence(file); }, {file.string(), words});
    sequence.planes.clear();
  }
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

TEST_F(ArtefactFilesTest, MapsSayHowProbableAFrontIs) {
  MapEstimate map = RandomMap();
  map.objects[0].front_probability = kKnownFrontProbability;
  map.objects[1].front_probability = 0.5;
  WriteMap(file, map, sequence, {});
  const nlohmann::json rows = nlohmann::json::parse(FileBytes(file)).at("objects");
  EXPECT_EQ(rows[0].at("front_probability"), 0.9);
  EXPECT_EQ(rows[0].at("front_is_known"), true);
  EXPECT_EQ(rows[1].at("front_is_known"), false);
  for (const char* field : {"front_probability", "front_is_known"}) {
    EXPECT_FALSE(rows[2].contains(field)) << field;
  }
  WriteMap(again, ReadMap(file, sequence), sequence, {});
  EXPECT_EQ(FileBytes(file), FileBytes(again));
  ExpectEditsRefused(file, {{"/objects/0/front_probability", "1.5", "expected"}},
                     [&] { ReadMap(file, sequence); });
}

TEST_F(ArtefactFilesTest, WhatASequenceMayHaveComesBack) {
  ListBoxesInView(sequence, &sequence);
  sequence.detections[1].own_in_view = 0;
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
  for (size_t i = 0; i < read.detections.size(); ++i) {
    EXPECT_EQ(BoxesInFront(read, read.detections[i]),
              BoxesInFront(sequence, sequence.detections[i]));
  }
}

TEST_F(ArtefactFilesTest, RowsOfRejectedDetectionsAreChecked) {
  sequence.rejected = {{0, "cup", 0.5, {1, 2, 3, 4}, {}, RejectingStage::kImport, "low_box"}};
  WriteSequence(file, sequence, {});
  ExpectEditsRefused(file,
                     {{"/rejected/rows/0/0", "99999", "/rejected/rows/0/0 is 99999"},
                      {"/rejected/rows/0/1", "1", "/rejected: row 0 has reason 1"},
                      {"/rejected/rows/0/2", "7", "and label 7; expected less than"}},
                     [&] { ReadSequence(file); });
}

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

TEST_F(ArtefactFilesTest, NonFiniteNumbersAreRefusedWithTheirPlace) {
  MapEstimate map = RandomMap();
  (*map.objects[0].covariance)(3, 1) = kNan;
  ExpectError<NumericalError>([&] { WriteMap(file, map, sequence, {}); },
                              {"artefact.json: /objects/0/covariance/3/1 would be nan"});
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace soslam
