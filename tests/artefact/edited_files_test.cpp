// SPDX-License-Identifier: BSD-3-Clause
// The three JSON artefacts of the model: a file with a mistake is refused.
#include <gtest/gtest.h>

#include "artefact/landmarks_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "support/dataset_fixture.h"
#include "support/expect_error.h"
#include "support/random_estimates.h"

namespace soslam {
namespace {

// One change to a valid file, and what the error has to say about it.
struct Edit {
  const char* name;
  const char* place;
  const char* value;  // JSON; nullptr: the place is removed
  const char* message;
};
std::string EditName(const testing::TestParamInfo<Edit>& info) { return info.param.name; }

class EditedFileTest : public testing::TestWithParam<Edit> {
 protected:
  template <typename Read>
  void ExpectRefused(const Read& read) {
    nlohmann::json document = ParseJsonFile(file);
    const nlohmann::json::json_pointer place(GetParam().place);
    if (GetParam().value != nullptr) {
      document[place] = nlohmann::json::parse(GetParam().value);
    } else {
      document[place.parent_pointer()].erase(place.back());
    }
    std::ofstream(file) << document;
    ExpectError<InputError>(read, {"artefact.json: ", GetParam().message});
  }

  const std::filesystem::path file = FreshTestFolder() / "artefact.json";
  const Sequence sequence = RandomSequence();
};

class EditedSequenceTest : public EditedFileTest {};
TEST_P(EditedSequenceTest, IsRefused) {
  WriteSequence(file, sequence, {});
  ExpectRefused([&] { ReadSequence(file); });
}
INSTANTIATE_TEST_SUITE_P(
    Edits, EditedSequenceTest,
    testing::Values(
        Edit{"Unknown", "/frames/1/colour", "3", "/frames/1"},
        Edit{"Missing", "/camera/fx", nullptr, "/camera"},
        Edit{"Text", "/detections/2/box/1", "\"7\"", "/detections/2/box/1 is \"7\""},
        Edit{"Null", "/detections/2/score", "null", "/detections/2/score is null"},
        Edit{"Short", "/frames/0/world_from_camera/translation", "[1, 2]",
             "/frames/0/world_from_camera/translation is [1,2]"},
        Edit{"FocalLength", "/camera/fx", "0", "/camera/fx is 0"},
        Edit{"HalfAxis", "/objects/0/ground_truth/landmark/half_axes/2", "-1",
             "/objects/0/ground_truth/landmark/half_axes/2 is -1"},
        Edit{"ShapeExponentLow", "/objects/0/ground_truth/landmark/shape_exponent", "0.99",
             "/objects/0/ground_truth/landmark/shape_exponent is 0.99"},
        Edit{"BoundUnknown", "/detections/1/bounds", R"(["left", "front"])",
             "/detections/1/bounds/1 is \"front\""},
        Edit{"BoundTwice", "/detections/1/bounds", R"(["left", "left"])",
             "/detections/1/bounds is [\"left\",\"left\"]"},
        Edit{"IdTooLarge", "/objects/0/object", "4294967297", "/objects/0/object is 4294967297"},
        Edit{"Quaternion", "/frames/0/world_from_camera/rotation_xyzw", "[0, 0, 0, 2]", "norm 2"},
        Edit{"Normal", "/planes/0/plane_in_world/normal", "[0, 0, 0]", "norm 0"},
        Edit{"PlaneUnknown", "/objects/0/plane", "99", "plane 99 is not in the sequence"},
        Edit{"FrameUnknown", "/detections/0/frame", "11", "frame 11 is not in the sequence"},
        Edit{"FrameTwice", "/frames/1/frame", "10", "frame 10 follows frame 10"},
        Edit{"Order", "/detections/3/frame", "10", "/detections/3 is out of order"}),
    EditName);

class EditedLandmarksTest : public EditedFileTest {};
TEST_P(EditedLandmarksTest, IsRefused) {
  WriteLandmarks(file, RandomLandmarkEstimates(), sequence, {});
  ExpectRefused([&] { ReadLandmarks(file, sequence); });
}
INSTANTIATE_TEST_SUITE_P(
    Edits, EditedLandmarksTest,
    testing::Values(
        Edit{"DetectionUnknown", "/observations/1/object", "99",
             "/observations/1: the sequence has no detection of object 99"},
        Edit{"ObjectUnknown", "/objects/0/object", "99", "object 99 is not in the sequence"},
        Edit{"ShapeExponentText", "/objects/0/landmark/shape_exponent", "\"cuboid\"",
             "/objects/0/landmark/shape_exponent is \"cuboid\""},
        Edit{"ShapeExponentHigh", "/observations/0/hypotheses/0/landmark/shape_exponent", "2.01",
             "/observations/0/hypotheses/0/landmark/shape_exponent is 2.01"},
        Edit{"CovarianceRow", "/objects/0/covariance/4", "[1]", "/objects/0/covariance/4 is [1]"},
        Edit{"WrongFrameOfReference", "/observations/0/hypotheses/0/landmark/camera_from_object",
             nullptr, "/observations/0/hypotheses/0/landmark"}),
    EditName);

class EditedMapTest : public EditedFileTest {};
TEST_P(EditedMapTest, IsRefused) {
  WriteMap(file, RandomMap(), sequence, {});
  ExpectRefused([&] { ReadMap(file, sequence); });
}
INSTANTIATE_TEST_SUITE_P(
    Edits, EditedMapTest,
    testing::Values(Edit{"PoseMissing", "/trajectory", "[]", "has 0 poses; expected 5"},
                    Edit{"ShapeExponent", "/objects/0/landmark/shape_exponent", "3",
                         "/objects/0/landmark/shape_exponent is 3"},
                    Edit{"OtherFrame", "/trajectory/2/frame", "21",
                         "/trajectory/2/frame is 21; expected 20"},
                    Edit{"Iterations", "/solver/iterations", "1.5", "/solver/iterations is 1.5"}),
    EditName);

}  // namespace
}  // namespace soslam
