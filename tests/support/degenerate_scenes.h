// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <ostream>
#include <vector>

#include "support/random.h"
#include "support/scene.h"
#include "synthesis/simulate.h"

namespace soslam {

// A way of making a sequence say little, nothing, or what cannot be.
struct Degeneracy {
  const char* name;
  std::function<void(Sequence*)> apply;
};
inline void PrintTo(const Degeneracy& degeneracy, std::ostream* stream) {
  *stream << degeneracy.name;
}

// Sees every detection's plane from its frame's estimated pose.
inline void SeePlanesFromPoses(Sequence* sequence) {
  for (Detection& detection : sequence->detections) {
    const auto plane_index = static_cast<size_t>(sequence->ObjectOf(detection).plane_index);
    detection.plane_in_camera = Transform(sequence->FrameOf(detection).world_from_camera.Inverse(),
                                          sequence->planes[plane_index].plane_in_world);
  }
}

inline const Landmark& TruthOf(const Sequence& sequence, size_t object) {
  return sequence.objects[object].ground_truth->landmark_in_world;
}

// Puts every camera somewhere else, looking as before.
inline void MoveCameras(const std::function<Eigen::Vector3d(size_t)>& centre, Sequence* sequence) {
  for (size_t i = 0; i < sequence->frames.size(); ++i) {
    sequence->frames[i].world_from_camera.translation = centre(i);
  }
  SeePlanesFromPoses(sequence);
}

inline void SetBoxes(const std::function<Box(const Box&)>& box, Sequence* sequence) {
  for (Detection& detection : sequence->detections) detection.box = box(detection.box);
}

inline constexpr const char* kNoDegeneracy = "None";  // what has an answer

inline std::vector<Degeneracy> Degeneracies() {
  using Eigen::Vector3d;
  return {
      {kNoDegeneracy, [](Sequence*) {}},
      {"CameraInsideABody",
       [](Sequence* sequence) {
         const Vector3d inside = TruthOf(*sequence, 0).Centre() + RandomVector(-0.05, 0.05);
         MoveCameras([&](size_t) { return inside; }, sequence);
       }},
      {"BodiesBehindTheCameras",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) {
           frame.world_from_camera.rotation =
               frame.world_from_camera.rotation *
               Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Vector3d::UnitY()));
         }
         SeePlanesFromPoses(sequence);
       }},
      {"PlaneThroughTheCameras",
       [](Sequence* sequence) {
         for (Detection& detection : sequence->detections) detection.plane_in_camera.offset = 0.0;
       }},
      {"PlaneSeenFromItsEdge",
       [](Sequence* sequence) {
         for (Detection& detection : sequence->detections) {
           const Vector3d ray =
               sequence->CameraOf(detection).Ray(detection.box.Centre()).normalized();
           detection.plane_in_camera.normal = ray.cross(Vector3d::UnitX()).normalized();
         }
       }},
      {"GrazingPlane",
       [](Sequence* sequence) {
         for (Detection& detection : sequence->detections) detection.plane_in_camera.offset *= 1e-6;
       }},
      {"BoxesWithoutArea",
       [](Sequence* sequence) {
         SetBoxes(
             [](const Box& box) {
               return Box{box.x_min, box.y_min, box.x_min, box.y_min};
             },
             sequence);
       }},
      {"BoxesOfOnePixel",
       [](Sequence* sequence) {
         SetBoxes(
             [](const Box& box) {
               return Box{box.x_min, box.y_min, box.x_min + 1.0, box.y_min + 1.0};
             },
             sequence);
       }},
      {"BoxesThatAreLines",
       [](Sequence* sequence) {
         SetBoxes(
             [](const Box& box) {
               return Box{box.x_min, box.y_min, box.x_max, box.y_min};
             },
             sequence);
       }},
      {"BoxesOfTheWholeImage",
       [](Sequence* sequence) {
         const Camera& camera = sequence->camera;
         SetBoxes(
             [&](const Box&) {
               return Box{0.0, 0.0, camera.width - 1.0, camera.height - 1.0};
             },
             sequence);
       }},
      {"BoxesAnywhere",
       [](Sequence* sequence) {
         SetBoxes(
             [](const Box&) {
               const double x = RandomUniform(0, 300), y = RandomUniform(0, 200);
               return Box{x, y, x + RandomUniform(1, 300), y + RandomUniform(1, 200)};
             },
             sequence);
       }},
      {"NoEdgeIsMeasured",
       [](Sequence* sequence) {
         for (Detection& detection : sequence->detections) detection.is_bound.fill(true);
       }},
      {"CamerasOnALineThroughABody",
       [](Sequence* sequence) {
         const Vector3d from = sequence->frames.front().world_from_camera.translation;
         const Vector3d to = TruthOf(*sequence, 0).Centre();
         MoveCameras([&](size_t i) { return from + 0.01 * static_cast<double>(i) * (to - from); },
                     sequence);
       }},
      {"PureRotation",
       [](Sequence* sequence) {
         const Vector3d centre = sequence->frames.front().world_from_camera.translation;
         MoveCameras([&](size_t) { return centre; }, sequence);
       }},
      {"EveryFrameTheSame",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) {
           frame.world_from_camera = sequence->frames.front().world_from_camera;
         }
         SeePlanesFromPoses(sequence);
       }},
      {"OneFrame",
       [](Sequence* sequence) {
         sequence->frames.resize(1);
         std::erase_if(sequence->detections,
                       [](const Detection& detection) { return detection.frame_index > 0; });
       }},
      {"FarAway",
       [](Sequence* sequence) {
         MoveCameras([](size_t i) { return Vector3d(1e6, -1e6, 1e5 + static_cast<double>(i)); },
                     sequence);
       }},
      {"Huge",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) frame.world_from_camera.translation *= 1e6;
         for (SupportPlane& plane : sequence->planes) plane.plane_in_world.offset *= 1e6;
         SeePlanesFromPoses(sequence);
       }},
      {"Tiny",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) frame.world_from_camera.translation *= 1e-6;
         for (SupportPlane& plane : sequence->planes) plane.plane_in_world.offset *= 1e-6;
         SeePlanesFromPoses(sequence);
       }},
      {"NoDetections", [](Sequence* sequence) { sequence->detections.clear(); }},
  };
}

}  // namespace soslam
