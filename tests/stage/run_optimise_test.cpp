// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/evaluation/metrics.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr int kObjects = 4;

// The stage on cuboids that start from the truth, and a semantic table of the test's.
class RunOptimiseTest : public FolderTest {
 protected:
  RunOptimiseTest() {
    options_.detection_model = DetectionModel::kTangency;
    options_.upright.axes_weight = 0.0;  // random yaws
    options_.covariances = false;
    LandmarkEstimates truth;
    truth.observations.resize(sequence_.detections.size());
    for (size_t i = 0; i < truth.observations.size(); ++i) {
      truth.observations[i] = {static_cast<int>(i), {}, "not_tried"};
    }
    for (int i = 0; i < kObjects; ++i) {
      truth.objects.push_back({i, 1, TrueLandmark(i), {}, "", false});
    }
    WriteSequence(File("sequence"), sequence_, {});
    WriteLandmarks(File("landmarks"), truth, sequence_, {{}, {File("sequence")}});
  }

  std::filesystem::path File(const std::string& name) const { return folder_ / (name + ".json"); }
  const Landmark& TrueLandmark(int object_index) const {
    return sequence_.objects[object_index].ground_truth->landmark_in_world;
  }
  // Gives each object's label its true ratio, a / c times a factor, known to a twentieth.
  void WriteTable(double shape_exponent, double factor_of_a) const {
    json labels;
    for (int i = 0; i < kObjects; ++i) {
      const Eigen::Vector3d& half_axes = TrueLandmark(i).half_axes;
      labels[sequence_.objects[i].label] = {{"a_by_c", factor_of_a * half_axes.x() / half_axes.z()},
                                            {"b_by_c", half_axes.y() / half_axes.z()},
                                            {"a_by_c_log_sigma", 0.05},
                                            {"b_by_c_log_sigma", 0.05},
                                            {"shape_exponent", shape_exponent},
                                            {"source", "the test"}};
    }
    WriteBytes(File("table"), json{{"labels", labels}}.dump());
  }
  MapEstimate Run() const {
    StageFiles files;
    for (const char* name : {"sequence", "landmarks", "table", "output"}) files[name] = File(name);
    if (options_.points.point_evidence) files["points"] = File("points");
    RunOptimise(options_, files, 1);
    return ReadMap(File("output"), sequence_);
  }
  double MeanIou(const MapEstimate& map) const {
    return EvaluateMap(sequence_, map).summary.iou_mean.value();
  }

  // One point that frames of these ids see.
  void WritePoint(const std::vector<int>& frame_ids) const {
    MapPoint point{Eigen::Vector3d::Zero(), 0.5, {}};
    for (const int id : frame_ids) point.observations.push_back({id, {10.0, 10.0}});
    WritePoints(File("points"), {point}, {});
  }

  OptimiseOptions options_;
  Sequence sequence_ = CuboidSequence(kObjects, 12);
};

TEST_F(RunOptimiseTest, ShapeIsTheTablesOrTheOptions) {
  for (const double of_table : {kCuboidExponent, kEllipsoidExponent}) {
    WriteTable(of_table, /*factor_of_a=*/1.0);
    for (const auto& [shape, expected] : {std::pair(ShapeSource::kTable, of_table),
                                          {ShapeSource::kCuboid, kCuboidExponent},
                                          {ShapeSource::kEllipsoid, kEllipsoidExponent}}) {
      options_.shape = shape;
      const MapEstimate map = Run();
      SCOPED_TRACE(testing::Message() << "of table " << of_table << ", expected " << expected);
      for (const ObjectEstimate& object : map.objects) {
        EXPECT_EQ(object.landmark_in_world->shape_exponents, expected);
      }
      // The boxes are those of cuboids.
      if (expected == kCuboidExponent) {
        EXPECT_GT(MeanIou(map), 0.99);
      } else {
        EXPECT_LT(MeanIou(map), 0.5);
      }
    }
  }
}

// The true ratios tell the axes of cuboids that are longer than wide; no ratios tell nothing.
TEST_F(RunOptimiseTest, MapsSayHowProbableAQuarterTurnIs) {
  WriteTable(kCuboidExponent, /*factor_of_a=*/1.0);
  for (const ObjectEstimate& object : Run().objects) {
    EXPECT_LT(object.quarter_turn.value(), 0.5);
  }
  options_.ratio = false;
  for (const ObjectEstimate& object : Run().objects) {
    EXPECT_NEAR(object.quarter_turn.value(), 0.5, 0.01);
  }
  options_.detection_model = DetectionModel::kQuadric;
  for (const ObjectEstimate& object : Run().objects) EXPECT_FALSE(object.quarter_turn);
}

TEST_F(RunOptimiseTest, SymmetryNeedsADescriptorWithADerivative) {
  options_.symmetry = true;
  const StageFiles files = {{"edges", "edges.h5"}};
  for (const Descriptor descriptor : {Descriptor::kBrief, Descriptor::kFreak}) {
    options_.symmetry_options.descriptor = descriptor;
    ExpectError<SettingsError>([&] { RunOptimise(options_, files, 1); },
                               {"derivative", kDescriptorNames[static_cast<size_t>(descriptor)]});
  }
}

TEST_F(RunOptimiseTest, LandmarksOfAnotherSequenceAreRefused) {
  WriteTable(kCuboidExponent, /*factor_of_a=*/1.0);
  sequence_.detections.front().score = 0.25;
  WriteSequence(File("sequence"), sequence_, {});
  const std::vector<std::string> words = {"landmarks.json: was not made of", "sequence.json"};
  ExpectError<InputError>([&] { Run(); }, words);
  const StageFiles files = {{"sequence", File("sequence")},
                            {"landmarks", File("landmarks")},
                            {"output", File("metrics")}};
  ExpectError<InputError>([&] { RunEvaluate({}, files, 1); }, words);
  EXPECT_FALSE(std::filesystem::exists(File("metrics")));
  const StageFiles refined = {{"sequence", File("sequence")},
                              {"initial", File("landmarks")},
                              {"table", File("table")},
                              {"edges", File("edges")}};
  ExpectError<InputError>([&] { RunRefine({}, refined, 1); }, words);
}

TEST_F(RunOptimiseTest, PointsOfOtherFramesAreRefused) {
  WriteTable(kCuboidExponent, /*factor_of_a=*/1.0);
  options_.points.point_evidence = true;
  WritePoint({90001, 90002});
  ExpectError<InputError>([&] { Run(); }, {"points", "none of 1 points", "sequence", "another"});
  WritePoint({sequence_.frames[0].id, 90002});
  EXPECT_EQ(Run().solver.gated.at("objects_without_points"), kObjects);
}

TEST_F(RunOptimiseTest, AWrongRatioPullsOnlyWhereRatiosCount) {
  WriteTable(kCuboidExponent, /*factor_of_a=*/1.5);
  options_.ratio = true;
  const MapEstimate with = Run();
  options_.ratio = false;
  const MapEstimate without = Run();
  EXPECT_EQ(with.solver.residuals.at("ratio"), kObjects);
  EXPECT_EQ(without.solver.residuals.count("ratio"), 0u);
  EXPECT_GT(MeanIou(without), 0.99);
  EXPECT_LT(MeanIou(with), 0.7);
  // A body turned by a quarter with a and b exchanged is the same: only a ratio tells its front.
  const auto ratio = [](const Landmark& landmark) {
    return landmark.half_axes.head<2>().prod() / std::pow(landmark.half_axes.z(), 2);
  };
  for (size_t i = 0; i < kObjects; ++i) {
    const double truth = ratio(TrueLandmark(static_cast<int>(i)));
    EXPECT_NEAR(ratio(*without.objects[i].landmark_in_world), truth, 0.01 * truth) << i;
    EXPECT_GT(ratio(*with.objects[i].landmark_in_world), 1.3 * truth) << i;
  }
}

}  // namespace
}  // namespace soslam
