// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/gltf_document.h"
#include "support/printed.h"
#include "support/scene.h"
#include "support/temporary_folder.h"
#include "support/true_map.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// The stage on a sequence of cuboids, and a map that has all but the last of them.
class RunExportTest : public FolderTest {
 protected:
  using Outputs = std::vector<std::pair<std::string, std::string>>;  // argument and file

  RunExportTest() {
    map_.objects.back().landmark_in_world.reset();
    map_.objects.back().failure = "no_start";
    for (Rigid3d& pose : map_.world_from_camera) pose.translation.x() += 0.125;
    Write();
  }

  void Write() const {
    WriteSequence(folder_ / "sequence.json", sequence_, {});
    WriteMap(folder_ / "map.json", map_, sequence_, {{}, {folder_ / "sequence.json"}});
  }
  fs::path File(const std::string& name) const { return folder_ / name; }

  // With the sequence, these further inputs, and the outputs of these arguments.
  void Run(const std::vector<std::string>& inputs, const Outputs& outputs) const {
    StageFiles files = {{"sequence", File("sequence.json")}};
    for (const std::string& input : inputs) files[input] = File(input + ".json");
    for (const auto& [argument, name] : outputs) files[argument] = File(name);
    PrintedBy([&] { RunExport(options_, files, 1); });
  }
  // Expects that Run refuses, saying these words.
  template <typename Error>
  void ExpectRefused(const std::vector<std::string>& inputs, const Outputs& outputs,
                     const std::vector<std::string>& words) const {
    ExpectError<Error>([&] { Run(inputs, outputs); }, words);
  }
  size_t FilesInFolder() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  const Outputs kAll = {{"trajectory", "t.txt"}, {"ply", "m.ply"},           {"gltf", "m.glb"},
                        {"coco", "c.json"},      {"coco_dataset", "d.json"}, {"csv", "l.csv"},
                        {"boxes", "b.csv"}};
  ExportOptions options_;
  Sequence sequence_ = CuboidSequence(4, 9);
  MapEstimate map_ = TrueMap(sequence_);
};

TEST_F(RunExportTest, WritesWhatIsAskedFor) {
  Run({"map"}, kAll);
  const auto poses = ReadTrajectory(File("t.txt"));
  ASSERT_EQ(poses.size(), sequence_.frames.size());
  EXPECT_EQ(poses[4].world_from_camera.translation, map_.world_from_camera[4].translation);
  EXPECT_EQ(FileBytes(File("m.ply")).substr(0, 4), "ply\n");
  const GltfDocument scene = ParseGlb(FileBytes(File("m.glb")));
  EXPECT_EQ(scene.json.at("nodes").size(), 1 + 3 + 1u);
  const std::string table = FileBytes(File("l.csv"));
  EXPECT_EQ(std::ranges::count(table, '\n'), 5);
  EXPECT_NE(table.find("no_start"), std::string::npos);
  EXPECT_EQ(FileBytes(File("b.csv")).substr(0, 10), "label,x,y,");
  Run({"map"}, {{"gltf", "m.gltf"}});
  EXPECT_EQ(nlohmann::json::parse(FileBytes(File("m.gltf"))).at("nodes"), scene.json["nodes"]);
}

TEST_F(RunExportTest, WithoutAMapThereAreThePosesOfTheSequence) {
  Run({}, {{"trajectory", "t.txt"}});
  EXPECT_EQ(ReadTrajectory(File("t.txt"))[2].world_from_camera.translation,
            sequence_.frames[2].world_from_camera.translation);
  ExpectRefused<SettingsError>({}, {{"trajectory", "t.txt"}, {"csv", "l.csv"}},
                               {"no objects", "--map", "truth"});
}

TEST_F(RunExportTest, TruthIsPosesAndObjects) {
  for (Frame& frame : sequence_.frames) {
    frame.true_world_from_camera = frame.world_from_camera;
    frame.true_world_from_camera->translation.z() += 0.5;
  }
  Write();
  options_.truth = true;
  Run({}, kAll);
  EXPECT_EQ(ReadTrajectory(File("t.txt"))[3].world_from_camera.translation,
            sequence_.frames[3].true_world_from_camera->translation);
  EXPECT_EQ(ParseGlb(FileBytes(File("m.glb"))).json.at("nodes").size(), 1 + 4 + 1u);
  ExpectRefused<SettingsError>({"map"}, kAll, {"truth", "--map"});
}

TEST_F(RunExportTest, MetricsBringAMapIntoTheWorldOfTheTruth) {
  for (size_t i = 0; i < sequence_.frames.size(); ++i) {
    sequence_.frames[i].true_world_from_camera = map_.world_from_camera[i];
    sequence_.frames[i].true_world_from_camera->translation.y() += 0.5;
  }
  Write();
  const StageFiles evaluated = {{"sequence", File("sequence.json")},
                                {"landmarks", File("map.json")},
                                {"output", File("metrics.json")}};
  PrintedBy([&] { RunEvaluate({.alignment = AlignmentKind::kRigid}, evaluated, 1); });
  Run({"map", "metrics"}, {{"trajectory", "t.txt"}, {"csv", "l.csv"}});
  EXPECT_EQ(ReadTrajectory(File("t.txt"))[3].world_from_camera.translation,
            map_.world_from_camera[3].translation);
  EXPECT_NE(FileBytes(File("l.csv")).find("false"), std::string::npos);
  options_.aligned = true;
  Run({"map", "metrics"}, {{"trajectory", "t.txt"}});
  EXPECT_NEAR(ReadTrajectory(File("t.txt"))[3].world_from_camera.translation.y(),
              map_.world_from_camera[3].translation.y() + 0.5, 1e-9);
  ExpectRefused<SettingsError>({"map"}, {{"csv", "l.csv"}}, {"aligned", "--metrics"});
  map_.world_from_camera[0].translation.x() += 1.0;
  Write();
  ExpectRefused<InputError>({"map", "metrics"}, {{"csv", "l.csv"}},
                            {"metrics.json: was not made of", "map.json"});
  options_.truth = true;
  ExpectRefused<SettingsError>({"metrics"}, {{"csv", "l.csv"}}, {"--metrics", "--map"});
}

TEST_F(RunExportTest, AMapOfAnotherSequenceIsRefused) {
  sequence_.objects.front().label = "another";
  WriteSequence(folder_ / "sequence.json", sequence_, {});
  ExpectRefused<InputError>({"map"}, kAll, {"map.json: was not made of", "sequence.json"});
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(RunExportTest, NoTruthIsNothingUsable) {
  for (Frame& frame : sequence_.frames) frame.true_world_from_camera.reset();
  sequence_.true_objects.clear();
  Write();
  options_.truth = true;
  ExpectRefused<NothingUsableError>({}, {{"trajectory", "t.txt"}}, {"sequence.json", "no poses"});
  ExpectRefused<NothingUsableError>({}, {{"csv", "l.csv"}}, {"sequence.json", "no landmarks"});
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(RunExportTest, SegmentsAreFilesOfTheirOwn) {
  for (size_t i = 4; i < sequence_.frames.size(); ++i) sequence_.frames[i].segment = 12;
  Write();
  Run({"map"}, kAll);
  Run({"map"}, {{"ply", "m.v2.ply"}, {"trajectory", "poses"}});
  EXPECT_EQ(ReadTrajectory(File("t-0.txt")).size(), 4u);
  EXPECT_EQ(ReadTrajectory(File("t-12.txt")).size(), sequence_.frames.size() - 4);
  for (const char* name :
       {"m-0.ply", "m-12.ply", "m-0.glb", "m-12.glb", "b-12.csv", "m.v2-12.ply", "poses-0"}) {
    EXPECT_TRUE(fs::exists(File(name))) << name;
  }
  EXPECT_FALSE(fs::exists(File("t.txt")));
  // Tables name frames and objects by ids that are the sequence's.
  EXPECT_EQ(nlohmann::json::parse(FileBytes(File("d.json"))).at("images").size(),
            sequence_.frames.size());
  EXPECT_TRUE(fs::exists(File("l.csv")));
}

TEST_F(RunExportTest, RefusesWhatItCannotDo) {
  ExpectRefused<SettingsError>({"map"}, {}, {"--trajectory", "--csv"});
  ExpectRefused<SettingsError>({"map"}, {{"gltf", "m.obj"}}, {"m.obj", ".glb or .gltf"});
  ExpectRefused<SettingsError>({"map"}, {{"overlays", "drawn"}}, {"--dataset", "images"});
  ExpectRefused<SettingsError>({"map", "points"}, {{"boxes", "b.csv"}}, {"--points", "--colmap"});
  for (ObjectEstimate& object : map_.objects) object.landmark_in_world.reset();
  Write();
  ExpectRefused<NothingUsableError>({"map"}, kAll, {"map.json", "no landmarks"});
  for (Frame& frame : sequence_.frames) frame.image.clear();
  Write();
  ExpectRefused<NothingUsableError>({}, {{"colmap", "model"}}, {"sequence.json", "an image"});
  EXPECT_EQ(FilesInFolder(), 2u);
}

}  // namespace
}  // namespace soslam
