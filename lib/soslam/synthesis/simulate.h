// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "soslam/model/sequence.h"
#include "soslam/synthesis/scene.h"

namespace soslam {

// Kinds of noise. Each kind draws from its own generators, so that changing one kind leaves the
// others unchanged.
enum class NoiseKind : uint32_t { kDetection = 1, kOdometry = 2, kImage = 3, kFalseBox = 4 };

// The generator for one frame, and object id or 0.
inline std::mt19937 NoiseGenerator(int seed, NoiseKind kind, int frame_index, int object_id) {
  std::seed_seq sequence = {static_cast<uint32_t>(seed), static_cast<uint32_t>(kind),
                            static_cast<uint32_t>(frame_index), static_cast<uint32_t>(object_id)};
  return std::mt19937(sequence);
}

// The box of one object in one frame, indices into the scene's frames and objects.
struct SimulatedBox {
  int frame_index = 0;
  int object_index = 0;
  Box box;
  double score = 1.0;
  bool is_false = false;  // a box of nothing, which has the object's label
};

// Simulated measurements of a scene, and the truth. Boxes are sorted by frame, then by object.
struct Simulation {
  std::vector<Rigid3d> true_world_from_camera;
  std::vector<Rigid3d> odometry_world_from_camera;  // starts at the first true pose
  std::vector<SimulatedBox> exact_boxes;            // of every object in sight
  std::vector<SimulatedBox> detections;  // exact boxes with noise, without missed ones; false ones
};

// With boxes of whole objects, an object is in sight when it is wholly inside the image and its
// centre is not occluded. With those of visible parts, it is when min_visible_share of its
// silhouette is visible, in a box of at least 10 x 10 pixels; the score grows with the visible
// share. Walls hide nothing. Without noise, detections are exact_boxes and odometry is the truth.
Simulation Simulate(const Scene& scene, bool noise);

// True if nothing in the scene occludes the object's centre.
bool CentreIsVisible(const std::vector<Landmark>& bodies_in_world, int body_index,
                     const Eigen::Vector3d& camera_in_world);

// The box of a body in the world as a camera sees it; none unless it is wholly inside the image.
std::optional<Box> BoxInImage(const Camera& camera, const Rigid3d& world_from_camera,
                              const Landmark& body_in_world);

// The exact landmark and symmetries of an object. Shape and texture are symmetric about the xz
// plane of its own axes; the texture has no other mirror plane. Rotational symmetry about the
// plane's normal is of the shape alone.
GroundTruth ObjectGroundTruth(const Scene& scene, const SceneObject& object);

// The path of a frame's image in its dataset folder.
std::string ImageName(int frame_index);

// Renders and simulates the scene into a dataset folder: rgb.txt, rgb/*.png, groundtruth.txt,
// odometry.txt, camera.json, planes.json, objects.json, detections.csv, boxes_exact.csv, and a
// README.md that explains them. Numbers are written so that they read back exactly. The same bytes
// for any number of threads. The folder appears whole or not at all; one that an earlier call wrote
// is replaced. Throws SettingsError when the folder holds anything else or cannot be written.
void WriteDataset(const Scene& scene, bool noise, const std::filesystem::path& folder, int threads);

}  // namespace soslam
