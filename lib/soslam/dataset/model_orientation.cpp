// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/image_path.h"
#include "soslam/image/image_format.h"
#include "soslam/image/image_turn.h"
#include "soslam/image/read_image.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// An image of the dataset that the model has.
struct TurnedImage {
  fs::path path;
  ImageHeader header;
  ColmapImage* of_model;
};

std::vector<TurnedImage> ListedImages(const std::vector<ListedImage>& images,
                                      const fs::path& dataset, ColmapModel* model) {
  std::vector<NamedPose> poses;
  for (const ColmapImage& image : model->images) poses.push_back(image.pose);
  const auto rows = RowsOfPoses(poses, images);
  std::vector<TurnedImage> listed;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i]) continue;
    const fs::path path = ImagePath(dataset, images[*rows[i]].image, dataset.string());
    if (const auto header = ReadImageHeader(path)) {
      listed.push_back({path, *header, &model->images[i]});
    }
  }
  return listed;
}

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
                                const std::map<std::int64_t, const TurnedImage*>& images) {
  std::map<std::int64_t, std::vector<std::pair<Eigen::Vector2d, double>>> seen_in;
  for (const ColmapPoint& point : model.points) {
    const auto first = std::ranges::find_if(point.track, [&](const auto& observation) {
      return images.contains(observation.image_id);
    });
    if (first == point.track.end()) continue;
    const auto& pixels = images.at(first->image_id)->of_model->pixels;
    seen_in[first->image_id].emplace_back(pixels[first->pixel_index], point.grey);
  }
  std::vector<Eigen::Array3d> greys;  // of the point, in the stored image, in the upright one
  for (const auto& [id, points] : seen_in) {
    const cv::Mat stored =
        ReadImage(images.at(id)->path, cv::IMREAD_GRAYSCALE, ImageOrientation::kStored);
    const cv::Mat upright =
        ReadImage(images.at(id)->path, cv::IMREAD_GRAYSCALE, ImageOrientation::kUpright);
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

// True unless the colours of points tell that the model is of upright images; a finding of the
// model if they do not tell. `turned`: the number of images that EXIF turns, within their size.
bool IsOfStoredByGreys(const std::vector<TurnedImage>& listed, std::ptrdiff_t turned,
                       ColmapModel* model) {
  constexpr size_t kMostImages = 20;
  constexpr double kSignificant = 3.0;
  std::map<std::int64_t, const TurnedImage*> by_id;
  for (const TurnedImage& image : listed) {
    if (image.header.orientation != 1) by_id[image.of_model->id] = &image;
  }
  while (by_id.size() > kMostImages) by_id.erase(std::prev(by_id.end()));
  const GreyCorrelations greys = CorrelateGreys(*model, by_id);
  const double sigmas = greys.SigmasForUpright();
  if (sigmas >= kSignificant) return false;
  if (sigmas > -kSignificant) {
    model->findings.push_back(
        {"model_orientation", Severity::kWarning,
         fmt::format("{} images are turned by EXIF within their size, and {} points of the model "
                     "correlate by {:.2f} with the grey values of stored images, by {:.2f} with "
                     "those of upright ones, which does not tell of which of them the model is",
                     turned, greys.points, greys.with_stored, greys.with_upright),
         "a model of the images as they are stored, for which it is taken",
         "points without colours or tracks", std::string("if the map is upside down: ") + kRemedy});
  }
  return true;
}

[[noreturn]] void RefuseSize(const std::vector<TurnedImage>& listed, const ImageSize& of_model) {
  const auto other = std::ranges::find_if(
      listed, [&](const TurnedImage& image) { return image.header.stored != of_model; });
  const ImageSize& size = other->header.stored;
  throw InputError(fmt::format(
      "{}: is {} x {} pixels{}, the model's camera {} x {}; expected the images that the model is "
      "of",
      other->path.string(), size.width, size.height,
      other->header.IsTurnedByAQuarter() ? ", which EXIF turns" : "", of_model.width,
      of_model.height));
}

// The camera of the turned images; `before` has a lens of COLMAP's models, without thin prisms and
// tilt.
LensCamera Turned(const LensCamera& before, const ImageTurn& turn) {
  LensCamera turned = before;
  Camera& camera = turned.camera;
  const Eigen::Vector2d centre = turn.Turned({camera.cx, camera.cy}, {camera.width, camera.height});
  camera.cx = centre.x();
  camera.cy = centre.y();
  if (turn.swaps_axes) {
    std::swap(camera.width, camera.height);
    std::swap(camera.fx, camera.fy);
  }
  if (auto& lens = turned.distortion) {
    // Tangential distortion is r^2 q + 2 x (q . x), with q = (p2, p1).
    const Eigen::Vector2d q = turn.Matrix() * Eigen::Vector2d(lens->p2, lens->p1);
    lens->p2 = q.x();
    lens->p1 = q.y();
  }
  return turned;
}

}  // namespace

void TurnModel(const std::vector<ListedImage>& images, const fs::path& dataset,
               ImageOrientation orientation, ColmapModel* model) {
  const Camera& camera = model->camera.camera;
  const ImageSize size{camera.width, camera.height};
  const std::vector<TurnedImage> listed = ListedImages(images, dataset, model);
  const auto may_be_of = [&](ImageOrientation read_as) {
    return std::ranges::all_of(
        listed, [&](const TurnedImage& image) { return image.header.Size(read_as) == size; });
  };
  const bool may_be_of_stored = may_be_of(ImageOrientation::kStored);
  const bool may_be_of_upright = may_be_of(ImageOrientation::kUpright);
  const auto turned = std::ranges::count_if(
      listed, [](const TurnedImage& image) { return image.header.orientation != 1; });
  if (!may_be_of_stored && !may_be_of_upright) RefuseSize(listed, size);
  if (turned == 0) return;
  const bool is_of_stored =
      may_be_of_stored && (!may_be_of_upright || IsOfStoredByGreys(listed, turned, model));
  const bool is_wanted_stored = orientation == ImageOrientation::kStored;
  const char* is_of = is_of_stored ? "as they are stored" : "as viewers show them";
  std::vector<PlacedCamera> cameras;
  for (const TurnedImage& image : listed) {
    const ImageTurn upright_from_stored = ExifTurn(image.header.orientation);
    if ((is_of_stored || is_wanted_stored) && upright_from_stored.Matrix().determinant() < 0.0) {
      throw InputError(fmt::format(
          "{}: EXIF mirrors this image, so that stored images show a mirrored world, and the model "
          "is of the images {}; expected images that EXIF does not mirror: {}",
          image.path.string(), is_of, kRemedy));
    }
    if (is_of_stored == is_wanted_stored) continue;
    const ImageTurn turn = is_of_stored ? upright_from_stored : upright_from_stored.Inverse();
    cameras.push_back({image.path.string(), Turned(model->camera, turn)});
    // A rotation about the optical axis.
    Eigen::Matrix3d turned_from_camera = Eigen::Matrix3d::Identity();
    turned_from_camera.topLeftCorner<2, 2>() = turn.Matrix();
    Eigen::Quaterniond& rotation = image.of_model->pose.world_from_camera.rotation;
    rotation = (rotation * Eigen::Quaterniond(turned_from_camera).conjugate()).normalized();
    for (Eigen::Vector2d& pixel : image.of_model->pixels) pixel = turn.Turned(pixel, size);
  }
  if (cameras.empty()) return;
  model->camera =
      OneCamera(cameras, "photos that EXIF turns alike: leave out the others", &model->findings);
  fmt::print(
      "{}: EXIF turns {} of {} images; the model is of the images {}, and turned with them\n",
      dataset.string(), turned, listed.size(), is_of);
}

}  // namespace soslam
