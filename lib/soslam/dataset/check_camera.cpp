// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/gate.h"
#include "soslam/dataset/image_path.h"
#include "soslam/geometry/distortion.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/distort_pixels.h"
#include "soslam/image/image_format.h"
#include "soslam/model/reasons.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// True within the tolerance for rounding and crops of tools.
bool IsAbout(double value, double expected, double relative = 0.05) {
  return std::abs(value - expected) <= relative * std::abs(expected);
}

// True if the principal point would be the image centre with width and height swapped.
bool HasSwappedSides(const Camera& camera) {
  const bool is_off =
      !IsAbout(camera.cx, 0.5 * camera.width, 0.1) || !IsAbout(camera.cy, 0.5 * camera.height, 0.1);
  return is_off && IsAbout(camera.cx, 0.5 * camera.height) &&
         IsAbout(camera.cy, 0.5 * camera.width);
}

// True also for pixels of anamorphic lenses, which are up to twice as wide as high.
bool HasNearlySquarePixels(const Camera& camera) {
  return camera.fx <= 2.0 * camera.fy && camera.fy <= 2.0 * camera.fx;
}

Advice AdviceOnIntrinsics(const Camera& camera) {
  // Scale of the image whose centre is the principal point; 0 for none.
  const double by_x = 2.0 * camera.cx / camera.width;
  const double by_y = 2.0 * camera.cy / camera.height;
  const double scale = by_x > 0.0 && IsAbout(by_y, by_x) ? by_x : 0.0;
  if (camera.cx <= 2.0 && camera.cy <= 2.0) {
    return {"intrinsics as fractions of the image",
            fmt::format("multiply fx, cx by {} and fy, cy by {}", camera.width, camera.height)};
  }
  if (HasSwappedSides(camera)) {
    return {"width and height swapped, as of a camera held upright",
            fmt::format("width {}, height {}", camera.height, camera.width)};
  }
  if (scale > 1.2 || (scale > 0.0 && scale < 0.8)) {
    return {fmt::format("intrinsics of images {:.3g} times as large", scale),
            fmt::format("divide fx, fy, cx, cy by {:.4g}", scale)};
  }
  if (camera.fx < 0.2 * camera.width) {
    return {"a focal length in millimetres",
            "give fx, fy in pixels: millimetres times the width of the image in pixels, "
            "divided by that of the sensor in millimetres"};
  }
  if (!HasNearlySquarePixels(camera)) {
    return {"a focal length of another camera or image size, or in another unit than the other one",
            "give fx and fy in pixels of these images; they are about equal, as pixels are square"};
  }
  return {"intrinsics of another camera",
          "give those of the camera that took the images, in pixels"};
}

// Checks that the lens model has an inverse four fifths of the way to the middle of each side of
// the image, as calibrations of wide-angle lenses end near the sides, and moves that point towards
// the principal point by no more than a quarter of the distance, which is several times the
// strongest pincushion distortion of lenses.
std::vector<Finding> CheckLens(const Camera& camera, const Distortion& distortion) {
  constexpr double kLeastRatio = 0.75;
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const double right = camera.width - 0.5, bottom = camera.height - 0.5;
  std::vector<Eigen::Vector2d> sides = {
      {-0.5, camera.cy}, {right, camera.cy}, {camera.cx, -0.5}, {camera.cx, bottom}};
  for (Eigen::Vector2d& side : sides) side = centre + 0.8 * (side - centre);
  const auto undistorted = UndistortPixels(camera, distortion, sides);
  for (size_t i = 0; i < sides.size(); ++i) {
    if (undistorted[i] &&
        (*undistorted[i] - centre).norm() >= kLeastRatio * (sides[i] - centre).norm()) {
      continue;
    }
    const Reason advice = ReasonOf(NameOf(RejectReason::kBeyondLensModel));
    return {
        {"camera_lens", Severity::kWarning,
         fmt::format("lens model with coefficients {:g}, by which the pixel ({:.0f}, {:.0f}) {}",
                     fmt::join(DistortionCoefficients(distortion), " "), sides[i].x(), sides[i].y(),
                     undistorted[i] ? fmt::format("is ({:.0f}, {:.0f}) without distortion",
                                                  undistorted[i]->x(), undistorted[i]->y())
                                    : "has no undistorted one"),
         "a model that holds near the sides of the image", advice.cause, advice.remedy}};
  }
  return {};
}

// An image size that differs from the camera's.
struct Mismatch {
  Camera camera;
  ImageSize size;
  bool is_of_stored;  // the camera has the size of the stored image, before EXIF rotation
  std::string first_image;
  int images = 0;
};

Advice AdviceOnSize(const Mismatch& mismatch) {
  const Camera& camera = mismatch.camera;
  const ImageSize& size = mismatch.size;
  const double scale = static_cast<double>(size.width) / camera.width;
  const double scale_y = static_cast<double>(size.height) / camera.height;
  if (mismatch.is_of_stored) {
    return {"a camera of the images as they are stored, which a note of EXIF turns",
            "image_orientation stored where boxes and poses are of the stored images, too; "
            "otherwise the camera of the images as they are shown"};
  }
  if (size.width == camera.height && size.height == camera.width) {
    return {"width and height swapped, or images of a camera held upright",
            "give the camera of the images as they are shown"};
  }
  if (std::abs(scale - scale_y) <= 0.02 * scale) {
    return {"a camera of images before they were made smaller or larger",
            fmt::format("width {}, height {}, and fx, fy, cx, cy times {:.4g}", size.width,
                        size.height, scale)};
  }
  return {"another camera, or images that were cropped",
          "give the camera that these images are of"};
}

// True if camera and boxes are those of soslam-reconstruct and of soslam-frames or soslam-detect,
// for upright images.
bool AreKnownToBeUpright(const ImportView& view) {
  const auto& files = view.content.files;
  const fs::path camera = view.folder / "camera.json", boxes = view.folder / "detections.csv";
  if (!std::ranges::count(files, camera) || !std::ranges::count(files, boxes)) return false;
  std::string line;
  std::ifstream stream(boxes);
  std::getline(stream, line);
  return SourceOfCamera(camera) == kReconstructed &&
         (line.starts_with("# Written by soslam-frames") ||
          (line.starts_with("# {") && line.find(R"("image_orientation":"upright")") != line.npos));
}

}  // namespace

std::vector<Finding> CheckCamera(const ImportView& view) {
  std::vector<Finding> findings;
  std::vector<Camera> seen;
  for (const Frame& frame : view.sequence.frames) {
    const Camera& camera = view.sequence.CameraOf(frame);
    if (std::ranges::find(seen, camera) != seen.end()) continue;
    seen.push_back(camera);
    const double x = (camera.cx + 0.5) / camera.width;
    const double y = (camera.cy + 0.5) / camera.height;
    const bool is_inside = x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0;
    const bool is_central = std::min({x, y, 1.0 - x, 1.0 - y}) > 0.25;
    const bool is_focal = camera.fx >= 0.2 * camera.width && camera.fx <= 10.0 * camera.width &&
                          camera.fy >= 0.2 * camera.height &&
                          camera.fy <= 10.0 * std::max(camera.width, camera.height);
    const bool is_impossible = !is_focal || !is_inside || HasSwappedSides(camera);
    if (is_impossible || !is_central || !HasNearlySquarePixels(camera)) {
      const Advice advice = AdviceOnIntrinsics(camera);
      findings.push_back(
          {"camera_intrinsics", is_impossible ? Severity::kError : Severity::kWarning,
           fmt::format("camera of {} x {} pixels with fx {:g}, fy {:g}, cx {:g}, cy {:g}",
                       camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy),
           "focal lengths of 0.2 to 10 times the width, about equal, and a principal point near "
           "the middle",
           advice.cause, advice.remedy});
    }
    if (view.sequence.image_distortion) {
      std::ranges::move(CheckLens(camera, *view.sequence.image_distortion),
                        std::back_inserter(findings));
    }
  }
  return findings;
}

std::vector<Finding> CheckImages(const ImportView& view) {
  const ImageOrientation read_as = view.options.image_orientation;
  const bool are_of_colmap = view.options.folder.trajectory_format == TrajectoryFormat::kColmap;
  std::map<ImageSize, Mismatch> mismatches;
  size_t all = 0;
  // Images with an EXIF rotation whose size does not determine whether camera and boxes refer to
  // the rotated image, or whose poses are COLMAP's.
  size_t turned = 0;
  for (const Frame& frame : view.sequence.frames) {
    if (frame.image.empty()) continue;
    const auto header = ReadImageHeader(ImagePath(view.folder, frame.image, view.folder.string()));
    if (!header) continue;
    ++all;
    const Camera& camera = view.sequence.CameraOf(frame);
    const ImageSize size_of_camera{camera.width, camera.height};
    const ImageSize size = header->Size(read_as);
    if (size == size_of_camera) {
      const bool size_tells = header->IsTurnedByAQuarter() && size.width != size.height;
      if (header->orientation != 1 && (!size_tells || are_of_colmap)) ++turned;
      continue;
    }
    Mismatch& mismatch = mismatches[size];
    const bool is_of_stored = header->stored == size_of_camera;
    if (mismatch.images++ == 0) mismatch = {camera, size, is_of_stored, frame.image, 1};
  }
  std::vector<Finding> findings;
  if (turned > 0 && read_as != ImageOrientation::kStored && !AreKnownToBeUpright(view)) {
    Finding& finding = findings.emplace_back(Finding{
        "image_orientation", Severity::kWarning,
        fmt::format("{} of {} images have a note of EXIF that turns them, and are read as viewers "
                    "show them",
                    turned, all),
        "camera and boxes of the images as they are shown, which no size tells here",
        "a camera that was held upside down, or a program that set the note",
        "nothing where boxes fit the images on the report page; otherwise image_orientation "
        "stored"});
    if (are_of_colmap) {
      finding.expected = "images as they are stored, of which COLMAP's poses and camera are";
      finding.cause = "images of a phone that was held upright";
      finding.remedy =
          "soslam-reconstruct --model, which turns the model upright; or image_orientation stored, "
          "for soslam-detect, too";
    }
  }
  for (const auto& [size, mismatch] : mismatches) {
    const Advice advice = AdviceOnSize(mismatch);
    findings.push_back(
        {"camera_size", Severity::kError,
         fmt::format("{} of {} images are of {} x {} pixels (the first is {}), the camera of "
                     "{} x {}",
                     mismatch.images, all, size.width, size.height, mismatch.first_image,
                     mismatch.camera.width, mismatch.camera.height),
         "images of the camera's size", advice.cause, advice.remedy});
  }
  return findings;
}

}  // namespace soslam
