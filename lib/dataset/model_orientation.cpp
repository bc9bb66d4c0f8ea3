// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "dataset/colmap_model.h"
#include "dataset/image_path.h"
#include "image/image_format.h"
#include "image/read_image.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// An image that EXIF turns within its size.
struct TurnedImage {
  fs::path path;
  const std::vector<Eigen::Vector2d>* pixels;  // its image points
};

// Pearson's correlations between the grey values of points and those of their image points.
struct GreyCorrelations {
  Eigen::Index points = 0;
  double with_stored = 0.0;
  double with_upright = 0.0;  // if images are turned upright

  // Evidence for upright rather than stored images, in standard deviations: the difference after
  // Fisher's transformation.
  double SigmasForUpright() const {
    constexpr double kMost = 1.0 - 1e-9;
    constexpr Eigen::Index kFewest = 10;
    if (points < kFewest) return 0.0;
    const auto transformed = [&](double r) { return std::atanh(std::clamp(r, -kMost, kMost)); };
    return (transformed(with_upright) - transformed(with_stored)) *
           std::sqrt(0.5 * static_cast<double>(points - 3));
  }
};

// Each point counts once. `images` is keyed by id.
GreyCorrelations CorrelateGreys(const ColmapModel& model,
                                const std::map<std::int64_t, TurnedImage>& images) {
  std::map<std::int64_t, std::vector<std::pair<Eigen::Vector2d, double>>> seen_in;
  for (const ColmapPoint& point : model.points) {
    const auto first = std::ranges::find_if(point.track, [&](const auto& observation) {
      return images.contains(observation.image_id);
    });
    if (first == point.track.end()) continue;
    const TurnedImage& image = images.at(first->image_id);
    seen_in[first->image_id].emplace_back((*image.pixels)[first->pixel_index], point.grey);
  }
  std::vector<Eigen::Array3d> greys;  // of the point, in the stored image, in the upright one
  for (const auto& [id, points] : seen_in) {
    const cv::Mat stored =
        ReadImage(images.at(id).path, cv::IMREAD_GRAYSCALE, ImageOrientation::kStored);
    const cv::Mat upright =
        ReadImage(images.at(id).path, cv::IMREAD_GRAYSCALE, ImageOrientation::kUpright);
    for (const auto& [pixel, grey] : points) {
      const cv::Point at(static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
      if (!at.inside({{0, 0}, stored.size()})) continue;
      greys.emplace_back(grey, stored.at<uchar>(at), upright.at<uchar>(at));
    }
  }
  GreyCorrelations result;
  result.points = std::ssize(greys);
  if (greys.empty()) return result;
  Eigen::Array3Xd values(3, result.points);
  for (Eigen::Index i = 0; i < result.points; ++i) values.col(i) = greys[i];
  values.colwise() -= values.rowwise().mean().eval();
  const auto correlation = [&](int row) {
    const double scale = std::sqrt(values.row(0).square().sum() * values.row(row).square().sum());
    return scale > 0.0 ? (values.row(0) * values.row(row)).sum() / scale : 0.0;
  };
  result.with_stored = correlation(1);
  result.with_upright = correlation(2);
  return result;
}

constexpr const char* kRemedy =
    "turn the files upright (exiftran -ai) and give these, with a model of them";

}  // namespace

std::vector<Finding> CheckModelOrientation(const ColmapModel& model,
                                           const std::vector<ListedImage>& images,
                                           const fs::path& dataset) {
  constexpr size_t kMostImages = 20;
  constexpr double kSignificant = 3.0;
  const Camera& camera = model.camera.camera;
  const ImageSize of_model{camera.width, camera.height};
  std::vector<NamedPose> poses;
  for (const ColmapImage& image : model.images) poses.push_back(image.pose);
  const auto rows = RowsOfPoses(poses, images);
  std::map<std::int64_t, TurnedImage> turned;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i]) continue;
    const fs::path path = ImagePath(dataset, images[*rows[i]].image, dataset.string());
    const auto header = ReadImageHeader(path);
    if (!header) continue;
    const ImageSize upright = header->Size(ImageOrientation::kUpright);
    if (header->stored != of_model) {
      throw InputError(fmt::format(
          "{}: is {} x {} pixels, the model's camera {} x {}; expected {}", path.string(),
          header->stored.width, header->stored.height, of_model.width, of_model.height,
          upright == of_model
              ? fmt::format("a model of the images as they are stored, which EXIF turns: {}",
                            kRemedy)
              : "the images that the model is of"));
    }
    if (header->orientation != 1 && upright == of_model) {
      turned[model.images[i].id] = {path, &model.images[i].pixels};
    }
  }
  if (turned.empty()) return {};
  const size_t count = turned.size();
  while (turned.size() > kMostImages) turned.erase(std::prev(turned.end()));
  const GreyCorrelations greys = CorrelateGreys(model, turned);
  const double sigmas = greys.SigmasForUpright();
  if (sigmas <= -kSignificant) return {};
  const std::string what = fmt::format(
      "{} images are turned by EXIF within their size, and {} points of the model correlate by "
      "{:.2f} with the grey values of stored images, by {:.2f} with those of upright ones",
      count, greys.points, greys.with_stored, greys.with_upright);
  if (sigmas >= kSignificant) {
    throw InputError(fmt::format("{}: {}; expected a model of the images as they are stored: {}",
                                 model.files.front().parent_path().string(), what, kRemedy));
  }
  return {{"model_orientation", Severity::kWarning,
           what + ", which does not tell of which of them the model is",
           "a model of the images as they are stored, for which it is taken",
           "points without colours or tracks",
           std::string("if the map is upside down: ") + kRemedy}};
}

}  // namespace soslam
