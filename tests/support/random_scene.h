// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/constraints/parameters.h"
#include "support/random.h"

namespace soslam {

// A camera anywhere and a landmark in front of it, in the world.
struct RandomView {
  Rigid3d world_from_camera = RandomRigid();
  Landmark landmark_in_world = Transform(world_from_camera, RandomLandmarkInCamera());

  PoseBlock camera_block = ToParameterBlock(world_from_camera);
  LandmarkBlock landmark_block = ToParameterBlock(landmark_in_world);

  Landmark LandmarkInCamera() const {
    return Transform(world_from_camera.Inverse(), landmark_in_world);
  }
  void Move(const Rigid3d& motion) {
    world_from_camera = motion * world_from_camera;
    landmark_in_world = Transform(motion, landmark_in_world);
    camera_block = ToParameterBlock(world_from_camera);
    landmark_block = ToParameterBlock(landmark_in_world);
  }
};

}  // namespace soslam
