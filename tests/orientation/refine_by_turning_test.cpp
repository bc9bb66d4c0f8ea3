// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/refine_by_turning.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "soslam/geometry/angles.h"
#include "soslam/orientation/texture_asymmetry.h"
#include "soslam/synthesis/render.h"
#include "soslam/synthesis/scene.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

// The shipped scene of textured ellipsoids, seen from within 60 degrees of their fronts.
class SyntheticTexture : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new Scene(ReadScene(SOSLAM_SOURCE_DIR "/pipelines/scenes/ellipsoids.json"));
    sequence_ = new Sequence(SyntheticSequence(*scene_, false));
    // Every third frame: rendering takes most of the time of this test.
    for (size_t i = 0; i < sequence_->frames.size(); i += 3) {
      cv::Mat grey;
      cv::cvtColor(RenderFrame(*scene_, sequence_->frames[i].world_from_camera), grey,
                   cv::COLOR_BGR2GRAY);
      (*maps_)[static_cast<int>(i)] = ComputeEdgeMaps(grey, EdgesOptions());
    }
  }
  static void TearDownTestSuite() {
    delete scene_;
    delete sequence_;
  }

  static Landmark TrueLandmark(const Detection& detection) {
    return *TrueLandmarkInCamera(*sequence_, detection);
  }

  static inline Scene* scene_ = nullptr;
  static inline Sequence* sequence_ = nullptr;
  static inline std::map<int, EdgeMaps>* maps_ = new std::map<int, EdgeMaps>;
};

// The cost over yaw of Improved-DT has its global minimum within 3 degrees of the truth on at least
// 90 % of the observations.
TEST_F(SyntheticTexture, ImprovedDtIsLowestAtTheTrueYaw) {
  const SymmetryOptions options;
  int observations = 0;
  int near_truth = 0;
  for (const Detection& detection : sequence_->detections) {
    const auto maps = maps_->find(detection.frame_index);
    if (maps == maps_->end()) continue;
    const SymmetryImage image(maps->second, detection.box);
    const Landmark truth = TrueLandmark(detection);
    const auto samples = SamplePixels(image, sequence_->camera, truth, options);
    double best = 1e9;
    int best_turn_deg = 90;
    for (int turn_deg = -90; turn_deg < 90; ++turn_deg) {
      const Landmark turned = RotatedAboutZ(truth, turn_deg * kRadPerDeg);
      const auto costs = SymmetryCosts(image, sequence_->camera, turned, samples,
                                       {Descriptor::kImprovedDt}, options);
      if (costs.front().value_or(1e9) >= best) continue;
      best = *costs.front();
      best_turn_deg = turn_deg;
    }
    ++observations;
    near_truth += std::abs(best_turn_deg) <= 3 ? 1 : 0;
  }
  EXPECT_GE(observations, 30);
  EXPECT_GE(near_truth, 0.9 * observations) << observations;
}

// Nearest edges on the surface by what the definition says, edge by edge.
TEST_F(SyntheticTexture, NearestEdge3dIsTheNearestOfAll) {
  const Detection& detection = sequence_->detections.front();
  const SymmetryImage image(maps_->at(0), detection.box);
  const Landmark landmark = TrueLandmark(detection);
  const VisibleSurface surface(sequence_->camera, landmark);
  const auto distance = [&](const VisibleSurface::Point& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& pixel : image.edge_pixels) {
      const auto edge = surface.FromPixel(pixel);
      if (edge) nearest = std::min(nearest, (edge->in_object - point.in_object).norm());
    }
    return nearest;
  };
  const SymmetryDescriptor descriptor(Descriptor::kNearestEdge3d, image, sequence_->camera,
                                      landmark);
  int pairs = 0;
  for (const Eigen::Vector2d& pixel :
       SamplePixels(image, sequence_->camera, landmark, SymmetryOptions())) {
    const auto pair = descriptor.Evaluate(pixel, std::nullopt, false);
    if (!pair) continue;
    const auto point = surface.FromPixel(pixel);
    EXPECT_NEAR(pair->residual, distance(*point) - distance(surface.MirrorImage(*point)), 1e-12);
    ++pairs;
  }
  EXPECT_GT(pairs, 20);
}

TEST_F(SyntheticTexture, RefinementTurnsADisturbedLandmarkBackAndRecordsAllCurves) {
  std::vector<double> errors;
  for (size_t i = 0; i < sequence_->detections.size(); ++i) {
    const Detection& detection = sequence_->detections[i];
    const auto maps = maps_->find(detection.frame_index);
    if (maps == maps_->end() || detection.frame_index % 2 == 1) continue;
    const Landmark truth = TrueLandmark(detection);
    const Landmark disturbed = RotatedAboutZ(truth, 6.0 * kRadPerDeg);
    const Eigen::Vector2d ratio = truth.half_axes.head<2>() / truth.half_axes.z();
    const RefinedObservation refined =
        RefineByTurning(*sequence_, {static_cast<int>(i), {{disturbed, 0.0}}, ""}, maps->second,
                        ratio, RefineOptions());
    ASSERT_EQ(refined.estimate.failure, "");
    ASSERT_EQ(refined.estimate.hypotheses.size(), 1u);
    EXPECT_EQ(refined.record.cost.size(), kDescriptorNames.size());
    for (const auto& [name, costs] : refined.record.cost) {
      EXPECT_EQ(costs.size(), refined.record.yaw.size()) << name;
    }
    EXPECT_NEAR(YawDifferenceModuloPi(refined.record.initial_yaw, *refined.record.true_yaw),
                6.0 * kRadPerDeg, 1e-6);
    errors.push_back(
        std::abs(YawDifferenceModuloPi(refined.record.refined_yaw, *refined.record.true_yaw)));
  }
  ASSERT_GE(errors.size(), 15u);
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                   errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1.0 * kRadPerDeg);
}

TEST_F(SyntheticTexture, SamplesLieInTheBoxOnTheLandmark) {
  const Detection& detection = sequence_->detections.front();
  const Landmark truth = TrueLandmark(detection);
  const SymmetryImage image(maps_->at(0), detection.box);
  SymmetryOptions options;
  options.max_corners = 10;
  options.uniform_columns = 4;
  const auto count = [&](Sampling sampling) {
    options.sampling = sampling;
    const auto samples = SamplePixels(image, sequence_->camera, truth, options);
    for (const auto& pixel : samples) {
      EXPECT_TRUE(detection.box.Contains(pixel));
      EXPECT_TRUE(VisibleSurface(sequence_->camera, truth).FromPixel(pixel));
    }
    return samples.size();
  };
  const size_t corners = count(Sampling::kCorners);
  const size_t uniform = count(Sampling::kUniform);
  EXPECT_EQ(corners, 10u);
  EXPECT_GE(uniform, 8u);  // an ellipse fills pi/4 of its box
  EXPECT_LE(uniform, 16u);
  EXPECT_EQ(count(Sampling::kCornersAndUniform), corners + uniform);
}

TEST(RefineByTurning, IsUndefinedWithoutEdgesAndSaysSo) {
  EdgeMaps maps = ComputeEdgeMaps(cv::Mat(480, 640, CV_8UC1, cv::Scalar(100)), EdgesOptions());
  const Landmark landmark{{UprightRotation({0, -1, 0}, 0.3), {0, 0, 3}}, {0.5, 0.4, 0.6}};
  Sequence sequence;
  sequence.camera = TestCamera();
  sequence.frames.resize(1);
  sequence.objects.resize(1);
  sequence.detections = {
      {0, 0, 1.0, *OutlineBox(TestCamera(), landmark), {{0, -1, 0}, 0.6}, {}, {}}};
  const RefinedObservation refined = RefineByTurning(sequence, {0, {{landmark, 0.0}}, ""}, maps,
                                                     Eigen::Vector2d(0.8, 0.7), RefineOptions());
  EXPECT_EQ(refined.estimate.failure, "no_edges");
  ASSERT_EQ(refined.estimate.hypotheses.size(), 1u);
  for (const char* descriptor : {"improved_dt", "nearest_edge_3d"}) {
    for (const double cost : refined.record.cost.at(descriptor)) EXPECT_TRUE(std::isnan(cost));
  }
}

}  // namespace
}  // namespace soslam
