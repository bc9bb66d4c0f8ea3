// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "soslam/dataset/calibration_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/image_size.h"
#include "soslam/model/finding.h"

namespace soslam {

// Finished models of COLMAP, text (.txt) or binary (.bin); the format follows from the name. The
// readers throw InputError naming the line, or the entry of a binary file; also for a binary file
// of more than 1 GiB, or that ends too early or too late, a number that is not finite, and counts
// beyond what the file can hold.
//
// COLMAP's pixel (0, 0) is the outer corner of the top-left one: half a pixel is subtracted
// everywhere. Its poses are camera_from_world; they are inverted here.

// Reads the camera of cameras.txt or cameras.bin: of several, OneCamera of those that the images in
// the images.txt or images.bin beside it have; of all, if there is none. Models: SIMPLE_PINHOLE,
// PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV.
LensCamera ReadColmapCamera(const std::filesystem::path& path, std::vector<Finding>* findings);

// Reads the poses of images.txt or images.bin, without their image points. In file order; at least
// one.
std::vector<NamedPose> ReadColmapPoses(const std::filesystem::path& path);

struct ColmapImage {
  std::int64_t id = 0;
  std::int64_t camera_id = 0;
  NamedPose pose;
  std::vector<Eigen::Vector2d> pixels;  // image points, whether or not they are of a point
};

struct ColmapPoint {
  struct Observation {
    std::int64_t image_id = 0;
    std::int64_t pixel_index = 0;  // in ColmapImage::pixels
  };
  std::uint64_t id = 0;
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  double grey = 0.0;                   // of its colour
  double reprojection_error_px = 0.0;  // mean over its observations; below 0 where unknown
  std::vector<Observation> track;
};

struct ColmapModel {
  LensCamera camera;
  std::vector<ColmapImage> images;  // in file order
  std::vector<ColmapPoint> points;  // sorted by id
  std::vector<std::filesystem::path> files;
  std::vector<Finding> findings;  // what was left out, or made one
};

// Reads points3D.txt or points3D.bin, in file order.
std::vector<ColmapPoint> ReadColmapPoints(const std::filesystem::path& path);

// True if a folder has the camera file of a model.
bool IsColmapModel(const std::filesystem::path& folder);

// Reads the cameras, images and points3D of a folder: .bin, or .txt where there is no cameras.bin.
// A model without points3D has no points. No id occurs twice. Tracks lose the observations in
// images that the model does not have, or of which it has no image point; if there are other image
// points, a track that refers to none of them is refused.
ColmapModel ReadColmapModel(const std::filesystem::path& folder);

// Turns camera, poses and image points of a finished model by EXIF where it is of the images in the
// other orientation, and prints how many images that are: COLMAP up to 3.12 reads images as they
// are stored. The size of its camera tells and, for images that EXIF turns within their size, the
// colours of its points; it is a finding of the model if these do not tell, and it is then taken to
// be of the stored images. Throws InputError for a camera of another size, for images that EXIF
// mirrors, whose world is mirrored, and if the turned cameras are not one (OneCamera).
void TurnModel(const std::vector<ListedImage>& images, const std::filesystem::path& dataset,
               ImageOrientation orientation, ColmapModel* model);

// Name and parameters ("500,500,320,240") of COLMAP's smallest camera model that includes a lens.
struct ColmapCameraText {
  std::string model;
  std::string parameters;
};
// Throws InputError for thin prisms and tilted sensors, which COLMAP's models do not have.
ColmapCameraText ToColmap(const LensCamera& camera);

}  // namespace soslam
