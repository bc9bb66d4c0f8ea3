// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/single_frame.h"

#include <gtest/gtest.h>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/svd.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

// A landmark on a floor 1 m below a camera that looks down a little, at a yaw about the floor's
// normal.
struct Standing {
  explicit Standing(double yaw, const Eigen::Vector3d& half_axes) {
    const Eigen::Vector3d up = Eigen::Vector3d(0.05, -1.0, -0.3).normalized();
    observation.camera = TestCamera();
    observation.plane_in_camera = {up, 1.0};
    observation.ratio = half_axes.head<2>() / half_axes.z();
    const Eigen::Vector3d foot = 3.0 * observation.camera.Ray({300, 290});
    truth.half_axes = half_axes;
    truth.frame_from_object.rotation = UprightRotation(up, yaw);
    truth.frame_from_object.translation =
        foot + (half_axes.z() - observation.plane_in_camera.SignedDistance(foot)) * up;
    observation.box = *OutlineBox(observation.camera, truth);
  }
  SingleFrameObservation observation;
  Landmark truth;
};

bool Contains(const std::vector<Hypothesis>& hypotheses, const Landmark& truth) {
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& hypothesis) {
    return BoxIou(hypothesis.landmark_in_camera, truth) > 0.999;
  });
}

TEST(SingleFrame, FindsTheTruthAmongTheYawsThatExplainTheBoxAtAnyYaw) {
  for (int degrees = -90; degrees < 90; degrees += 6) {
    const Standing standing(degrees * kRadPerDeg, {0.4, 0.2, 0.3});
    const auto solution = InitialiseFromSingleFrame(standing.observation, SingleFrameOptions());
    EXPECT_TRUE(Contains(solution.hypotheses, standing.truth)) << degrees;
    EXPECT_LE(solution.hypotheses.size(), 4u) << degrees;
    EXPECT_LT(
        OutlineEdgeRms(standing.observation.camera, solution.hypotheses.front().landmark_in_camera,
                       standing.observation.box),
        1e-3)
        << degrees;
  }
}

TEST(SingleFrame, BreaksTiesAsItIsTold) {
  const Standing standing(0.5, {0.4, 0.2, 0.3});
  for (const auto& other :
       InitialiseFromSingleFrame(standing.observation, SingleFrameOptions()).hypotheses) {
    // With the scene's axis along a solution's front, that solution comes first.
    SingleFrameObservation observation = standing.observation;
    observation.scene_axis_in_camera =
        (other.landmark_in_camera.frame_from_object.rotation * Eigen::Vector3d::UnitX()).eval();
    const auto solution = InitialiseFromSingleFrame(observation, SingleFrameOptions());
    EXPECT_GT(BoxIou(solution.hypotheses.front().landmark_in_camera, other.landmark_in_camera),
              0.9999);
  }
}

// The stored cost is that of the stored landmark, also where no body of the prior's ratio fits.
TEST(SingleFrame, CostsAreThoseOfTheirLandmarks) {
  for (const Eigen::Vector2d& ratio : {Eigen::Vector2d(4.0 / 3.0, 2.0 / 3.0), {1.0, 1.0}}) {
    Standing standing(0.5, {0.4, 0.2, 0.3});
    standing.observation.ratio = ratio;
    const auto solution = InitialiseFromSingleFrame(standing.observation, SingleFrameOptions());
    ASSERT_FALSE(solution.hypotheses.empty());
    for (const Hypothesis& hypothesis : solution.hypotheses) {
      EXPECT_NEAR(SingleFrameCost(standing.observation, ConstraintVariances(),
                                  hypothesis.landmark_in_camera),
                  hypothesis.cost, 1e-9);
    }
  }
}

TEST(SingleFrame, RefusesAPlaneThatIsNotInView) {
  Standing standing(0.5, {0.4, 0.2, 0.3});
  standing.observation.plane_in_camera.offset = -1.0;  // the floor above the camera
  const auto solution = InitialiseFromSingleFrame(standing.observation, SingleFrameOptions());
  EXPECT_TRUE(solution.hypotheses.empty());
  EXPECT_EQ(solution.failure, "support_plane_not_in_view");
}

TEST(InitialiseSvd, RecoversExactQuadricsFromExactViews) {
  const Sequence sequence = SyntheticSequence(RandomScene(3, 5, 20), false);
  const auto detections = DetectionsByObject(sequence);
  const LandmarkEstimates estimates = InitialiseSvd(sequence);
  int recovered = 0;
  for (const ObjectEstimate& object : estimates.objects) {
    const auto index = static_cast<size_t>(object.object_index);
    if (detections[index].size() < 3) {
      EXPECT_EQ(object.failure, "fewer_than_three_views");
      continue;
    }
    ASSERT_TRUE(object.landmark_in_world);
    EXPECT_TRUE(object.proper_ellipsoid);
    EXPECT_TRUE(
        DualQuadric(*object.landmark_in_world)
            .isApprox(DualQuadric(sequence.objects[index].ground_truth->landmark_in_world), 1e-5));
    ++recovered;
  }
  EXPECT_GE(recovered, 3);
}

}  // namespace
}  // namespace soslam
