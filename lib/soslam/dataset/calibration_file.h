// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/distortion.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/finding.h"

namespace soslam {

// A pinhole camera, y down, and the distortion of its lens.
struct LensCamera {
  Camera camera;
  std::optional<Distortion> distortion;  // none: no distortion

  bool operator==(const LensCamera&) const = default;
};

// The camera of an image, as a file with several cameras has it.
struct PlacedCamera {
  std::string place;  // for messages
  LensCamera camera;
};

// Distance in pixels of the two image points of a ray, root mean square over the rays of the whole
// image. Infinite for images of different sizes.
double DisplacementPx(const LensCamera& one, const LensCamera& other);

// The displacement of image points that boxes do not show: the least standard deviation of a box
// edge, a pixel, in images of 640 pixels, and in larger images the same angle.
double UnseenDisplacementPx(const Camera& camera);

// The one camera of all images, of which there is one at least: the mean of the given ones. It is a
// finding if they are not equal. Throws InputError, naming the place and `remedy`, if one of them
// displaces image points by UnseenDisplacementPx or more.
LensCamera OneCamera(const std::vector<PlacedCamera>& cameras, const std::string& remedy,
                     std::vector<Finding>* findings);

// Distortion from the name of a model and its coefficients, in OpenCV's order: 4, 5, 8, 12 or 14 of
// them. Tools name models differently ("plumb_bob", "radtan", "OPENCV", "rational polynomial");
// capitals and word separators are ignored. None without coefficients. Throws InputError, naming
// `place`, for a model that is not OpenCV's (fisheye, equidistant, omnidirectional, ...), and for a
// number of coefficients that the model does not have.
std::optional<Distortion> ParseLens(const std::string& model, std::span<const double> coefficients,
                                    const std::string& place);

// A camera calibration. Pixel (0, 0) is the centre of the top-left pixel, as everywhere in this
// project.
struct Calibration {
  LensCamera camera;
  // EuRoC's T_BS, or the inverse of Kalibr's T_cam_imu. The body is the frame that EuRoC's poses
  // refer to.
  std::optional<Rigid3d> body_from_camera;
};

// Reads a camera file; the format follows from its name: .txt or .bin (ReadColmapCamera), .yaml,
// .yml or .xml, otherwise JSON: nerfstudio's if it has "frames" or "fl_x", or a camera.json
// (ReadCamera). Field names of YAML and XML are matched without capitals and underscores:
//
//   size        image_width and image_height (ROS, OpenCV), width and height, resolution (EuRoC,
//               Kalibr)
//   intrinsics  camera_matrix or K: 9 numbers, or a matrix with "data"; intrinsics: fx fy cx cy;
//               Camera.fx, .fy, .cx, .cy (ORB-SLAM)
//   lens        distortion_coefficients, dist_coeffs, dist_coeff, distortion_coeffs or D,
//               in OpenCV's order; Camera.k1, .k2, .p1, .p2, .k3
//   its model   distortion_model, camera_model, Camera.type (ParseLens)
//
// The camera is the first one of a rig: cam0 of Kalibr's camchain.yaml, Camera1 of ORB-SLAM3's
// settings. Other fields are ignored. Throws InputError, naming the field, for a missing field, a
// skew or a transposed matrix, a fisheye_model, distortion coefficients by other names, and ROS'
// binning and roi.
Calibration ReadCameraFile(const std::filesystem::path& path, std::vector<Finding>* findings);

}  // namespace soslam
