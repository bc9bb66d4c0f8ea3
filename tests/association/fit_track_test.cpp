// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/association_scenes.h"

namespace soslam {
namespace {

// One box tells how large the body would be at each distance, the prior's height how far it is.
TEST(FitObjectWithoutPlanesTest, OneBoxGivesABodyOfThePriorsHeight) {
  const AssociateOptions options = EstimatedAssociation();
  const Sequence sequence =
      WithoutPlanes(SyntheticSequence(LabelledScene(3, 1, 30, {"box"}), false));
  const UpEstimate up = UpOfSegments(sequence, SemanticTable(), options).at(0);
  for (const double height_m : {0.2, 2.0}) {
    ShapePrior prior = *UnknowingTable().default_prior;
    prior.height_m = LogNormal{height_m, 0.3};
    const auto object = FitTrack(sequence, {0}, prior, options, up);
    ASSERT_TRUE(object);
    EXPECT_NEAR(2.0 * object->landmark_in_world.half_axes.z() / height_m, 1.0,
                0.02);  // as far as the fit gets along its valley
    const Detection& detection = sequence.detections[0];
    const Rigid3d world_from_camera = sequence.FrameOf(detection).world_from_camera;
    const Landmark in_camera = Transform(world_from_camera.Inverse(), object->landmark_in_world);
    EXPECT_LT(OutlineEdgeRms(sequence.camera, in_camera, detection.box),
              0.05 * detection.box.Width());
    // Along the ray it is known as well as the height is.
    const Eigen::Vector3d ray = world_from_camera.translation - object->landmark_in_world.Centre();
    const Eigen::Matrix3d covariance = object->covariance.block<3, 3>(3, 3);
    const double sigma = std::sqrt(ray.normalized().dot(covariance * ray.normalized()));
    EXPECT_NEAR(sigma / ray.norm(), 0.3, 0.05);
  }
}

}  // namespace
}  // namespace soslam
