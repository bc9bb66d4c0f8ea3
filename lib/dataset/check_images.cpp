// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include "dataset/dataset_checks.h"
#include "dataset/image_path.h"
#include "image/image_header.h"

namespace soslam {
namespace {

// What the header of an image file says; none where there is no such image.
std::optional<ImageSize> SizeOf(const std::filesystem::path& path) {
  constexpr size_t kMaxHeader = size_t{1} << 18;
  std::string bytes(kMaxHeader, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<size_t>(stream.gcount()));
  return SizeInHeader(bytes);
}

// One size that images have where the camera has another one.
struct Mismatch {
  Camera camera;
  ImageSize size;
  std::string first_image;
  int images = 0;
};

Finding Explained(const Mismatch& mismatch, size_t all) {
  const auto& [camera, size, first_image, images] = mismatch;
  Finding finding{
      "camera_size",
      Severity::kError,
      fmt::format("{} of {} images are of {} x {} pixels (the first is {}), the camera of "
                  "{} x {}",
                  images, all, size.width, size.height, first_image, camera.width, camera.height),
      "images of the camera's size",
      "",
      ""};
  const double scale = static_cast<double>(size.width) / camera.width;
  const double scale_y = static_cast<double>(size.height) / camera.height;
  if (size.width == camera.height && size.height == camera.width) {
    finding.cause = "width and height swapped, or images of a camera held upright";
    finding.remedy = "give the camera of the images as they are shown";
  } else if (std::abs(scale - scale_y) <= 0.02 * scale) {
    finding.cause = "a camera of images before they were made smaller or larger";
    finding.remedy = fmt::format("width {}, height {}, and fx, fy, cx, cy times {:.4g}", size.width,
                                 size.height, scale);
  } else {
    finding.cause = "another camera, or images that were cropped";
    finding.remedy = "give the camera that these images are of";
  }
  return finding;
}

}  // namespace

std::vector<Finding> CheckImages(const ImportView& view) {
  std::map<std::pair<std::int64_t, std::int64_t>, Mismatch> mismatches;
  size_t all = 0;
  for (const Frame& frame : view.sequence.frames) {
    if (frame.image.empty()) continue;
    const auto size = SizeOf(ImagePath(view.folder, frame.image, view.folder.string()));
    if (!size) continue;
    ++all;
    const Camera& camera = view.sequence.CameraOf(frame);
    if (size->width == camera.width && size->height == camera.height) continue;
    Mismatch& mismatch = mismatches[{size->width, size->height}];
    if (mismatch.images++ == 0) mismatch = {camera, *size, frame.image, 1};
  }
  std::vector<Finding> findings;
  for (const auto& [size, mismatch] : mismatches) findings.push_back(Explained(mismatch, all));
  return findings;
}

}  // namespace soslam
