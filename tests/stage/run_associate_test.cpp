// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/association/options.h"
#include "soslam/base/error.h"
#include "soslam/report/page_parts.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"
#include "support/association_scenes.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/printed.h"
#include "support/scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

class RunAssociateTest : public FolderTest {
 protected:
  RunAssociateTest() {
    WriteSequence(File("sequence"), sequence_, {});
    WriteBytes(File("table"), R"({"default": {"a_by_c": 1, "a_by_c_log_sigma": 0.5, "b_by_c": 1,
                                  "b_by_c_log_sigma": 0.5, "shape_exponent": 1.1,
                                  "source": "the test"},
                                  "labels": {"chest": {"a_by_c": 1, "a_by_c_log_sigma": 0.5,
                                  "b_by_c": 1, "b_by_c_log_sigma": 0.5, "shape_exponent": 1.1,
                                  "source": "the test"}}})");
  }

  std::filesystem::path File(const std::string& name) const { return folder_ / (name + ".json"); }
  void Run(int threads = 1) const {
    StageFiles files;
    for (const char* name : {"sequence", "table", "output", "associations"}) {
      files[name] = File(name);
    }
    if (std::filesystem::exists(File("edits"))) files["edits"] = File("edits");
    RunAssociate(options_, files, threads);
  }
  json Associations() const { return ReadArtefact(File("associations"), "associations"); }

  AssociateOptions options_ = EstimatedAssociation();
  Sequence sequence_ = SyntheticSequence(LabelledScene(7, 4, 30, {"thing", "other"}), false);
};

TEST_F(RunAssociateTest, SaysWhatItDecided) {
  Run();
  const Sequence associated = ReadSequence(File("output"));
  EXPECT_EQ(associated.detections.size(), sequence_.detections.size());
  for (const Object& object : associated.objects) EXPECT_TRUE(object.ground_truth);
  const json associations = Associations();
  EXPECT_EQ(associations["agreement"]["f1"], 1.0);
  ASSERT_EQ(associations["detections"].size(), sequence_.detections.size());
  ASSERT_EQ(associations["objects"].size(), sequence_.objects.size());
  std::map<int, int> detections;
  for (size_t i = 0; i < sequence_.detections.size(); ++i) {
    const json& row = associations["detections"][i];
    EXPECT_EQ(row["box"][0], sequence_.detections[i].box.x_min);
    EXPECT_EQ(row["label"], sequence_.ObjectOf(sequence_.detections[i]).label);
    EXPECT_EQ(row["fate"], "explained") << row;
    EXPECT_TRUE(row["match"].is_object()) << row;
    if (!row["object"].is_null()) ++detections[row["object"].get<int>()];
  }
  for (const json& object : associations["objects"]) {
    EXPECT_EQ(object["detections"], detections[object["object"].get<int>()]);
    EXPECT_EQ(object["label_votes"].size(), 1u);
    EXPECT_EQ(object["label_votes"].value(object["label"].get<std::string>(), 0.0),
              object["detections"].get<double>());
    EXPECT_EQ(associations["tracks"][object["track"].get<size_t>()]["fate"], "object");
    for (const char* list : {"held_least", "held_most", "kept_out"}) {
      EXPECT_EQ(std::ranges::count(associations[list], object["object"],
                                   [](const json& row) { return row["object"]; }),
                3)
          << list;
    }
  }
}

TEST_F(RunAssociateTest, EditsAreAppliedAndTold) {
  for (Frame& frame : sequence_.frames) frame.image = fmt::format("{}.png", frame.id);
  WriteSequence(File("sequence"), sequence_, {});
  const Detection& seen = sequence_.detections.front();
  json anchor = {{"image", sequence_.FrameOf(seen).image},
                 {"box", {seen.box.x_min, seen.box.y_min, seen.box.x_max, seen.box.y_max}}};
  const json edits = {{{"edit", "rename"}, {"boxes", {anchor}}, {"label", "chest"}},
                      {{"edit", "size"}, {"boxes", {anchor}}, {"height_m", 0.75}}};
  WriteBytes(File("edits"), json{{"edits", edits}}.dump());
  EXPECT_THAT(PrintedBy([&] { Run(); }).output,
              testing::HasSubstr("2 corrections by hand: 1 rename, 1 size"));
  const Sequence associated = ReadSequence(File("output"));
  ASSERT_TRUE(associated.edits);
  EXPECT_EQ(associated.edits->sha256, Sha256OfFile(File("edits")));
  EXPECT_EQ(associated.objects.front().label, "chest");
  EXPECT_EQ(associated.objects.front().known_size.height_m, 0.75);
  const json inputs = ReadArtefact(File("output"), "sequence")["artefact"]["inputs"];
  EXPECT_THAT(inputs.dump(), testing::HasSubstr("\"edits.json\""));
  const std::string one_thread = FileBytes(File("output"));
  Run(3);
  EXPECT_EQ(FileBytes(File("output")), one_thread);

  WriteBytes(
      File("edits"),
      json{{"edits", {{{"edit", "rename"}, {"boxes", {anchor}}, {"label", "chset"}}}}}.dump());
  ExpectError<InputError>([&] { Run(); }, {"edits.json: /edits/0/label is \"chset\""});
  // A box that is no longer there.
  anchor["box"][0] = seen.box.x_min - 300.0;
  WriteBytes(File("edits"), json{{"edits", {{{"edit", "delete"}, {"boxes", {anchor}}}}}}.dump());
  ExpectError<InputError>([&] { Run(); }, {"edits.json: /edits/0/boxes/0/box is ["});
  EXPECT_EQ(FileBytes(File("output")), one_thread);
}

TEST_F(RunAssociateTest, EditsThatSayTooLittleOrTooMuchAreRefused) {
  const std::string box = R"("boxes": [{"image": "a", "box": [1, 2, 3, 4]}])";
  ExpectBadTexts({{R"({"edit": "join", )" + box + "}", {"/edits/0: join has one box"}},
                  {R"({"edit": "rename", )" + box + "}", {"rename has no label"}},
                  {R"({"edit": "split", "label": "x", )" + box + "}", {"split has a label"}},
                  {R"({"edit": "size", )" + box + "}", {"size has no length"}},
                  {R"({"edit": "size", "width_m": 0, )" + box + "}", {"/edits/0/width_m is 0"}},
                  {R"({"edit": "delete", "height_m": 1, )" + box + "}", {"delete has a length"}},
                  {R"({"edit": "merge", )" + box + "}", {"/edits/0/edit is \"merge\"", "join"}},
                  {R"({"edit": "delete", "boxes": []})", {"/edits/0/boxes"}}},
                 "edits.json", [&](const std::string& text) {
                   WriteBytes(File("edits"), R"({"edits": [)" + text + "]}");
                   ReadEdits(File("edits"));
                 });
}

TEST_F(RunAssociateTest, TracksThatAreNotThereAreRefused) {
  Run();
  const json associations = Associations();
  for (const std::string place : {"/detections/0/track", "/objects/0/track", "/kept_out/0/track"}) {
    json damaged = associations;
    damaged[json::json_pointer(place)] = 999;
    WriteBytes(File("associations"), damaged.dump());
    ExpectError<InputError>([&] { ReadAssociations(File("associations")); },
                            {"associations.json", "track 999 of"});
  }
}

TEST_F(RunAssociateTest, PagesFindTheBoxesOfWhatItLeftOut) {
  sequence_.moving_labels = "other";
  WriteSequence(File("sequence"), sequence_, {});
  Run();
  const std::vector<NotPlaced> things =
      TracksLeftOut(ReadAssociations(File("associations")).body, ReadSequence(File("output")));
  ASSERT_EQ(things.size(), 2u);  // every other one of four objects
  const auto detections = DetectionsByObject(sequence_);
  for (size_t i = 0; i < things.size(); ++i) {
    EXPECT_EQ(things[i].label, "other");
    EXPECT_EQ(things[i].reason, "of a kind that moves");
    const auto is_of = [&](const std::vector<int>& of_object) {
      return std::ranges::equal(of_object, things[i].boxes, [&](int index, const SeenBox& seen) {
        const Detection& detection = sequence_.detections[index];
        return detection.frame_index == seen.frame_index && detection.box == seen.box;
      });
    };
    EXPECT_EQ(std::ranges::count_if(detections, is_of), 1);
  }
}

// Spreads as of labels that stand for many things.
TEST_F(RunAssociateTest, SaysWhereUpIsOpen) {
  WriteBytes(File("table"), R"({"labels": {
    "post": {"a_by_c": 0.2, "a_by_c_log_sigma": 0.5, "b_by_c": 0.2, "b_by_c_log_sigma": 0.5,
             "height_m": 1, "height_log_sigma": 0.5, "shape_exponent": 1, "source": "the test"},
    "mat": {"a_by_c": 5, "a_by_c_log_sigma": 0.5, "b_by_c": 5, "b_by_c_log_sigma": 0.5,
            "height_m": 0.2, "height_log_sigma": 0.5, "shape_exponent": 1,
            "source": "the test"}}})");
  WriteSequence(File("sequence"), PostsAndMats(), {});
  Run();
  EXPECT_FALSE(Associations().contains("findings"));
  WriteSequence(File("sequence"), Rolled(PostsAndMats(), 1), {});
  EXPECT_THAT(PrintedBy([&] { Run(); }).errors,
              testing::HasSubstr("soslam-associate: warning: cameras are taken to be held "
                                 "rolled_90; probabilities: level"));
  EXPECT_EQ(Associations()["findings"].at(0)["check"], "up_direction");
}

TEST_F(RunAssociateTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); },
                            {File("output"), File("associations")});
}

TEST_F(RunAssociateTest, ThereIsNothingToDoForGivenObjects) {
  options_.association = AssociationSource::kGiven;
  ExpectError<SettingsError>([&] { Run(); }, {"association", "given", "estimated"});
}

TEST_F(RunAssociateTest, SharedPointsNeedMatches) {
  options_.shared_points = true;
  ExpectError<SettingsError>([&] { Run(); }, {"shared_points", "--matches", "soslam-match"});
}

TEST_F(RunAssociateTest, NoObjectIsNothingUsable) {
  options_.min_observations = 1000;
  ExpectError<NothingUsableError>([&] { Run(); },
                                  {"sequence.json", "no object", "seen too rarely"});
  EXPECT_FALSE(std::filesystem::exists(File("output")));
  EXPECT_FALSE(std::filesystem::exists(File("associations")));
}

}  // namespace
}  // namespace soslam
