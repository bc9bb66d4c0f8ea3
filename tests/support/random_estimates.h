// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "support/random.h"

namespace soslam {

inline Landmark RandomLandmark() {
  return {RandomRigid(), RandomVector(0.05, 1.0), RandomUniform(1.0, 2.0)};
}

// A sequence whose ids are not its indices, with every other optional value absent. The bounds of
// detection i are the binary digits of i. Its numbers are valid one by one, but have no geometric
// sense together.
inline Sequence RandomSequence() {
  Sequence sequence;
  sequence.name = "r\u00f6\u00f6m \"1\"\\";
  sequence.camera = TestCamera();
  sequence.planes = {
      {-4, RandomPlane(), Eigen::Matrix3d::Random(),
       HeightPrior{RandomVector(-2.0, 2.0), RandomUniform(0.01, 1.0)}, RandomVector(-1.0, 1.0)},
      {3, RandomPlane()}};
  for (int i = 0; i < 5; ++i) {
    Frame frame{10 + 5 * i, RandomUniform(1e9, 2e9), "rgb/a b.jpg", RandomRigid(), {}};
    if (i % 2 == 0) frame.true_world_from_camera = RandomRigid();
    frame.segment = i / 3;
    if (i == 3) frame.camera = Camera{320, 200, 250.5, 251.5, 160.25, 99.75};
    if (i == 4) frame.image.clear();
    sequence.frames.push_back(frame);
  }
  for (int i = 0; i < 4; ++i) {
    Object object{7 * i - 3, "label", i % 2, {}};
    if (i % 2 == 0) object.ground_truth = {RandomLandmark(), i == 0, i == 2, i == 2};
    object.is_static = i % 2 == 1;
    if (i == 1) object.known_size.width_m = RandomUniform(0.1, 2.0);
    sequence.objects.push_back(object);
  }
  for (int frame = 0; frame < 5; ++frame) {
    for (int object = frame % 2; object < 4; object += 2) {
      const Box box{RandomUniform(-9, 300), RandomUniform(-9, 200), RandomUniform(300, 700),
                    RandomUniform(200, 500)};
      const size_t i = sequence.detections.size();
      sequence.detections.push_back({frame,
                                     object,
                                     RandomUniform(0, 1),
                                     box,
                                     RandomPlane(),
                                     {(i & 1) != 0, (i & 2) != 0, (i & 4) != 0, (i & 8) != 0}});
      if (i % 3 == 0) sequence.detections.back().true_landmark_in_camera = RandomLandmark();
    }
  }
  sequence.rejected_detections = {{"duplicate", 2}, {"near_border", 17}};
  sequence.edits = AppliedEdits{{{"rename", 2}}, std::string(64, 'a')};
  return sequence;
}

inline std::vector<ObjectEstimate> RandomObjectEstimates() {
  ObjectEstimate found{0, 5, RandomLandmark(), Covariance9::Random(), "", true};
  ObjectEstimate without_covariance{2, 4, RandomLandmark(), {}, "", false};
  ObjectEstimate failed{3, 1, {}, {}, "too_few_views", true};
  return {found, without_covariance, failed};
}

inline LandmarkEstimates RandomLandmarkEstimates() {
  LandmarkEstimates estimates;
  estimates.observations = {{0, {{RandomLandmark(), 0.1}, {RandomLandmark(), 1.0 / 3.0}}, ""},
                            {3, {}, "plane_behind_camera"},
                            {9, {{RandomLandmark(), 1e-300}}, ""}};
  estimates.objects = RandomObjectEstimates();
  return estimates;
}

inline MapEstimate RandomMap() {
  MapEstimate map;
  map.objects = RandomObjectEstimates();
  map.objects[0].points = {{3, 0.1, 1.0 / 3.0}, {8, -0.02, 1.0}};
  for (int i = 0; i < 5; ++i) map.world_from_camera.push_back(RandomRigid());
  map.planes_in_world = {RandomPlane(), RandomPlane()};
  map.solver = {12.5,
                0.1,
                0.0,
                1.0 / 3.0,
                80.0,
                3,
                true,
                {12.5, 1.0 / 7.0, 0.1},
                {{"detection", 40}},
                {{"no_plane", 1}},
                {1.5, -0.25, 1.0 / 3.0, 0.0}};
  return map;
}

}  // namespace soslam
