// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "support/edited_json.h"
#include "support/folder_test.h"
#include "support/random_estimates.h"

namespace soslam {
namespace {

// The three JSON artefacts of the model: a file with a mistake is refused.
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
       {"/detections/2/nearer_in_view", nullptr, "/detections/2"},
       {"/frames/0/world_from_camera/translation", "[1, 2]",
        "/frames/0/world_from_camera/translation is [1,2]"},
       {"/camera/fx", "0", "/camera/fx is 0"},
       {"/image_distortion", "[0.1, 0.2, 0.0, 0.0]", "image_distortion has 4 numbers"},
       {"/objects/0/ground_truth/landmark/half_axes/2", "-1",
        "/objects/0/ground_truth/landmark/half_axes/2 is -1"},
       {"/objects/0/ground_truth/landmark/shape_exponent", "0.99",
        "/objects/0/ground_truth/landmark/shape_exponent is 0.99"},
       {"/detections/1/bounds", R"(["left", "front"])", "/detections/1/bounds/1 is \"front\""},
       {"/detections/1/bounds", R"(["left", "left"])", "/detections/1: bounds has an edge twice"},
       {"/objects/0/object", "4294967297", "/objects/0/object is 4294967297"},
       {"/frames/0/world_from_camera/rotation_xyzw", "[0, 0, 0, 2]",
        "expected a norm of 1, not of 2"},
       {"/planes/0/plane_in_world/normal", "[0, 0, 0]", "expected a norm of 1, not of 0"},
       {"/objects/0/plane", "99", "/objects/0/plane is 99; expected an id of the sequence"},
       {"/detections/0/frame", "11", "/detections/0/frame is 11; expected an id of the sequence"},
       {"/frames/1/frame", "10", "frame 10 follows frame 10"},
       {"/detections/1/plane_in_camera", "null",
        "/detections/1: plane_in_camera contradicts the plane of the object"},
       {"/detections/1/nearer_in_view", "1",
        "/detections/1/nearer_in_view is 1; expected at most the 0 boxes_in_view"},
       {"/detections/3/frame", "10", "/detections/3 is out of order"},
       {"/objects/1/object", "-3", "object -3 follows object -3; expected ascending ids"}},
      [&] { ReadSequence(file); });
}

TEST_F(EditedFileTest, LandmarksAreRefused) {
  WriteLandmarks(file, RandomLandmarkEstimates(), sequence, {});
  ExpectEditsRefused(
      file,
      {{"/observations/1/object", "99",
        "/observations/1/object is 99; expected an id of the sequence"},
       {"/objects/0/object", "99", "/objects/0/object is 99; expected an id of the sequence"},
       {"/objects/1/object", "-3", "/objects/1 is the second row of object -3"},
       {"/observations/1", R"({"frame": 10, "object": -3, "hypotheses": [], "failure": "none"})",
        "/observations/1 is the second row of frame 10, object -3"},
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
      {{"/trajectory", "[]", "has 0 rows; expected 5"},
       {"/objects/0/landmark/shape_exponent", "3", "/objects/0/landmark/shape_exponent is 3"},
       {"/objects/0/points/1/responsibility", "1.5", "/objects/0/points/1/responsibility is 1.5"},
       {"/trajectory/2/frame", "21", "/trajectory/2/frame is 21; expected an id of the sequence"},
       {"/objects/1/object", "-3", "/objects/1 is the second row of object -3"},
       {"/solver/iterations", "1.5", "/solver/iterations is 1.5"}},
      [&] { ReadMap(file, sequence); });
}

}  // namespace
}  // namespace soslam
