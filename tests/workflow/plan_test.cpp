// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "base/error.h"
#include "dataset/import_options.h"
#include "stage/run_plan.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "workflow/pipeline_settings.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kBase = R"({
  "stages": ["import", "initialise", "evaluate"],
  "import": {}, "edges": {}, "initialise": {}, "refine": {}, "optimise": {}, "evaluate": {}})";

class PlanTest : public testing::Test {
 protected:
  void SetUp() override {
    Write("pipelines/base.json", kBase);
    Write("pipelines/variants/Plain.json", "{}");
    Write("pipelines/variants/Mapped.json",
          R"({"stages": ["import", "initialise", "optimise", "evaluate"]})");
    Write("pipelines/variants/Full.json",
          R"({"stages": ["import", "edges", "initialise", "refine", "optimise", "evaluate"],
              "optimise": {"symmetry": true}})");
  }
  void Write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    WriteBytes(folder_ / name, text);
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
  void ExpectRefused(const std::string& variant, const std::vector<std::string>& parts) const {
    ExpectError<SettingsError>([&] { Make({variant}); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(PlanTest, PointsAreThoseOfTheImportedPoses) {
  Write("pipelines/variants/Points.json",
        R"({"stages": ["import", "track", "initialise", "optimise", "evaluate"],
            "planes": {"planes": "estimated"}, "optimise": {"point_evidence": true}})");
  const Plan plan = Make({"Points"});
  const StageInstance& track = plan.Instance(Id("Points", "track"));
  EXPECT_EQ(track.inputs.at("sequence").instance, Id("Points", "import"));
  const StageInstance& optimise = plan.Instance(Id("Points", "optimise"));
  EXPECT_EQ(optimise.inputs.at("points").instance, track.Id());
  EXPECT_EQ(optimise.inputs.at("points").file, "points.h5");
}

TEST_F(PlanTest, PointEvidenceNeedsTracks) {
  Write("pipelines/variants/Points.json",
        R"({"stages": ["import", "initialise", "optimise", "evaluate"],
            "optimise": {"point_evidence": true}})");
  ExpectRefused("Points", {"Points.json", "point_evidence", "'track'"});
}

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

TEST_F(PlanTest, StagesReadTheLatestLandmarks) {
  const Plan plan = Make({"Plain", "Mapped", "Full"});
  const auto input = [&](size_t variant, const std::string& stage, const std::string& argument) {
    for (const std::string& id : plan.variants[variant].instances) {
      const StageInstance& instance = plan.Instance(id);
      if (instance.stage != stage) continue;
      const auto found = instance.inputs.find(argument);
      return found == instance.inputs.end() ? "" : found->second.file;
    }
    return std::string("no such stage");
  };
  EXPECT_EQ(input(0, "evaluate", "landmarks"), "initial.json");
  EXPECT_EQ(input(1, "optimise", "landmarks"), "initial.json");
  EXPECT_EQ(input(1, "optimise", "edges"), "");
  EXPECT_EQ(input(2, "refine", "initial"), "initial.json");
  EXPECT_EQ(input(2, "refine", "edges"), "edges.h5");
  EXPECT_EQ(input(2, "optimise", "landmarks"), "refined.json");
  EXPECT_EQ(input(2, "optimise", "edges"), "edges.h5");
  EXPECT_EQ(input(2, "evaluate", "landmarks"), "map.json");
}

TEST_F(PlanTest, EstimatedAssociationReplacesTheObjectsOfTheImport) {
  const std::vector<std::string> given = Make({"Full"}).variants[0].instances;
  EXPECT_EQ(Id("Full", "associate"), "");
  Write("pipelines/datasets/room.json", R"({"associate": {"association": "estimated"}})");
  const Plan plan = Make({"Full"});
  const std::vector<std::string>& estimated = plan.variants[0].instances;
  ASSERT_EQ(estimated.size(), given.size() + 1);
  EXPECT_EQ(estimated[0], given[0]);  // import
  EXPECT_EQ(plan.Instance(estimated[1]).stage, "associate");
  EXPECT_EQ(plan.Instance(estimated[1]).inputs.at("sequence").instance, given[0]);
  EXPECT_FALSE(plan.Instance(estimated[1]).semantic_table.empty());
  EXPECT_EQ(estimated[2], given[1]);  // edges: of the same images
  for (size_t i = 3; i < estimated.size(); ++i) {
    const ArtefactSource& sequence = plan.Instance(estimated[i]).inputs.at("sequence");
    EXPECT_EQ(sequence.instance, estimated[1]);
    EXPECT_EQ(sequence.file, "sequence.json");
    EXPECT_NE(estimated[i], given[i - 1]);
  }
}

TEST_F(PlanTest, AWorldWithoutUpAndScaleGetsThemBeforeAssociation) {
  EXPECT_EQ(Id("Full", "ground"), "");
  Write("pipelines/datasets/room.json",
        R"({"ground": {"ground": "estimated"}, "associate": {"association": "estimated"}})");
  const Plan plan = Make({"Full"});
  const auto inputs_of = [&](const std::string& stage) {
    return plan.Instance(Id("Full", stage)).inputs;
  };
  EXPECT_EQ(inputs_of("ground").at("sequence").instance, Id("Full", "import"));
  EXPECT_EQ(inputs_of("associate").at("sequence").instance, Id("Full", "ground"));
  EXPECT_EQ(inputs_of("initialise").at("sequence").instance, Id("Full", "associate"));
  EXPECT_EQ(inputs_of("edges").at("sequence").instance, Id("Full", "import"));
}

TEST_F(PlanTest, SettingsOfAnAssociationThatDoesNotRunDoNotMatter) {
  const std::string initialise = Id("Plain", "initialise");
  Write("pipelines/datasets/room.json", R"({"associate": {"min_observations": 5}})");
  EXPECT_EQ(Id("Plain", "initialise"), initialise);
  Write("pipelines/datasets/room.json", R"({"associate": {"min_observations": 0}})");
  ExpectRefused("Plain", {"room.json", "associate", "min_observations"});
}

TEST_F(PlanTest, PlanesAreAStageWhereASettingAsksForThem) {
  EXPECT_EQ(Id("Mapped", "planes"), "");
  const std::string import = Id("Mapped", "import");
  const std::string edges = Id("Full", "edges");
  Write("pipelines/datasets/room.json", R"({"planes": {"planes": "estimated"}})");
  const std::string planes = Id("Mapped", "planes");
  EXPECT_NE(planes, "");
  EXPECT_EQ(Id("Mapped", "import"), import);
  EXPECT_EQ(Id("Full", "edges"), edges);  // images do not depend on planes
  const Plan plan = Make({"Full"});
  const auto sequence_of = [&](const std::string& stage) {
    return plan.Instance(Id("Full", stage)).inputs.at("sequence").instance;
  };
  EXPECT_EQ(sequence_of("planes"), import);
  EXPECT_EQ(sequence_of("edges"), import);
  for (const char* stage : {"initialise", "refine", "optimise", "evaluate"}) {
    EXPECT_EQ(sequence_of(stage), planes) << stage;
  }
  EXPECT_FALSE(plan.Instance(planes).semantic_table.empty());
}

TEST_F(PlanTest, PlanesAreOfTheObjectsThatAssociationFound) {
  Write("pipelines/datasets/room.json",
        R"({"associate": {"association": "estimated"}, "planes": {"planes": "estimated"}})");
  const std::string associate = Id("Full", "associate");
  const std::string planes = Id("Full", "planes");
  const Plan plan = Make({"Full"});
  EXPECT_EQ(plan.Instance(planes).inputs.at("sequence").instance, associate);
  EXPECT_EQ(plan.Instance(Id("Full", "initialise")).inputs.at("sequence").instance, planes);
}

TEST_F(PlanTest, StagesThatASettingAsksForAreNotListed) {
  for (const std::string stage : {"ground", "planes", "associate"}) {
    Write("pipelines/variants/Listed.json",
          R"({"stages": ["import", ")" + stage + R"(", "initialise", "evaluate"]})");
    ExpectRefused("Listed", {"Listed.json", stage, "expected one of import, edges"});
  }
}

TEST_F(PlanTest, InputsComeBeforeWhatReadsThem) {
  std::set<std::string> seen;
  for (const StageInstance& instance : Make({"Full", "Plain"}).instances) {
    for (const auto& [argument, source] : instance.inputs) {
      EXPECT_EQ(seen.count(source.instance), 1u) << instance.Id() << " " << argument;
    }
    seen.insert(instance.Id());
  }
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
        R"({"refine": {"yaw_step_deg": 5}, "import": {"border_px": 30}, "description": "x"})");
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

TEST_F(PlanTest, NullTakesASettingBackToItsDefault) {
  Write("pipelines/datasets/room.json", R"({"import": {"frame_stride": 7}})");
  Write("pipelines/variants/Plain.json", R"({"import": {"frame_stride": null}})");
  EXPECT_EQ(ReadVariant(folder_ / "pipelines", "room", "Plain").options["import"]["frame_stride"],
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
      {R"({"stages": ["import", "import"]})", "twice"},
      {R"({"stages": []})", "stages"},
      {R"({"stages": null})", "stages"},
      {R"({"stages": ["initialise"]})", "needs stage 'import'"},
      {R"({"stages": ["import", "initialise", "refine"]})", "needs stage 'edges'"},
      {R"({"stages": ["import", "initialise", "optimise"], "optimise": {"symmetry": true}})",
       "need stage 'edges'"},
      {R"({"semantic_table": 3})", "semantic_table"},
      {R"({"extends": 3})", "extends"},
      {R"({"extends": "Bad"})", "leads back"},
      {"[]", "object"},
      {"{", ""}};
  for (const auto& [text, part] : cases) {
    Write("pipelines/variants/Bad.json", text);
    ExpectRefused("Bad", {"variants/Bad.json", part});
  }
  ExpectRefused("Missing", {"variants/Missing.json", "known are Bad, Full, Mapped, Plain"});
  Write("pipelines/variants/Bad.json", R"({"extends": "Nowhere"})");
  ExpectRefused("Bad", {"variants/Nowhere.json"});
  Write("pipelines/datasets/room.json", R"({"extends": "Plain"})");
  ExpectRefused("Full", {"datasets/room.json", "'extends' is for variants only"});
  Write("pipelines/datasets/room.json", R"({"import": {"unheard_of": 1}})");
  ExpectRefused("Plain", {"datasets/room.json: import", "unheard_of"});
}

TEST_F(PlanTest, EveryShippedVariantIsValid) {
  const fs::path pipelines = fs::path(SOSLAM_SOURCE_DIR) / "pipelines";
  const std::vector<std::string> names = VariantNames(pipelines);
  EXPECT_GE(names.size(), 7u);
  for (const char* dataset : {"room_a", "kitti_tracking", "kitti_object"}) {
    for (const StageInstance& instance : MakePlan(pipelines, dataset, names).instances) {
      if (!instance.semantic_table.empty()) {
        EXPECT_TRUE(fs::exists(pipelines / instance.semantic_table)) << instance.Id();
      }
    }
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
  Run("", "");
  EXPECT_THAT(Read("results/room/plan.mk"), HasSubstr("/Full/"));
  fs::remove(folder_ / "room/rgb/0.jpg");
  Run("", "");
  const std::string plan = Read("results/room/plan.mk");
  EXPECT_THAT(plan, Not(HasSubstr("/Full/")));
  EXPECT_THAT(plan, HasSubstr("/Plain/"));
  Run("", "Full");  // who asks for it gets the message of the stage that finds no image
  EXPECT_THAT(Read("results/room/plan.mk"), HasSubstr("/Full/"));
}

TEST_F(RunPlanTest, FingerprintsFollowTheFiles) {
  Run("", "");
  const std::string dataset = Read("results/room/shared/dataset.txt");
  const std::string images = Read("results/room/shared/images.txt");
  EXPECT_THAT(dataset, AllOf(HasSubstr("camera.json"), HasSubstr("rgb.txt")));
  EXPECT_THAT(images, HasSubstr("rgb/0.jpg"));
  Write("room/rgb/0.jpg", "another image");
  Run("", "");
  EXPECT_EQ(Read("results/room/shared/dataset.txt"), dataset);
  EXPECT_NE(Read("results/room/shared/images.txt"), images);
  fs::remove(folder_ / "room/camera.json");
  Run("", "");
  EXPECT_NE(Read("results/room/shared/dataset.txt"), dataset);
}

// Formats of others keep their files in folders of their own. Which images there are, an import may
// want to know; what is in them, it does not.
TEST_F(RunPlanTest, FingerprintsFollowFilesInFolders) {
  fs::create_directories(folder_ / "room/label_02");
  Write("room/label_02/0001.txt", "one");
  Run("", "");
  const std::string dataset = Read("results/room/shared/dataset.txt");
  EXPECT_THAT(dataset, AllOf(HasSubstr("label_02/0001.txt 3"), HasSubstr("rgb/0.jpg\n")));
  Write("room/rgb/0.jpg", "another image");
  Run("", "");
  EXPECT_EQ(Read("results/room/shared/dataset.txt"), dataset);
  Write("room/rgb/1.jpg", "one more image");
  Run("", "");
  EXPECT_NE(Read("results/room/shared/dataset.txt"), dataset);
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
  EXPECT_THROW(Run("my room", ""), SettingsError);
  EXPECT_THROW(Run("$(shell ls)", ""), SettingsError);
  EXPECT_THROW(Run("../room", ""), SettingsError);
  EXPECT_THROW(Run("-n", ""), SettingsError);
  EXPECT_THROW(Run("", "-n"), SettingsError);
  EXPECT_THROW(Run("", "../variants/Plain"), SettingsError);
  EXPECT_THROW(RunIn("room", "my results", "", ""), SettingsError);
  EXPECT_THROW(RunIn("no_room", "results", "", ""), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

}  // namespace
}  // namespace soslam
