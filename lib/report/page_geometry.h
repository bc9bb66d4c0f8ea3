// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "inspection/projection.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Short forms for pages, to keep them small. Lengths are rounded to a tenth of a millimetre, pixels
// to a tenth, other numbers to five significant digits. Numbers that are not finite become null.

nlohmann::json PageNumber(double value);
nlohmann::json PageNumbers(const std::vector<double>& values);
nlohmann::json PageVector(const Eigen::Vector3d& metres);
// [x, y, z, qx, qy, qz, qw]
nlohmann::json PagePose(const Rigid3d& pose);
// {"pose": world_from_object, "half_axes": [a, b, c], "p": shape exponent}
nlohmann::json PageLandmark(const Landmark& landmark_in_world);
// [x, y, x, y, ...] px
nlohmann::json PagePixels(const std::vector<Eigen::Vector2d>& pixels);
// {"outline": pixels, "axes": [front, left, up as pixels from centre to face] or null}
nlohmann::json PageOutline(const Camera& camera, const Landmark& landmark_in_camera);

// The lines of a grid on each of Sequence::planes, in the world; none for planes without objects.
using PlaneGrids = std::vector<std::vector<LineSegment3>>;

// Grids on the sequence's planes, around true centres if they are known, else around the contact
// points that its cameras see.
PlaneGrids GridsOfSequence(const Sequence& sequence);
// Grids on the map's planes, around its landmarks.
PlaneGrids GridsOfMap(const MapEstimate& map, const Sequence& sequence);

// Lines [x, y, z, x, y, z] in the world, by plane.
nlohmann::json PageGrids(const PlaneGrids& grids);

// The part of the grids that a frame's camera sees on the planes of its detections: lines as pixels
// [x, y, x, y]. The pose of the camera may depend on the detection.
nlohmann::json PageGridInFrame(
    const Sequence& sequence, int frame_index, const PlaneGrids& grids,
    const std::function<Rigid3d(const Detection&)>& camera_from_world_for);

// The camera pose (camera_from_world) from which the sequence's own planes are drawn for a
// detection: for given planes the true pose if it is known; for estimated planes the pose that
// moves the plane to the detection's plane_in_camera, with which odometry need not agree.
Rigid3d CameraAbovePlane(const Sequence& sequence, const Detection& detection);

}  // namespace soslam
