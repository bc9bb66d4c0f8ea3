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
  const char* place;
  const char* value;  // JSON; nullptr: the place is removed
  const char* message;
};

void PrintTo(const Edit& edit, std::ostream* stream) { *stream << edit.place; }

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
const std::vector<Edit> kEditedSequenceCases = {
    {"/frames/1/colour", "3", "/frames/1"},
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
    {"/detections/1/bounds", R"(["left", "left"])", "/detections/1/bounds is [\"left\",\"left\"]"},
    {"/objects/0/object", "4294967297", "/objects/0/object is 4294967297"},
    {"/frames/0/world_from_camera/rotation_xyzw", "[0, 0, 0, 2]", "norm 2"},
    {"/planes/0/plane_in_world/normal", "[0, 0, 0]", "norm 0"},
    {"/objects/0/plane", "99", "plane 99 is not in the sequence"},
    {"/detections/0/frame", "11", "frame 11 is not in the sequence"},
    {"/frames/1/frame", "10", "frame 10 follows frame 10"},
    {"/detections/3/frame", "10", "/detections/3 is out of order"}};
INSTANTIATE_TEST_SUITE_P(Edits, EditedSequenceTest, testing::ValuesIn(kEditedSequenceCases));

class EditedLandmarksTest : public EditedFileTest {};
TEST_P(EditedLandmarksTest, IsRefused) {
  WriteLandmarks(file, RandomLandmarkEstimates(), sequence, {});
  ExpectRefused([&] { ReadLandmarks(file, sequence); });
}
const std::vector<Edit> kEditedLandmarksCases = {
    {"/observations/1/object", "99", "/observations/1: the sequence has no detection of object 99"},
    {"/objects/0/object", "99", "object 99 is not in the sequence"},
    {"/objects/0/landmark/shape_exponent", "\"cuboid\"",
     "/objects/0/landmark/shape_exponent is \"cuboid\""},
    {"/observations/0/hypotheses/0/landmark/shape_exponent", "2.01",
     "/observations/0/hypotheses/0/landmark/shape_exponent is 2.01"},
    {"/objects/0/covariance/4", "[1]", "/objects/0/covariance/4 is [1]"},
    {"/observations/0/hypotheses/0/landmark/camera_from_object", nullptr,
     "/observations/0/hypotheses/0/landmark"}};
INSTANTIATE_TEST_SUITE_P(Edits, EditedLandmarksTest, testing::ValuesIn(kEditedLandmarksCases));

class EditedMapTest : public EditedFileTest {};
TEST_P(EditedMapTest, IsRefused) {
  WriteMap(file, RandomMap(), sequence, {});
  ExpectRefused([&] { ReadMap(file, sequence); });
}
const std::vector<Edit> kEditedMapCases = {
    {"/trajectory", "[]", "has 0 poses; expected 5"},
    {"/objects/0/landmark/shape_exponent", "3", "/objects/0/landmark/shape_exponent is 3"},
    {"/trajectory/2/frame", "21", "/trajectory/2/frame is 21; expected 20"},
    {"/solver/iterations", "1.5", "/solver/iterations is 1.5"}};
INSTANTIATE_TEST_SUITE_P(Edits, EditedMapTest, testing::ValuesIn(kEditedMapCases));

}  // namespace
}  // namespace soslam
