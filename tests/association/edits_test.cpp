// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/edits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "support/association_scenes.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

// Three objects apart from each other, whose boxes are exact; what is seen of them has no ids.
class EditsTest : public testing::Test {
 protected:
  EditsTest() {
    for (size_t i = 0; i < seen_.frames.size(); ++i) {
      seen_.frames[i].image = fmt::format("rgb/{:03}.png", i);
    }
  }

  static BoxAnchor AnchorOf(const Sequence& sequence, int detection) {
    const Detection& of = sequence.detections[detection];
    return {sequence.FrameOf(of).image, of.box};
  }
  // An edit of some boxes (indices of detections).
  Edit Of(EditKind kind, const std::vector<int>& boxes) const {
    Edit edit{kind, {}};
    for (const int box : boxes) edit.boxes.push_back(AnchorOf(seen_, box));
    return edit;
  }
  Edit Rename(int box, const std::string& label) const {
    Edit edit = Of(EditKind::kRename, {box});
    edit.label = label;
    return edit;
  }
  Edit Size(int box, const KnownSize& size) const {
    Edit edit = Of(EditKind::kSize, {box});
    edit.size = size;
    return edit;
  }
  std::set<int> BoxesOf(size_t object) const {
    return {of_objects_[object].begin(), of_objects_[object].end()};
  }
  int Box(size_t object, size_t i) const { return of_objects_[object][i]; }

  Association Run(const std::vector<Edit>& edits) const {
    return Associate(seen_, table_, PairEvidence(), EstimatedAssociation(), 2,
                     {"", edits, "edits.json"});
  }
  static const Track& TrackOf(const Association& association, int box) {
    return association.tracks[association.detections[box].track];
  }
  // Expects that edits are refused with these words.
  void ExpectRefused(const std::vector<Edit>& edits, std::vector<std::string> words) const {
    words.push_back("edits.json: /edits/");
    ExpectError<InputError>([&] { Run(edits); }, words);
  }

  Sequence given_ = SyntheticSequence(LabelledScene(7, 3, 12, {"thing"}), false);
  Sequence seen_ = WithoutIds(given_);
  SemanticTable table_ = UnknowingTable();
  std::vector<std::vector<int>> of_objects_ = DetectionsByObject(given_);
};

TEST_F(EditsTest, TheObjectsOfTheSceneAreFoundWithoutAny) {
  const Association association = Run({});
  ASSERT_EQ(association.objects.size(), 3u);
  for (size_t object = 0; object < 3; ++object) {
    EXPECT_THAT(TrackOf(association, Box(object, 0)).boxes, ElementsAreArray(BoxesOf(object)));
    EXPECT_FALSE(TrackOf(association, Box(object, 0)).by_hand);
  }
}

TEST_F(EditsTest, DeletedObjectsAreNone) {
  const Association association = Run({Of(EditKind::kDelete, {Box(1, 3)})});
  EXPECT_EQ(association.objects.size(), 2u);
  EXPECT_EQ(TrackOf(association, Box(1, 0)).fate, TrackFate::kDeleted);
  const Sequence sequence =
      AssociatedSequence(seen_, association, CompareWithGiven(seen_, association, 3));
  EXPECT_EQ(sequence.rejected_detections.at("deleted"), static_cast<int>(BoxesOf(1).size()));
}

TEST_F(EditsTest, DeletedBoxesLeaveTheRestOfTheirObject) {
  const Association association = Run({Of(EditKind::kDeleteBoxes, {Box(1, 3), Box(1, 4)})});
  EXPECT_EQ(association.objects.size(), 3u);
  std::set<int> rest = BoxesOf(1);
  for (const size_t i : {3, 4}) {
    EXPECT_EQ(association.detections[Box(1, i)].fate, BoxFate::kDeleted);
    EXPECT_EQ(association.detections[Box(1, i)].track, -1);
    rest.erase(Box(1, i));
  }
  EXPECT_THAT(TrackOf(association, Box(1, 0)).boxes, ElementsAreArray(rest));
  const Sequence sequence =
      AssociatedSequence(seen_, association, CompareWithGiven(seen_, association, 3));
  EXPECT_EQ(sequence.rejected_detections.at("deleted"), 2);
}

TEST_F(EditsTest, BoxesThatAreSplitOffAreAnObjectHoweverFew) {
  const Association association = Run({Of(EditKind::kSplit, {Box(1, 3)})});
  EXPECT_EQ(association.objects.size(), 4u);
  EXPECT_THAT(TrackOf(association, Box(1, 3)).boxes, ElementsAre(Box(1, 3)));
  EXPECT_EQ(TrackOf(association, Box(1, 3)).fate, TrackFate::kObject);
  std::set<int> rest = BoxesOf(1);
  rest.erase(Box(1, 3));
  EXPECT_THAT(TrackOf(association, Box(1, 0)).boxes, ElementsAreArray(rest));
}

// What a split leaves is dropped where it has too few boxes for an object.
TEST_F(EditsTest, FewBoxesThatASplitLeavesAreNoObject) {
  std::set<int> rest = BoxesOf(1);
  const std::vector<int> split(std::next(rest.begin(), 2), rest.end());
  rest.erase(std::next(rest.begin(), 2), rest.end());
  const Association association = Run({Of(EditKind::kSplit, split)});
  EXPECT_THAT(TrackOf(association, *rest.begin()).boxes, ElementsAreArray(rest));
  EXPECT_EQ(TrackOf(association, *rest.begin()).fate, TrackFate::kTooFewDetections);
  EXPECT_THAT(TrackOf(association, split.front()).boxes, ElementsAreArray(split));
  EXPECT_EQ(association.objects.size(), 3u);
}

// Two things are one, which no body explains: boxes stay nevertheless, one in each frame.
TEST_F(EditsTest, JoinedObjectsAreOneWhetherOrNotABodyExplainsThem) {
  const Association association = Run({Of(EditKind::kJoin, {Box(0, 0), Box(1, 0)})});
  EXPECT_EQ(association.objects.size(), 2u);
  const Track& track = TrackOf(association, Box(0, 0));
  std::set<int> all = BoxesOf(0), frames;
  all.merge(BoxesOf(1));
  EXPECT_THAT(track.boxes, ElementsAreArray(all));
  for (const int box : all) {
    frames.insert(seen_.detections[box].frame_index);
    const BoxFate fate = association.detections[box].fate;
    EXPECT_TRUE(fate == BoxFate::kExplained || fate == BoxFate::kByHand || fate == BoxFate::kSecond)
        << NameOf(fate);
  }
  EXPECT_EQ(track.detections.size(), frames.size());
}

// The box that a join names is used; in other frames, boxes that the body explains come first.
TEST_F(EditsTest, AJoinUsesTheBoxesThatItNames) {
  const Association association =
      Run({Of(EditKind::kJoin, {Box(0, 0), Box(0, 1), Box(0, 2), Box(1, 5)})});
  for (const int box : {Box(0, 0), Box(0, 1), Box(0, 2), Box(1, 5)}) {
    const BoxFate fate = association.detections[box].fate;
    EXPECT_TRUE(fate == BoxFate::kExplained || fate == BoxFate::kByHand) << NameOf(fate);
  }
}

// A size says nothing of which boxes are of the object: no body of this height explains them.
TEST_F(EditsTest, ASizeHoldsNoBoxes) {
  const Association association = Run({Size(Box(1, 0), {{}, {}, 50.0})});
  for (const int box : BoxesOf(1)) {
    EXPECT_NE(association.detections[box].fate, BoxFate::kByHand);
    EXPECT_NE(association.detections[box].fate, BoxFate::kExplained);
  }
  EXPECT_EQ(TrackOf(association, Box(1, 0)).fate, TrackFate::kNoLandmark);
}

TEST_F(EditsTest, ASplitAndAJoinMoveABoxToAnotherObject) {
  const std::vector<Edit> edits = {Of(EditKind::kJoin, {Box(1, 3), Box(0, 0)}),
                                   Of(EditKind::kSplit, {Box(1, 3)})};
  const Association association = Run(edits);
  std::set<int> both = BoxesOf(0);
  both.insert(Box(1, 3));
  EXPECT_THAT(TrackOf(association, Box(1, 3)).boxes, ElementsAreArray(both));
  EXPECT_EQ(association.objects.size(), 3u);
  const Association reversed = Run({edits[1], edits[0]});
  EXPECT_EQ(TrackOf(reversed, Box(1, 3)).boxes, TrackOf(association, Box(1, 3)).boxes);
}

TEST_F(EditsTest, RenamedObjectsHaveTheLabelAndItsPrior) {
  table_.priors["chest"] = {{2.0, 1.5}, {0.2, 0.2}, 1.2};
  const Association association = Run({Rename(Box(2, 1), "chest")});
  const Track& track = TrackOf(association, Box(2, 0));
  EXPECT_EQ(LabelOf(track), "chest");
  EXPECT_EQ(track.fit->landmark_in_world.shape_exponents, ShapeExponents(1.2));
  EXPECT_EQ(track.detections.size(), BoxesOf(2).size());
  const Sequence sequence =
      AssociatedSequence(seen_, association, CompareWithGiven(seen_, association, 3));
  const auto chest = std::ranges::find(sequence.objects, "chest", &Object::label);
  ASSERT_NE(chest, sequence.objects.end());
  EXPECT_THAT(chest->labels, testing::SizeIs(1));
}

// No floor holds what is on a wall.
TEST_F(EditsTest, AnObjectWhoseNewLabelNoBodyFitsIsSaid) {
  for (Object& object : seen_.objects) object.plane_index = kNoPlane;
  table_.priors["poster"] = {{2.0, 1.5}, {0.2, 0.2}};
  table_.priors["poster"].mount = Mount::kOnWall;
  EXPECT_THAT(CheckEdits(seen_, Run({})), testing::IsEmpty());
  const Association association = Run({Rename(Box(2, 1), "poster")});
  EXPECT_EQ(TrackOf(association, Box(2, 0)).fate, TrackFate::kNoLandmark);
  const std::vector<Finding> findings = CheckEdits(seen_, association);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings.front().check, "edits_without_body");
  EXPECT_THAT(findings.front().found, testing::HasSubstr(seen_.frames[0].image));
}

// One box and a plane say where an object is; its size makes it a body without any ratio.
TEST_F(EditsTest, AKnownSizeIsThatOfTheBodyAndOfTheSequence) {
  const Eigen::Vector3d half_axes = given_.objects[1].ground_truth->landmark_in_world.half_axes;
  const KnownSize size{2.0 * half_axes.x(), 2.0 * half_axes.y(), 2.0 * half_axes.z()};
  const Association association = Run({Of(EditKind::kSplit, {Box(1, 3)}), Size(Box(1, 3), size)});
  const Track& track = TrackOf(association, Box(1, 3));
  ASSERT_TRUE(track.fit);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(track.fit->landmark_in_world.half_axes[axis] / half_axes[axis], 1.0, 0.05) << axis;
  }
  const Sequence sequence =
      AssociatedSequence(seen_, association, CompareWithGiven(seen_, association, 3));
  const auto sized = std::ranges::find_if(
      sequence.objects, [](const Object& object) { return object.known_size.Any(); });
  ASSERT_NE(sized, sequence.objects.end());
  EXPECT_EQ(sized->known_size.width_m, size.width_m);
}

TEST_F(EditsTest, TheNearestOfSeveralBoxesIsMeant) {
  seen_.detections[Box(1, 3)].box = {100.0, 100.0, 200.0, 200.0};
  const std::vector<DetectionDecision> decisions(seen_.detections.size());
  Edits edits{"", {Of(EditKind::kDelete, {Box(1, 3)})}, "edits.json"};
  edits.edits[0].boxes[0].box = {101.0, 99.0, 202.0, 200.0};
  edits.edits[0].boxes[0].image = "003.png";  // without its folder
  ASSERT_EQ(seen_.detections[Box(1, 3)].frame_index, 3);
  EXPECT_THAT(FindBoxes(edits, seen_, decisions).boxes, ElementsAre(ElementsAre(Box(1, 3))));
}

TEST_F(EditsTest, DuplicatesStandForTheBoxThatTheyRepeat) {
  const int box = Box(1, 3);
  AddFalseDetection(3, seen_.detections[box].box, "thing", &seen_);
  seen_.detections.back().score = 0.5;
  SortDetections(&seen_);
  const Association association = Run({Of(EditKind::kDelete, {box})});
  EXPECT_EQ(association.objects.size(), 2u);
}

TEST_F(EditsTest, AnchorsThatFitNothingAreRefused) {
  Edit edit = Of(EditKind::kDelete, {Box(1, 3)});
  edit.boxes[0].image = "rgb/03.png";
  ExpectRefused({Rename(Box(0, 0), "x"), edit},
                {"/edits/1/boxes/0/image is \"rgb/03.png\"", "12 images", "\"003.png\""});
  edit = Of(EditKind::kDelete, {Box(1, 3)});
  edit.boxes[0].box.x_max += 40.0;
  ExpectRefused({edit}, {"/edits/0/boxes/0/box is [", "\"rgb/003.png\"", "at least 0.9",
                         "nearest is [", "of \"thing\", overlap 0."});
  // A box that a stage left out is named with its reason.
  seen_.rejected = {
      {3, "chair", 1.0, edit.boxes[0].box, {}, RejectingStage::kImport, "near_border"}};
  ExpectRefused({edit},
                {"of \"chair\", overlap 1.00, which the stage import left out: near_border"});
  for (Frame& frame : seen_.frames) frame.image = "a/000.png";
  seen_.frames[1].image = "b/000.png";
  edit.boxes[0].image = "000.png";
  ExpectRefused({edit}, {"\"000.png\", as 12 images are called", "with its folder"});
  for (Frame& frame : seen_.frames) frame.image.clear();
  ExpectRefused({edit}, {"none of the 12 frames has an image"});
}

TEST_F(EditsTest, BoxesThatFitAlikeAreRefused) {
  const soslam::Box box = seen_.detections[Box(1, 3)].box;
  const double shift = 0.06 * box.Width();
  seen_.detections[Box(0, 3)].box = {box.x_min + shift, box.y_min, box.x_max + shift, box.y_max};
  Edit edit = Of(EditKind::kDelete, {Box(1, 3)});
  edit.boxes[0].box = {box.x_min + 0.5 * shift, box.y_min, box.x_max + 0.5 * shift, box.y_max};
  const std::vector<DetectionDecision> decisions(seen_.detections.size());
  ASSERT_EQ(seen_.detections[Box(0, 3)].frame_index, seen_.detections[Box(1, 3)].frame_index);
  ExpectError<InputError>(
      [&] {
        FindBoxes({"", {edit}, "e"}, seen_, decisions);
      },
      {"e: /edits/0/boxes/0/box", "fits two boxes alike"});
}

TEST_F(EditsTest, ContradictionsAreRefused) {
  const Edit split = Of(EditKind::kSplit, {Box(1, 3), Box(1, 4)});
  ExpectRefused({split, Of(EditKind::kJoin, {Box(1, 3), Box(1, 0)})},
                {"/edits/1 (join) contradicts /edits/0 (split)", "joins what the other splits"});
  // Also through a third object.
  ExpectRefused({Of(EditKind::kJoin, {Box(1, 3), Box(0, 0)}), split,
                 Of(EditKind::kJoin, {Box(0, 2), Box(1, 7)})},
                {"/edits/2 (join) contradicts /edits/1 (split)"});
  ExpectRefused({split, Of(EditKind::kSplit, {Box(1, 4), Box(1, 5)})},
                {"/edits/1 (split) contradicts /edits/0 (split)", "split off the same box"});
  ExpectRefused({Of(EditKind::kDelete, {Box(2, 0)}), Rename(Box(2, 5), "x")},
                {"/edits/1 (rename) contradicts /edits/0 (delete)", "of one object"});
  ExpectRefused({Rename(Box(2, 0), "x"), Rename(Box(2, 5), "y")}, {"/edits/1 (rename)"});
  ExpectRefused({Size(Box(2, 0), {1.0, {}, {}}), Size(Box(2, 5), {1.1, {}, {}})}, {"(size)"});
  ExpectRefused({Of(EditKind::kDeleteBoxes, {Box(2, 0)}), Rename(Box(2, 0), "x")},
                {"/edits/1 (rename) contradicts /edits/0 (delete_boxes)"});
  for (size_t i = 6; i < seen_.frames.size(); ++i) seen_.frames[i].segment = 1;
  ExpectRefused({Of(EditKind::kJoin, {Box(0, 0), Box(0, 11)})},
                {"/edits/0/boxes/1 is of another recording"});
}

TEST_F(EditsTest, SizesOfSeveralEditsAddUp) {
  const Association association =
      Run({Size(Box(2, 0), {0.4, {}, {}}), Size(Box(2, 5), {{}, {}, 0.6})});
  const KnownSize& size = TrackOf(association, Box(2, 0)).by_hand->size;
  EXPECT_EQ(size.depth_m, 0.4);
  EXPECT_EQ(size.width_m, std::nullopt);
  EXPECT_EQ(size.height_m, 0.6);
}

}  // namespace
}  // namespace soslam
