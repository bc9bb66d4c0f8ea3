// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/refine_by_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/synthesis/render.h"
#include "support/drawn_cuboids.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

// Three textured boxes on a floor, none along the world's axes, that a camera drives past.
Scene BoxScene() {
  Scene scene;
  scene.camera = {640, 480, 533.0, 533.0, 319.5, 239.5};
  scene.planes.push_back({0, "floor", Plane{}, std::nullopt});
  scene.objects = {
      {1, "box", Shape::kBox, {0.30, 0.50, 0.25}, {2.9, 0.1}, 150.0 * kRadPerDeg, 0, 1},
      {2, "box", Shape::kBox, {0.22, 0.30, 0.36}, {3.1, -1.1}, -165.0 * kRadPerDeg, 0, 2},
      {3, "box", Shape::kBox, {0.40, 0.30, 0.46}, {3.8, 1.2}, 205.0 * kRadPerDeg, 0, 3}};
  scene.trajectory.frames = 4;
  scene.trajectory.waypoints = {{{0.3, -0.7, 1.15}, {3.2, 0.0, 0.4}},
                                {{0.4, 0.0, 1.12}, {3.2, 0.0, 0.4}},
                                {{0.3, 0.7, 1.15}, {3.2, 0.0, 0.4}}};
  return scene;
}

using Frames = std::vector<std::shared_ptr<const FrameEdges>>;

class RefineBoxes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Scene scene = BoxScene();
    sequence_ = new Sequence(SyntheticSequence(scene, false));
    sequence_->planes.front().scene_axis_in_world = Eigen::Vector3d::UnitX();
    for (const Frame& frame : sequence_->frames) {
      cv::Mat grey;
      cv::cvtColor(RenderFrame(scene, frame.world_from_camera), grey, cv::COLOR_BGR2GRAY);
      edges_->push_back(std::make_shared<const FrameEdges>(ComputeEdgeMaps(grey, EdgesOptions())));
    }
  }
  static void TearDownTestSuite() {
    delete sequence_;
    delete edges_;
  }

  static const Detection& DetectionAt(int index) { return sequence_->detections[index]; }
  static Landmark TrueLandmark(const Detection& detection) {
    return *TrueLandmarkInCamera(*sequence_, detection);
  }
  static int Observations() { return static_cast<int>(sequence_->detections.size()); }
  // In images of all frames.
  static RefinedObservation RefineIn(const Frames& maps, int index, const ProfileOptions& options,
                                     const std::optional<PointEvidence>& points = std::nullopt) {
    const Eigen::Vector3d half_axes = TrueLandmark(DetectionAt(index)).half_axes;
    const ShapePrior prior{half_axes.head<2>() / half_axes.z(), {0.02, 0.02}, kCuboidExponent};
    return RefineByProfile(*sequence_, index, maps[DetectionAt(index).frame_index], prior, options,
                           SymmetryOptions(), points);
  }
  static RefinedObservation Refine(int index, const ProfileOptions& options) {
    return RefineIn(*edges_, index, options);
  }
  // The same boxes with faces of one grey each.
  static Frames PlainMaps() {
    std::vector<std::vector<Landmark>> boxes(sequence_->frames.size());
    for (const Detection& detection : sequence_->detections) {
      boxes[detection.frame_index].push_back(TrueLandmark(detection));
    }
    Frames maps;
    for (std::vector<Landmark>& of_frame : boxes) {
      std::ranges::sort(of_frame, [](const Landmark& one, const Landmark& other) {
        return one.Centre().z() > other.Centre().z();  // nearer ones in front
      });
      maps.push_back(std::make_shared<const FrameEdges>(
          ComputeEdgeMaps(DrawCuboids(sequence_->camera, of_frame), EdgesOptions())));
    }
    return maps;
  }

  // Boxes off the world's axes are not expected along them.
  static ProfileOptions OffAxesOptions() {
    ProfileOptions options;
    options.upright.axes_weight = 0.0;
    return options;
  }
  static double YawError(const RefinedObservation& refined) {
    return YawDifferenceModuloPi(refined.record.refined_yaw, *refined.record.true_yaw);
  }
  static void ExpectTruth(int index, const RefinedObservation& refined, double max_yaw_error,
                          double min_iou) {
    SCOPED_TRACE(index);
    ASSERT_EQ(refined.estimate.failure, "");
    EXPECT_EQ(refined.estimate.detection_index, index);
    const Landmark& found = refined.estimate.hypotheses.front().landmark_in_camera;
    EXPECT_EQ(found.shape_exponents, kCuboidExponent);
    EXPECT_LT(std::abs(YawError(refined)), max_yaw_error);
    EXPECT_GT(BoxIou(found, TrueLandmark(DetectionAt(index))), min_iou);
  }

  static inline Sequence* sequence_ = nullptr;
  static inline Frames* edges_ = new Frames;
};

// Without texture the edges in the image are the body's own.
TEST_F(RefineBoxes, FindsTheYawOfPlainBoxesByTheirEdges) {
  ProfileOptions options = OffAxesOptions();
  options.texture_symmetry = false;
  const Frames plain = PlainMaps();
  for (int i = 0; i < Observations(); ++i) {
    ExpectTruth(i, RefineIn(plain, i, options), 0.5 * kRadPerDeg, 0.98);
  }
}

TEST_F(RefineBoxes, FindsTheYawOfTexturedBoxesByTheirTexture) {
  ProfileOptions options = OffAxesOptions();
  options.edge_alignment = false;
  for (int i = 0; i < Observations(); ++i) {
    ExpectTruth(i, Refine(i, options), 1.0 * kRadPerDeg, 0.97);
  }
}

// A box alone has two yaws.
TEST_F(RefineBoxes, FindsTheYawByPointsOnTheirFaces) {
  ProfileOptions options = OffAxesOptions();
  options.edge_alignment = false;
  options.texture_symmetry = false;
  options.points.point_range_fraction = 0.0;
  for (int i = 0; i < Observations(); ++i) {
    const Landmark truth = TrueLandmark(DetectionAt(i));
    PointEvidence evidence{{}, SizeForPoints(truth), 1.0, options.points};
    for (int k = 0; k < 60; ++k) {
      Eigen::Vector3d in_object = truth.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
      in_object[k % 3] = std::copysign(truth.half_axes[k % 3], in_object[k % 3]);
      evidence.points.push_back({truth.frame_from_object * in_object});
    }
    ExpectTruth(i, RefineIn(*edges_, i, options, evidence), 1.0 * kRadPerDeg, 0.98);
  }
}

// Edges of the painting that run along those of the body draw the alignment away, by no more than
// the profile says of itself: without them, see above, the same boxes are found exactly.
TEST_F(RefineBoxes, FindsTheYawOfTexturedBoxes) {
  for (int i = 0; i < Observations(); ++i) {
    const RefinedObservation refined = Refine(i, OffAxesOptions());
    ExpectTruth(i, refined, 6.0 * kRadPerDeg, 0.88);
    EXPECT_LT(std::abs(YawError(refined)), 2.5 * *refined.record.yaw_sigma) << i;
    EXPECT_FALSE(refined.record.yaw.empty());
    for (const std::string part : {"total", "edge_alignment", "texture_symmetry"}) {
      ASSERT_EQ(refined.record.cost.count(part), 1) << part;
      EXPECT_EQ(refined.record.cost.at(part).size(), refined.record.yaw.size()) << part;
    }
  }
}

TEST_F(RefineBoxes, AreDrawnToTheScenesAxesAsMuchAsTheirPreferenceWeighs) {
  const Frames plain = PlainMaps();
  for (const int i : {3, 4, 5}) {  // one of each box
    const double true_yaw =        // in the world
        BoxScene().objects[DetectionAt(i).object_index].yaw;
    const auto from_axes = [&](double weight) {
      ProfileOptions options;
      options.texture_symmetry = false;
      options.upright.axes_weight = weight;
      const double yaw = true_yaw + YawError(RefineIn(plain, i, options));
      return std::abs(std::remainder(yaw, 0.5 * std::numbers::pi));
    };
    const double without = from_axes(0.0);
    const double by_default = from_axes(UprightOptions().axes_weight);
    EXPECT_LT(by_default, without) << i;
    EXPECT_GT(by_default, without - 2.0 * kRadPerDeg) << i;
    EXPECT_LT(from_axes(100.0), 0.8 * without) << i;
  }
}

// The renderer's textures are symmetric in the xz plane alone.
TEST_F(RefineBoxes, RecognisesTheMirrorPlaneOfTheTexture) {
  int recognised = 0;
  for (size_t i = 0; i < sequence_->detections.size(); ++i) {
    const auto planes = Refine(static_cast<int>(i), ProfileOptions()).record.mirror_planes;
    EXPECT_EQ(planes.value_or(1), 1) << i;
    recognised += planes ? 1 : 0;
  }
  EXPECT_GE(recognised, 3);  // from the others, a quarter turn hides one of each pair
}

TEST_F(RefineBoxes, NeedsAPrior) {
  const RefinedObservation refined = RefineByProfile(*sequence_, 0, edges_->front(), std::nullopt,
                                                     ProfileOptions(), SymmetryOptions());
  EXPECT_EQ(refined.estimate.failure, "no_ratio_for_label");
  EXPECT_TRUE(refined.estimate.hypotheses.empty());
  EXPECT_TRUE(refined.record.true_yaw);
}

}  // namespace
}  // namespace soslam
