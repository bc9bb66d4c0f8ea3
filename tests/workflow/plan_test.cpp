// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/dataset/import_options.h"
#include "soslam/ground/options.h"
#include "soslam/initialisation/options.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/planes/options.h"
#include "soslam/stage/stages.h"
#include "soslam/workflow/pipeline_settings.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kBase = R"({
  "stages": ["import", "initialise", "evaluate"],
  "import": {}, "edges": {}, "initialise": {}, "refine": {}, "optimise": {}, "evaluate": {}})";

class PlanTest : public FolderTest {
 protected:
  void SetUp() override {
    Write("pipelines/base.json", kBase);
    Write("pipelines/priors/semantic_table.json", "{}");
    Write("pipelines/variants/Plain.json", "{}");
    Write("pipelines/variants/Mapped.json",
          R"({"stages": ["import", "initialise", "optimise", "evaluate"]})");
    Write("pipelines/variants/Full.json",
          R"({"stages": ["import", "edges", "initialise", "refine", "optimise", "evaluate"],
              "optimise": {"symmetry": true}})");
  }
  std::string Read(const std::string& name) const { return FileBytes(folder_ / name); }
  Plan Make(const std::vector<std::string>& variants) const {
    return MakePlan(folder_ / "pipelines", "room", variants);
  }
  // The instance of a stage in a variant.
  std::string Id(const std::string& variant, const std::string& stage) const {
    const Plan plan = Make({variant});
    for (const std::string& id : plan.variants[0].instances) {
      if (plan.Instance(id).stage == stage) return id;
    }
    return "";
  }
  // What a stage of a variant reads: "refine/refined.json".
  std::string InputOf(const std::string& variant, const std::string& stage,
                      const std::string& argument) const {
    const Plan plan = Make({variant});
    for (const StageInstance& instance : plan.instances) {
      const auto input = instance.inputs.find(argument);
      if (instance.stage != stage || input == instance.inputs.end()) continue;
      return plan.Instance(input->second.instance).stage + "/" + input->second.file;
    }
    return "";
  }
  void ExpectRefused(const std::string& variant, const std::vector<std::string>& parts) const {
    ExpectError<SettingsError>([&] { Make({variant}); }, parts);
  }
};

TEST_F(PlanTest, VariantsShareWhatTheyHaveInCommon) {
  const Plan plan = Make({"Plain", "Mapped", "Full"});
  const auto& plain = plan.variants[0].instances;
  const auto& mapped = plan.variants[1].instances;
  const auto& full = plan.variants[2].instances;
  ASSERT_EQ(plain.size(), 3u);
  ASSERT_EQ(mapped.size(), 4u);
  ASSERT_EQ(full.size(), 6u);
  EXPECT_EQ(plain[0], mapped[0]);  // import
  EXPECT_EQ(plain[1], mapped[1]);  // initialise
  EXPECT_EQ(plain[1], full[2]);
  EXPECT_NE(plain[2], mapped[3]);  // evaluate, of other landmarks
  EXPECT_NE(mapped[2], full[4]);   // optimise, from other landmarks with other settings
  EXPECT_EQ(plan.instances.size(), 2u + 1u + 2u + 4u);
  EXPECT_THAT(plan.Instance(plain[1]).variants, ElementsAre("Plain", "Mapped", "Full"));
}

TEST_F(PlanTest, StagesReadTheLatestOfWhatTheyNeed) {
  Write("pipelines/variants/Points.json",
        R"({"stages": ["import", "track", "initialise", "optimise", "evaluate"],
            "planes": {"planes": "estimated"}, "optimise": {"point_evidence": true}})");
  Write("pipelines/variants/Frames.json",
        R"({"stages": ["import", "edges", "track", "initialise", "refine", "evaluate"],
            "initialise": {"point_evidence": true}, "refine": {"point_evidence": true}})");
  struct Input {
    const char* variant;
    const char* stage;
    const char* argument;
    const char* expected;  // maker and file; empty: there is no such input
  };
  const auto expect_inputs = [&](const char* settings, const std::vector<Input>& inputs) {
    Write("pipelines/datasets/room.json", settings);
    for (const auto& [variant, stage, argument, expected] : inputs) {
      EXPECT_EQ(InputOf(variant, stage, argument), expected) << settings << stage << argument;
    }
  };
  Write("pipelines/variants/Cuboids.json",
        R"({"stages": ["import", "edges", "initialise", "evaluate"],
            "initialise": {"method": "cuboid_proposals"}})");
  Write("pipelines/variants/Pictures.json",
        R"({"stages": ["import", "appearance", "initialise", "optimise", "evaluate"],
            "optimise": {"detection_model": "tangency", "picture_yaw": true}})");
  Write("pipelines/variants/Ratios.json",
        R"({"extends": "Pictures",
            "optimise": {"picture_yaw": false, "picture_ratios": true}})");
  Write("pipelines/variants/Matched.json",
        R"({"stages": ["import", "initialise", "evaluate"],
            "associate": {"association": "estimated", "shared_points": true}})");
  ExpectError<InputError>([&] { Make({"Pictures"}); },
                          {"heads/yolox_nano.h5", "does not exist", "'Pictures'"});
  Write("pipelines/heads/yolox_nano.h5", "a head");
  expect_inputs("{}", {{"Plain", "evaluate", "landmarks", "initialise/initial.json"},
                       {"Pictures", "appearance", "sequence", "import/sequence.json"},
                       {"Pictures", "initialise", "appearance", ""},
                       {"Pictures", "optimise", "appearance", "appearance/appearance.h5"},
                       {"Ratios", "optimise", "appearance", "appearance/appearance.h5"},
                       {"Full", "initialise", "edges", ""},
                       {"Cuboids", "initialise", "edges", "edges/edges.h5"},
                       {"Mapped", "optimise", "landmarks", "initialise/initial.json"},
                       {"Mapped", "optimise", "edges", ""},
                       {"Full", "refine", "initial", "initialise/initial.json"},
                       {"Full", "refine", "edges", "edges/edges.h5"},
                       {"Full", "optimise", "landmarks", "refine/refined.json"},
                       {"Full", "optimise", "edges", "edges/edges.h5"},
                       {"Full", "evaluate", "landmarks", "optimise/map.json"},
                       {"Matched", "match", "sequence", "import/sequence.json"},
                       {"Matched", "associate", "sequence", "import/sequence.json"},
                       {"Matched", "associate", "matches", "match/matches.h5"},
                       {"Points", "track", "sequence", "import/sequence.json"},
                       {"Points", "initialise", "points", ""},
                       {"Points", "optimise", "points", "track/points.h5"},
                       {"Frames", "initialise", "points", "track/points.h5"},
                       {"Frames", "refine", "points", "track/points.h5"}});
  expect_inputs(R"({"ground": {"ground": "estimated", "shared_points": true}})",
                {{"Full", "ground", "sequence", "import/sequence.json"},
                 {"Full", "ground", "matches", "match/matches.h5"}});
  // Images do not depend on what is estimated from boxes.
  expect_inputs(R"({"associate": {"association": "estimated"}})",
                {{"Full", "associate", "sequence", "import/sequence.json"},
                 {"Full", "associate", "matches", ""},
                 {"Full", "edges", "sequence", "import/sequence.json"},
                 {"Pictures", "appearance", "sequence", "associate/sequence.json"},
                 {"Full", "initialise", "sequence", "associate/sequence.json"},
                 {"Full", "evaluate", "sequence", "associate/sequence.json"}});
  expect_inputs(R"({"ground": {"ground": "estimated"}, "associate": {"association": "estimated"}})",
                {{"Full", "ground", "sequence", "import/sequence.json"},
                 {"Full", "associate", "sequence", "ground/sequence.json"},
                 {"Full", "initialise", "sequence", "associate/sequence.json"}});
  expect_inputs(R"({"planes": {"planes": "estimated"}})",
                {{"Full", "planes", "sequence", "import/sequence.json"},
                 {"Full", "edges", "sequence", "import/sequence.json"},
                 {"Full", "evaluate", "sequence", "planes/sequence.json"}});
  expect_inputs(R"({"associate": {"association": "estimated"}, "planes": {"planes": "estimated"}})",
                {{"Full", "planes", "sequence", "associate/sequence.json"},
                 {"Full", "initialise", "sequence", "planes/sequence.json"}});
}

TEST_F(PlanTest, AKeyChangesWithItsSettingsAndWithThoseUpstreamOnly) {
  const std::string import = Id("Mapped", "import");
  const std::string initialise = Id("Mapped", "initialise");
  const std::string optimise = Id("Mapped", "optimise");
  const std::string evaluate = Id("Mapped", "evaluate");
  Write("pipelines/datasets/room.json", R"({"initialise": {"yaw_starts": 13}})");
  EXPECT_EQ(Id("Mapped", "import"), import);
  EXPECT_NE(Id("Mapped", "initialise"), initialise);
  EXPECT_NE(Id("Mapped", "optimise"), optimise);
  EXPECT_NE(Id("Mapped", "evaluate"), evaluate);
}

TEST_F(PlanTest, AKeyIgnoresWhatItsVariantDoesNotRunAndHowDefaultsAreWritten) {
  const std::string evaluate = Id("Mapped", "evaluate");
  Write("pipelines/datasets/room.json",
        R"({"refine": {"yaw_step_deg": 5}, "associate": {"min_observations": 5},
            "import": {"border_px": 30}, "description": "x"})");
  EXPECT_EQ(Id("Mapped", "evaluate"), evaluate);
}

TEST_F(PlanTest, AKeyDependsOnTheSemanticTableButNotOnWhereFilesLie) {
  const std::string import = Id("Mapped", "import");
  const std::string initialise = Id("Mapped", "initialise");
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(folder_ / "pipelines", folder_ / "elsewhere" / "pipelines");
  EXPECT_EQ(MakePlan(folder_ / "elsewhere/pipelines", "desk", {"Mapped"}).variants[0].instances[1],
            initialise);
  fs::rename(folder_ / "elsewhere" / "pipelines", folder_ / "pipelines");
  Write("pipelines/datasets/room.json", R"({"semantic_table": "priors/other.json"})");
  Write("pipelines/priors/other.json", "{}");
  EXPECT_EQ(Id("Mapped", "import"), import);
  EXPECT_NE(Id("Mapped", "initialise"), initialise);
}

TEST_F(PlanTest, VariantWinsOverDatasetOverBase) {
  Write("pipelines/base.json",
        R"({"stages": ["import"],
            "import": {"border_px": 1, "frame_stride": 1, "min_observations": 1}})");
  Write("pipelines/datasets/room.json", R"({"import": {"border_px": 2, "frame_stride": 2}})");
  Write("pipelines/variants/Plain.json", R"({"import": {"border_px": 3}})");
  const nlohmann::json import =
      ReadVariant(folder_ / "pipelines", "room", "Plain").options.at("import");
  EXPECT_EQ(import["border_px"], 3);
  EXPECT_EQ(import["frame_stride"], 2);
  EXPECT_EQ(import["min_observations"], 1);
  EXPECT_EQ(ReadVariant(folder_ / "pipelines", "desk", "Plain").options["import"]["frame_stride"],
            1);
}

TEST_F(PlanTest, AVariantComesAfterTheOneThatItExtends) {
  Write("pipelines/datasets/room.json", R"({"import": {"frame_stride": 2, "border_px": 2}})");
  Write("pipelines/variants/Plain.json",
        R"({"import": {"frame_stride": 3, "border_px": 3, "min_observations": 3}})");
  Write("pipelines/variants/More.json",
        R"({"extends": "Plain", "import": {"border_px": 4, "min_observations": null}})");
  Write("others/variants/Most.json",
        R"({"extends": "../../pipelines/variants/More", "import": {"max_time_difference_s": 5}})");
  Write("others/base.json", kBase);
  const nlohmann::json import =
      ReadVariant(folder_ / "others", "room", "Most").options.at("import");
  EXPECT_EQ(import["frame_stride"], 3);
  EXPECT_EQ(import["border_px"], 4);
  EXPECT_EQ(import["min_observations"], ImportOptions().min_observations);
  EXPECT_EQ(import["max_time_difference_s"], 5);
  Write("pipelines/variants/Plain.json", R"({"extends": null})");
  EXPECT_EQ(ReadVariant(folder_ / "pipelines", "desk", "Plain").options.at("import")["border_px"],
            ImportOptions().border_px);
}

TEST_F(PlanTest, RefusalsNameTheFile) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"initialise": {"unheard_of": 1}})", "unheard_of"},
      {R"({"initialise": {"yaw_starts": "many"}})", "yaw_starts"},
      {R"({"initialise": 3})", "initialise"},
      {R"({"initialize": {}})", "initialize"},
      {R"({"stages": ["import", "fly"]})", "fly"},
      {R"({"stages": ["import", "ground"]})", "expected one of import, match, edges"},
      {R"({"stages": ["import", "import"]})", "twice"},
      {R"({"stages": []})", "stages"},
      {R"({"stages": null})", "stages"},
      {R"({"stages": ["initialise"]})", "needs stage 'import'"},
      {R"({"stages": ["import", "initialise", "refine"]})", "needs stage 'edges'"},
      {R"({"stages": ["import", "initialise", "optimise"], "optimise": {"symmetry": true}})",
       "with symmetry = true needs stage 'edges'"},
      {R"({"initialise": {"method": "cuboid_proposals"}})", "needs stage 'edges'"},
      {R"({"stages": ["import", "edges", "initialise", "refine", "optimise"],
           "initialise": {"point_evidence": true}})",
       "needs stage 'track'"},
      {R"({"stages": ["import", "edges", "initialise", "refine", "optimise"],
           "refine": {"point_evidence": true}})",
       "needs stage 'track'"},
      {R"({"stages": ["import", "edges", "initialise", "refine", "optimise"],
           "optimise": {"point_evidence": true}})",
       "needs stage 'track'"},
      {R"({"semantic_table": 3})", "semantic_table"},
      {R"({"extends": 3})", "extends"},
      {R"({"extends": "Bad"})", "leads back"},
      {R"({"border_px": 0})", "'border_px' is a setting of import; expected it in the section of"},
      {R"({"edges": {"border_px": 0}})", "edges: 'border_px' is a setting of import"},
      {R"({"edges": {"method": "svd"}})", "'method' is a setting of "},
      {"[]", "object"},
      {"{", ""}};
  for (const auto& [text, part] : cases) {
    Write("pipelines/variants/Bad.json", text);
    ExpectRefused("Bad", {"variants/Bad.json", part});
  }
  ExpectRefused("Missing", {"variants/Missing.json", "known are Bad, Full, Mapped, Plain"});
  Write("pipelines/variants/Bad.json", R"({"extends": "Nowhere"})");
  ExpectRefused("Bad", {"variants/Bad.json", "'extends'", "variants/Nowhere.json"});
  Write("pipelines/variants/Bad.json", R"({"extends": "Plain", "optimise": {"huber_delta": 3}})");
  ExpectRefused("Bad", {"variants/Bad.json", "'optimise', which does not run"});
  Write("pipelines/variants/Bad.json",
        R"({"extends": "Plain", "associate": {"min_observations": 5}})");
  ExpectRefused("Bad", {"variants/Bad.json", "'associate', which does not run"});
  Write("pipelines/datasets/room.json", R"({"extends": "Plain"})");
  ExpectRefused("Full", {"datasets/room.json", "'extends' is for variants only"});
  Write("pipelines/datasets/room.json", R"({"about": {"boxes_of": "hand"}})");
  ExpectRefused("Plain", {"datasets/room.json: about", "boxes_of"});
  for (const char* about : {"[]", "\"my room\"", "3"}) {
    Write("pipelines/datasets/room.json", fmt::format(R"({{"about": {}}})", about));
    ExpectRefused("Plain", {"datasets/room.json: about: the document is ", about});
  }
  // Also of a stage that does not run.
  Write("pipelines/datasets/room.json", R"({"associate": {"min_observations": 0}})");
  ExpectRefused("Plain", {"datasets/room.json: associate", "min_observations"});
}

TEST_F(PlanTest, ASemanticTableThatIsMissingIsRefused) {
  Write("pipelines/datasets/room.json", R"({"semantic_table": "priors/mine.json"})");
  ExpectError<InputError>([&] { Make({"Plain"}); },
                          {"datasets/room.json: 'semantic_table' is \"priors/mine.json\"",
                           "pipelines/priors/mine.json does not exist"});
  Write("pipelines/variants/Mine.json", R"({"semantic_table": "my.json"})");
  Write("pipelines/variants/More.json", R"({"extends": "Mine"})");
  ExpectError<InputError>([&] { Make({"More"}); }, {"variants/Mine.json: 'semantic_table'"});
  Write("pipelines/priors/mine.json", "{}");
  EXPECT_EQ(Make({"Plain"}).instances[1].semantic_table, "priors/mine.json");
}

class SettingsTest : public PlanTest {
 protected:
  // What the findings of a plan found.
  std::vector<std::string> Found(const std::vector<std::string>& variants) const {
    std::vector<std::string> found;
    for (const Finding& finding : Make(variants).findings) found.push_back(finding.found);
    return found;
  }
  std::string Path(const std::string& name) const {
    return (folder_ / "pipelines" / name).string();
  }
};

TEST_F(SettingsTest, WhatAVariantGivesAndDoesNotUseIsAWarning) {
  Write("pipelines/variants/Own.json",
        R"({"initialise": {"method": "multi_view", "yaw_prior": "motion", "shape": "cuboid"},
            "associate": {"association": "given", "interchangeable_labels": "cup, bowl"},
            "planes": {"planes": "given", "refine_poses": true}})");
  EXPECT_THAT(
      Found({"Own"}),
      ElementsAre(HasSubstr("Own.json: associate: interchangeable_labels = \"cup, bowl\" has"),
                  HasSubstr("Own.json: initialise: yaw_prior = \"motion\" has no effect"),
                  HasSubstr("Own.json: planes: refine_poses = true has no effect")));
  const std::vector<Finding> findings = Make({"Own", "Plain"}).findings;
  EXPECT_EQ(findings[0].expected, "association = estimated");
  EXPECT_EQ(findings[1].expected, "method = yaw_sweep");
  EXPECT_EQ(findings[2].expected, "planes = estimated or where_missing");
  // What it inherits is the other one's.
  Write("pipelines/variants/Heir.json", R"({"extends": "Own"})");
  EXPECT_THAT(Found({"Heir"}), IsEmpty());
}

TEST_F(SettingsTest, SettingsOfADatasetAreForAllVariants) {
  Write("pipelines/datasets/room.json",
        R"({"optimise": {"axes_weight": 0}, "refine": {"yaw_step_deg": 5},
            "associate": {"interchangeable_labels": "cup, bowl"}})");
  Write("pipelines/variants/Associated.json", R"({"associate": {"association": "estimated"}})");
  EXPECT_THAT(Found({"Plain", "Mapped"}), IsEmpty());
  fs::remove(folder_ / "pipelines/variants/Associated.json");
  EXPECT_THAT(
      Found({"Plain", "Mapped"}),
      ElementsAre(HasSubstr("datasets/room.json: associate: interchangeable_labels = \"cup")));
  // A variant that cannot be read may use it.
  Write("pipelines/variants/Broken.json", "{");
  EXPECT_THAT(Found({"Plain"}), IsEmpty());
}

TEST_F(SettingsTest, ADatasetMustNotContradictItself) {
  Write("pipelines/variants/Sweep.json", R"({"initialise": {"method": "yaw_sweep"}})");
  Write("pipelines/datasets/room.json",
        R"({"initialise": {"method": "multi_view", "yaw_prior": "motion"}})");
  EXPECT_THAT(Found({"Sweep"}), IsEmpty());
  EXPECT_THAT(Found({"Sweep", "Plain"}), ElementsAre(HasSubstr("yaw_prior = \"motion\"")));
  // A variant may choose otherwise.
  Write("pipelines/variants/Plain.json", R"({"initialise": {"method": "multi_view"}})");
  Write("pipelines/datasets/room.json",
        R"({"initialise": {"method": "yaw_sweep", "yaw_prior": "motion"}})");
  EXPECT_THAT(Found({"Sweep", "Plain"}), IsEmpty());
}

TEST_F(SettingsTest, AVariantIsForAllDatasets) {
  Write("pipelines/variants/Mapped.json",
        R"({"stages": ["import", "initialise", "optimise", "evaluate"],
            "optimise": {"odometry_rotation_sigma_deg": 1}})");
  Write("pipelines/datasets/room.json", R"({"optimise": {"hold_poses": true}})");
  EXPECT_THAT(Found({"Mapped"}), IsEmpty());
  Write("pipelines/base.json",
        R"({"stages": ["import", "initialise", "evaluate"], "optimise": {"hold_poses": true}})");
  EXPECT_THAT(Found({"Mapped"}), ElementsAre(HasSubstr("odometry_rotation_sigma_deg = 1")));
}

TEST_F(SettingsTest, FilesOfSimilarNamesAreNotRead) {
  for (const char* name : {"Room.json", "room.json.txt", "room.JSON", "room", "ROOM.txt"}) {
    const fs::path file = Write(std::string("pipelines/datasets/") + name, "{}");
    EXPECT_THAT(Found({"Plain"}), ElementsAre(file.string() + " is not read")) << name;
    fs::remove(file);
  }
  for (const char* name : {"room2.json", "room.v2.json", "bedroom.json", "room.json.bak"}) {
    Write(std::string("pipelines/datasets/") + name, "{}");
  }
  EXPECT_THAT(Found({"Plain"}), IsEmpty());
  Write("pipelines/datasets/Room.json", "{}");
  Write("pipelines/datasets/room.json", "{}");
  EXPECT_THAT(Found({"Plain"}), IsEmpty());
}

TEST_F(SettingsTest, ConditionsAreOnOptionsOfTheSameStage) {
  const std::vector<std::vector<OptionRow>> stages = {
      OptionRows<ImportOptions>(),      OptionRows<GroundOptions>(),
      OptionRows<PlanesOptions>(),      OptionRows<InitialiseOptions>(),
      OptionRows<OrientationOptions>(), OptionRows<OptimiseOptions>()};
  for (const std::vector<OptionRow>& rows : stages) {
    size_t conditions = 0;
    for (const OptionRow& row : rows) {
      for (const OptionVisitor::Conditions& any_of : row.only_where) {
        for (const auto& [option, values] : any_of) {
          const auto found = std::ranges::find(rows, option, &OptionRow::name);
          ASSERT_NE(found, rows.end()) << row.name << ": " << option;
          const std::vector<std::string> known =
              found->type == "boolean" ? std::vector<std::string>{"true", "false"} : found->choices;
          for (const std::string& value : values) EXPECT_THAT(known, Contains(value)) << option;
          ++conditions;
        }
      }
    }
    EXPECT_GT(conditions, 0u);
  }
}

TEST_F(PlanTest, EveryShippedVariantIsValidAndUsesItsSettings) {
  const fs::path project = fs::path(SOSLAM_SOURCE_DIR) / "pipelines";
  EXPECT_GE(VariantNames(project).size(), 7u);
  std::vector<std::pair<const char*, std::string>> runs = {
      {"kitti", "kitti_tracking"}, {"laid", "laid"},          {"ablation", "room_a"},
      {"raw_boxes", "room_a"},     {"unannotated", "desk_a"}, {"unannotated", "kitti_tracking"}};
  for (const auto& file : fs::directory_iterator(project / "datasets")) {
    runs.emplace_back("", file.path().stem().string());
  }
  for (const auto& [folder, dataset] : runs) {
    const Plan plan = MakePlan(project / folder, dataset, VariantNames(project / folder));
    for (const Finding& finding : plan.findings) ADD_FAILURE() << InWords(finding);
  }
}

class RunPlanTest : public PlanTest {
 protected:
  void SetUp() override {
    PlanTest::SetUp();
    Write("room/rgb.txt", "# timestamp filename\n1.0 rgb/0.jpg\n");
    Write("room/rgb/0.jpg", "image");
    Write("room/camera.json", "{}");
  }
  void Run(const std::string& name, const std::string& variants) const {
    RunIn("room", "results", name, variants);
  }
  void RunIn(const std::string& dataset, const std::string& results, const std::string& name,
             const std::string& variants) const {
    RunPlan({name, variants},
            {{"dataset", folder_ / dataset},
             {"pipelines", folder_ / "pipelines"},
             {"results", folder_ / results}},
            1);
  }
};

TEST_F(RunPlanTest, WritesNothingThatDidNotChange) {
  Run("", "");
  std::map<fs::path, fs::file_time_type> times;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "results")) {
    if (entry.is_regular_file()) times[entry.path()] = entry.last_write_time();
  }
  EXPECT_GE(times.size(), 3u + 3u + 9u);  // plan and fingerprints; variants; instances
  Run("", "");
  for (const auto& [path, time] : times) EXPECT_EQ(fs::last_write_time(path), time) << path;
}

TEST_F(RunPlanTest, AllVariantsOfADatasetWithoutImagesAreThoseThatLookAtNone) {
  Write("pipelines/variants/Pictures.json",
        R"({"stages": ["import", "appearance", "initialise", "evaluate"],
            "initialise": {"method": "multi_view", "picture_yaw": true}})");
  Write("pipelines/heads/yolox_nano.h5", "a head");
  Run("", "");
  EXPECT_THAT(Read("results/room/plan.mk"), AllOf(HasSubstr("/Full/"), HasSubstr("/Pictures/"),
                                                  HasSubstr(R"(--network "$$SOSLAM_NETWORK" )")));
  fs::remove(folder_ / "room/rgb/0.jpg");
  for (const char* image : {"room/rgb/0.BMP", "room/rgb/0.tif", "room/rgb/0.webp"}) {
    Write(image, "image");  // soslam-frames keeps photos in their format
    Run("", "");
    EXPECT_THAT(Read("results/room/plan.mk"), HasSubstr("/Full/")) << image;
    fs::remove(folder_ / image);
  }
  Run("", "");
  const std::string plan = Read("results/room/plan.mk");
  EXPECT_THAT(plan, Not(AnyOf(HasSubstr("/Full/"), HasSubstr("/Pictures/"))));
  EXPECT_THAT(plan, HasSubstr("/Plain/"));
  Run("", "Full");  // who asks for it gets the message of the stage that finds no image
  EXPECT_THAT(Read("results/room/plan.mk"), HasSubstr("/Full/"));
}

// Formats of others keep their files in folders of their own. Which images there are, an import may
// want to know; what is in them, it does not.
TEST_F(RunPlanTest, FingerprintsFollowTheFiles) {
  Write("room/label_02/0001.txt", "one");
  Run("", "");
  const std::string dataset = Read("results/room/shared/dataset.txt");
  const std::string images = Read("results/room/shared/images.txt");
  EXPECT_THAT(dataset, AllOf(HasSubstr("camera.json"), HasSubstr("rgb.txt"),
                             HasSubstr("label_02/0001.txt 3"), HasSubstr("rgb/0.jpg\n")));
  EXPECT_THAT(images, HasSubstr("rgb/0.jpg"));
  Write("room/rgb/0.jpg", "another image");
  Run("", "");
  EXPECT_EQ(Read("results/room/shared/dataset.txt"), dataset);
  EXPECT_NE(Read("results/room/shared/images.txt"), images);
  for (const auto& change : {std::function([&] { fs::remove(folder_ / "room/camera.json"); }),
                             std::function([&] { Write("room/rgb/1.jpg", "one more image"); })}) {
    const std::string before = Read("results/room/shared/dataset.txt");
    change();
    Run("", "");
    EXPECT_NE(Read("results/room/shared/dataset.txt"), before);
  }
}

TEST_F(RunPlanTest, PlansOnlyTheVariantsAskedFor) {
  Run("lounge", "Plain");
  const std::string makefile = Read("results/lounge/plan.mk");
  EXPECT_THAT(makefile, HasSubstr("\nall: Plain\n"));
  EXPECT_THAT(makefile, testing::Not(HasSubstr("soslam-optimise")));
  EXPECT_TRUE(fs::exists(folder_ / "results/lounge/Plain/stages.txt"));
  EXPECT_FALSE(fs::exists(folder_ / "results/lounge/Mapped"));
}

TEST_F(RunPlanTest, RefusesWhatMakeCannotHandle) {
  for (const char* name : {"my room", "$(shell ls)", "../room", "-n"}) {
    EXPECT_THROW(Run(name, ""), SettingsError) << name;
  }
  for (const char* variant : {"-n", "../variants/Plain"}) {
    EXPECT_THROW(Run("", variant), SettingsError) << variant;
  }
  EXPECT_THROW(RunIn("room", "my results", "", ""), SettingsError);
  EXPECT_THROW(RunIn("no_room", "results", "", ""), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

}  // namespace
}  // namespace soslam
