// SPDX-License-Identifier: BSD-3-Clause
#include "report/not_placed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "association/association.h"
#include "support/expect_error.h"
#include "support/scene.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json Track(const std::string& fate, const json& merged_into = {}) {
  json merge;
  if (!merged_into.is_null()) merge = {{"into_track", merged_into}};
  return {{"fate", fate}, {"merge", merge}, {"detections", 3}, {"frames_in_sight", 58}};
}

TEST(FateInWords, IsASentenceOfItsOwnForEachFate) {
  std::set<std::string> reasons;
  for (const char* fate : kTrackFateNames) {
    if (fate == std::string("object") || fate == std::string("merged")) continue;
    const std::string reason = FateInWords(Track(fate), {{"min_observations", 3}});
    EXPECT_EQ(reason.find('_'), reason.npos) << reason;
    std::string name = fate;
    std::ranges::replace(name, '_', ' ');
    EXPECT_NE(reason, name);
    EXPECT_TRUE(reasons.insert(reason).second) << reason;
  }
  EXPECT_EQ(reasons.size(), kTrackFateNames.size() - 2);
}

TEST(FateInWords, HasTheNumbersOfTheDecision) {
  EXPECT_EQ(FateInWords(Track("rarely_detected"), {}),
            "detected in only 3 of the 58 images that should show it");
  EXPECT_THAT(FateInWords(Track("too_few_detections"), {{"min_observations", 3}}),
              HasSubstr("fewer than 3 boxes"));
  EXPECT_EQ(FateInWords(Track("a_fate_to_come"), {}), "a fate to come");
}

TEST(FailureInWords, IsTheReasonOrItsNameWithBlanks) {
  EXPECT_EQ(FailureInWords("moving"), "it moves, or may move");
  EXPECT_EQ(FailureInWords("fewer_than_three_views"), "seen in fewer than three images");
  EXPECT_EQ(FailureInWords("no_start"), "no initial estimate");
  EXPECT_EQ(FailureInWords("another_reason"), "another reason");
}

// Associations of seven detections, and the sequence that has those that were not used.
class TracksLeftOutTest : public testing::Test {
 protected:
  TracksLeftOutTest() {
    associations_ = {{"artefact", {{"settings", {{"min_observations", 3}}}}},
                     {"tracks",
                      {Track("object"), Track("never_whole"), Track("merged", 1),
                       Track("merged", 0), Track("moves")}},
                     {"detections", json::array()}};
    Add(0, 1, "chair");            // used
    Add(1, nullptr, "cup");        // of a track that was left out
    Add(2, nullptr, "mug");        // of one that was merged into it
    Add(nullptr, nullptr, "cup");  // a duplicate
    Add(2, nullptr, "mug");
    Add(3, nullptr, "chair");  // a worse box of the object
    Add(4, nullptr, "cat");
  }
  void Add(const json& track, const json& object, const std::string& label) {
    const int frame = static_cast<int>(associations_["detections"].size());
    associations_["detections"].push_back(
        {{"frame", sequence_.frames[frame].id}, {"track", track}, {"object", object}});
    if (!object.is_null()) return;
    const Box box = {10.0 * frame, 10.0, 10.0 * frame + 20.0, 40.0};
    // Import has rejected others before.
    sequence_.rejected.push_back({frame, "far", 0.1, box, {}, RejectingStage::kImport, "low"});
    sequence_.rejected.push_back({frame, label, 0.9, box, {}, RejectingStage::kAssociate, "x"});
  }

  Sequence sequence_ = CuboidSequence(3, 8);
  json associations_;
};

TEST_F(TracksLeftOutTest, HaveTheBoxesOfAllThatWasMergedIntoThem) {
  const std::vector<NotPlaced> things = TracksLeftOut(associations_, sequence_);
  ASSERT_EQ(things.size(), 2u);
  EXPECT_EQ(things[0].label, "mug");  // two of three boxes
  EXPECT_EQ(things[0].reason, "no image shows it whole");
  ASSERT_EQ(things[0].boxes.size(), 3u);
  EXPECT_EQ(things[0].boxes[1].frame_index, 2);
  EXPECT_EQ(things[0].boxes[1].box, (Box{20.0, 10.0, 40.0, 40.0}));
  EXPECT_TRUE(things[0].boxes[1].is_whole);
  EXPECT_EQ(things[1].label, "cat");
  EXPECT_EQ(things[1].boxes.size(), 1u);
}

TEST_F(TracksLeftOutTest, AreRefusedWhereTheSequenceIsAnother) {
  const auto refused = [&] { TracksLeftOut(associations_, sequence_); };
  sequence_.rejected.pop_back();
  ExpectError<InputError>(refused, {"associations.json", "sequence.json"});
  associations_["detections"].erase(6);
  EXPECT_EQ(TracksLeftOut(associations_, sequence_).size(), 1u);
  associations_["detections"].erase(5);
  ExpectError<InputError>(refused, {"associations.json", "sequence.json"});
  associations_["detections"].push_back(associations_["detections"].back());
  ExpectError<InputError>(refused, {"associations.json", "sequence.json"});
}

TEST_F(TracksLeftOutTest, AreRefusedWithATrackThatIsNotThere) {
  associations_["detections"][1]["track"] = 5;
  ExpectError<InputError>([&] { TracksLeftOut(associations_, sequence_); }, {"track 5 of 5"});
  associations_["detections"][1]["track"] = 1;
  associations_["tracks"][1]["merge"] = {{"into_track", 2}};  // a circle
  EXPECT_EQ(TracksLeftOut(associations_, sequence_).size(), 3u);
}

TEST_F(TracksLeftOutTest, AreUnknownInSequencesOfOldVersions) {
  sequence_.rejected.clear();
  EXPECT_TRUE(TracksLeftOut(associations_, sequence_).empty());
}

}  // namespace
}  // namespace soslam
