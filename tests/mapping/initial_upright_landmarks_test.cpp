// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/geometry/iou.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/mapping/initial_landmarks.h"
#include "support/cuboid_map.h"
#include "support/random.h"

namespace soslam {
namespace {

class UprightStarts : public testing::Test {
 protected:
  UprightStarts() {
    // Hypotheses of each observation: first a landmark of another yaw, which differs from
    // observation to observation, then the truth.
    for (size_t i = 0; i < sequence_.detections.size(); ++i) {
      const Detection& detection = sequence_.detections[i];
      const Landmark truth = *TrueLandmarkInCamera(sequence_, detection);
      const double turn = RandomUniform(0.5, 1.0) * (i % 2 == 0 ? 1.0 : -1.0);
      estimates_.observations.push_back(
          {static_cast<int>(i), {{RotatedAboutZ(truth, turn), 0.0}, {truth, 1.0}}, ""});
    }
  }
  std::vector<std::optional<Landmark>> Choose(int threads = 1) const {
    BackEndInput input = TruthInput(sequence_);
    input.images = images_;
    return ChooseInitialUprightLandmarks(input, estimates_, options_, threads);
  }

  OptimiseOptions options_ = TangencyOptions();
  Sequence sequence_ = CuboidSequence(4, 12);
  LandmarkEstimates estimates_;
  EvidenceOfImages images_;
};

TEST_F(UprightStarts, AreTheYawThatAllViewsAgreeOn) {
  for (const bool edges : {false, true}) {
    if (edges) images_ = DrawnEdges(sequence_);
    const auto initial_landmarks = Choose();
    for (size_t i = 0; i < initial_landmarks.size(); ++i) {
      ASSERT_TRUE(initial_landmarks[i]);
      EXPECT_EQ(initial_landmarks[i]->shape_exponents, kCuboidExponent);
      EXPECT_GT(BoxIou(*initial_landmarks[i], sequence_.objects[i].ground_truth->landmark_in_world),
                0.98)
          << "object " << i << ", edges " << edges;
    }
  }
}

TEST_F(UprightStarts, ComeFromSeveralViewsWhereSingleFramesSayNothing) {
  for (ObservationEstimate& observation : estimates_.observations) {
    observation = {observation.detection_index, {}, "no_solution"};
  }
  // One view of it is left, which says nothing by itself.
  bool seen = false;
  std::erase_if(sequence_.detections, [&](const Detection& detection) {
    return detection.object_index == 1 && std::exchange(seen, true);
  });
  estimates_.observations.resize(sequence_.detections.size());
  const auto initial_landmarks = Choose();
  ASSERT_EQ(initial_landmarks.size(), 4u);
  for (size_t i = 0; i < initial_landmarks.size(); ++i) {
    ASSERT_EQ(initial_landmarks[i].has_value(), i != 1) << i;
    if (i == 1) continue;
    EXPECT_GT(BoxIou(*initial_landmarks[i], sequence_.objects[i].ground_truth->landmark_in_world),
              0.98);
  }
}

TEST_F(UprightStarts, AreFittedToAllViewsWhereThereAreBoxesAlone) {
  sequence_ = WithBoxNoise(CuboidSequence(2, 60), 3.0);
  estimates_ = {};
  const BackEndInput input = TruthInput(sequence_);
  const LandmarkEstimates fitted =
      InitialiseMultiView(sequence_, input.priors, options_.upright, 1);
  const auto initial_landmarks = Choose();
  for (size_t i = 0; i < initial_landmarks.size(); ++i) {
    ASSERT_TRUE(initial_landmarks[i]);
    EXPECT_GT(BoxIou(*initial_landmarks[i], fitted.objects[i].landmark_in_world.value()), 0.9999);
  }
}

// A body that reaches behind a camera is not what its box shows, however well others are explained.
TEST_F(UprightStarts, AreNotBehindTheCamerasThatSeeTheObject) {
  const Detection& detection = sequence_.detections.front();
  const Rigid3d& world_from_camera = sequence_.frames[detection.frame_index].world_from_camera;
  Landmark behind = sequence_.objects[detection.object_index].ground_truth->landmark_in_world;
  const Eigen::Vector3d backwards = world_from_camera.rotation * Eigen::Vector3d(0.0, 0.0, -1.0);
  behind.frame_from_object.translation += 30.0 * Eigen::Vector3d(backwards.x(), backwards.y(), 0.0);
  estimates_.observations.front().hypotheses.front().landmark_in_camera =
      Transform(world_from_camera.Inverse(), RotatedAboutZ(behind, 0.3));
  const auto initial_landmarks = Choose();
  const auto object_index = static_cast<size_t>(detection.object_index);
  ASSERT_TRUE(initial_landmarks[object_index]);
  EXPECT_GT(BoxIou(*initial_landmarks[object_index],
                   sequence_.objects[object_index].ground_truth->landmark_in_world),
            0.97);
}

}  // namespace
}  // namespace soslam
