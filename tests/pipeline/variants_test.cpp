// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "artefact/files.h"
#include "artefact/hdf5_artefact.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr int kVariantsFrames = 10;
constexpr int kObjects = 3;

// Pixels and the edges found in them are what keeps texture symmetry from being exact.
constexpr double kMinIou = 0.99;

json Metrics(const SmallPipeline& pipeline, const std::string& variant,
             int frames = kVariantsFrames) {
  const json metrics = json::parse(FileBytes(pipeline.Results() / variant / "metrics.json"));
  EXPECT_EQ(metrics["summary"]["objects"], kObjects) << variant;
  EXPECT_EQ(metrics["summary"]["observations"], kObjects * frames) << variant;
  return metrics;
}

TEST(VariantsTest, NoiseFreeEllipsoidsWithTheirTrueRatiosAreRecovered) {
  const SmallPipeline pipeline(kVariantsFrames);
  ExpectSuccess(pipeline.Run("SVD Init1-1 InitP InitPT Quadric OursP OursPT"));

  for (const std::string variant : {"InitP", "InitPT"}) {
    const json metrics = Metrics(pipeline, variant);
    EXPECT_GE(metrics["summary"]["iou_mean"], kMinIou) << variant;
    EXPECT_GE(metrics["first_observation"]["iou_mean"], kMinIou) << variant;
  }
  for (const std::string variant : {"OursP", "OursPT"}) {
    const json metrics = Metrics(pipeline, variant);
    EXPECT_GE(metrics["summary"]["iou_mean"], kMinIou) << variant;
    EXPECT_LT(metrics["trajectory"]["ate_rmse_m"], 1e-3) << variant;
  }
  // Without planes and ratios, or with one ratio for all, the method itself sets the limit.
  for (const std::string variant : {"SVD", "Quadric", "Init1-1"}) {
    EXPECT_GT(Metrics(pipeline, variant)["summary"]["iou_mean"], 0.0) << variant;
  }
  EXPECT_LT(Metrics(pipeline, "Init1-1")["summary"]["iou_mean"], 0.9);
}

// The small scene with two cuboids and an ellipsoid, of labels that have these shapes in the
// semantic table. Every frame sees all three whole.
class BodiesOfAnyShapeTest : public testing::Test {
 protected:
  static constexpr int kFrames = 6;

  BodiesOfAnyShapeTest() {
    json scene = SmallScene(kFrames);
    scene["objects"][0].update({{"label", "box"}, {"shape", "box"}});
    scene["objects"][1].update({{"label", "ball"}});
    scene["objects"][2].update({{"label", "crate"},
                                {"shape", "box"},
                                {"half_axes", {0.28, 0.24, 0.32}},
                                {"position", {3.5, 1.05}}});
    const std::filesystem::path scene_file = pipeline_.Folder() / "shapes.json";
    WriteBytes(scene_file, scene.dump());
    ExpectSuccess(RunCommand({StageProgram("synthesise"), "--scene", scene_file.string(),
                              "--output", pipeline_.Dataset().string()}));
  }

  double Metric(const std::string& variant, const char* place) const {
    return Metrics(pipeline_, variant, kFrames).at(json::json_pointer(place));
  }
  double MeanIou(const std::string& variant) const { return Metric(variant, "/summary/iou_mean"); }
  double YawErrorDeg(const std::string& variant) const {
    return Metric(variant, "/summary/yaw_error_deg_mean");
  }
  double AteM(const std::string& variant) const {
    return Metric(variant, "/trajectory/ate_rmse_m");
  }

  SmallPipeline pipeline_{kFrames};
};

// How much better bodies of the right shapes have to be than ellipsoids, at least.
constexpr double kIouGain = 0.2;

TEST_F(BodiesOfAnyShapeTest, ExactBoxesDetermineThem) {
  ExpectSuccess(pipeline_.Run("InitP OursP MultiView InitS OursS"));
  for (const std::string variant : {"MultiView", "InitS", "OursS"}) {
    EXPECT_GE(MeanIou(variant), 0.999) << variant;
    EXPECT_LT(YawErrorDeg(variant), 0.1) << variant;
    EXPECT_GT(MeanIou(variant), MeanIou("InitP") + kIouGain) << variant;
    EXPECT_GT(MeanIou(variant), MeanIou("OursP") + kIouGain) << variant;
  }
  EXPECT_LT(AteM("OursS"), 1e-3);
}

// The edges of the painted texture draw the alignment of single frames away: less exact than boxes
// without noise alone, but all views together are not misled.
TEST_F(BodiesOfAnyShapeTest, ImagesKeepThem) {
  ExpectSuccess(pipeline_.Run("InitP OursP InitSTE OursSTE"));
  EXPECT_GE(MeanIou("InitSTE"), 0.85);
  EXPECT_GT(MeanIou("InitSTE"), MeanIou("InitP") + kIouGain);
  EXPECT_LT(YawErrorDeg("InitSTE"), YawErrorDeg("InitP"));
  EXPECT_GE(MeanIou("OursSTE"), 0.97);
  EXPECT_GT(MeanIou("OursSTE"), MeanIou("OursP") + kIouGain);
  EXPECT_LT(YawErrorDeg("OursSTE"), 1.0);
  EXPECT_LT(AteM("OursSTE"), 1e-3);

  const Sequence sequence = ReadSequence(pipeline_.Results() / "OursSTE/sequence.json");
  const auto records = ReadSymmetry(pipeline_.Results() / "InitSTE/symmetry.h5");
  EXPECT_EQ(records.size(), sequence.detections.size());
  int with_mirror_planes = 0;
  for (const SymmetryRecord& record : records) {
    SCOPED_TRACE(testing::Message()
                 << "frame " << record.frame_id << ", object " << record.object_id);
    EXPECT_FALSE(record.yaw.empty());
    for (const std::string part : {"total", "edge_alignment", "texture_symmetry"}) {
      ASSERT_EQ(record.cost.count(part), 1) << part;
      EXPECT_EQ(record.cost.at(part).size(), record.yaw.size()) << part;
    }
    with_mirror_planes += record.mirror_planes ? 1 : 0;
    ASSERT_TRUE(record.yaw_sigma && record.true_yaw);
    // A yaw that is wrong is not sure of itself.
    EXPECT_LT(std::abs(std::remainder(record.refined_yaw - *record.true_yaw, std::numbers::pi)),
              4.0 * *record.yaw_sigma);
    EXPECT_LE(*record.yaw_sigma, std::numbers::pi / 2.0);
  }
  EXPECT_GE(with_mirror_planes, 3);  // of others a quarter turn hides one of each pair
}

TEST(VariantsTest, ResultsDoNotDependOnThreadsOrFolders) {
  const SmallPipeline one_thread(SmallPipeline::kFrames, 1);
  const SmallPipeline two_threads(SmallPipeline::kFrames, 2);
  for (const SmallPipeline* pipeline : {&one_thread, &two_threads}) {
    pipeline->WriteSettings({{"refine", {{"yaw_step_deg", 15}, {"yaw_grid_deg", 30}}},  // for speed
                             {"optimise", {{"max_iterations", 3}}}});
    ExpectSuccess(pipeline->Run("InitPT OursPT OursSTE"));  // all stages' methods
  }
  for (const char* place : {"data", "results"}) {
    const auto expected = SmallPipeline::Artefacts(one_thread.Folder() / place);
    const auto found = SmallPipeline::Artefacts(two_threads.Folder() / place);
    ASSERT_FALSE(expected.empty());
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [name, bytes] : expected) {
      ASSERT_EQ(found.count(name), 1) << name;
      EXPECT_TRUE(found.at(name) == bytes) << name << " differs";
    }
  }
}

}  // namespace
}  // namespace soslam
