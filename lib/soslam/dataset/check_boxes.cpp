// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "soslam/dataset/dataset_checks.h"

namespace soslam {
namespace {

// A meaning that the four numbers of a box in a file may have: the corners are linear in them.
struct BoxConvention {
  const char* name;
  Eigen::Matrix4d corners_from_numbers;
};
const std::array kConventions = {
    BoxConvention{"two corners (x1, y1, x2, y2)", Eigen::Matrix4d::Identity()},
    BoxConvention{"upper left corner and size (x, y, width, height)",
                  Eigen::Matrix4d{{1, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 1, 0}, {0, 1, 0, 1}}},
    BoxConvention{
        "centre and size (cx, cy, width, height)",
        Eigen::Matrix4d{{1, 0, -0.5, 0}, {0, 1, 0, -0.5}, {1, 0, 0.5, 0}, {0, 1, 0, 0.5}}}};

// Tolerance for detectors and rounding, as a share of the image's sides.
constexpr double kMargin = 0.03;

// True if a part of the line between two points is in the area.
bool Crosses(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
             const Eigen::AlignedBox2d& area) {
  if (!area.intersects({from.cwiseMin(to), from.cwiseMax(to)})) return false;
  const Eigen::Vector2d across = (to - from).unitOrthogonal();
  return std::abs(across.dot(area.center() - from)) <= across.cwiseAbs().dot(0.5 * area.sizes());
}

// Number of boxes that are plausible after a linear change of their corners: that have an area, and
// whose sides are each at least in part in the image, up to the margin. What a box is drawn around
// touches all of its sides. Upright boxes are then in the image.
int CountPlausible(const std::vector<TurnedBox>& boxes, const Camera& camera,
                   const Eigen::Matrix4d& change) {
  const Eigen::Vector2d size(camera.width, camera.height);
  const Eigen::AlignedBox2d image(-kMargin * size, (1.0 + kMargin) * size);
  return static_cast<int>(std::ranges::count_if(boxes, [&](const TurnedBox& turned) {
    const auto& [x_min, y_min, x_max, y_max] = turned.box;
    const Eigen::Vector4d c = change * Eigen::Vector4d(x_min, y_min, x_max, y_max);
    const TurnedBox changed{{c[0], c[1], c[2], c[3]}, turned.angle_deg};
    if (!(changed.box.Width() > 0.0 && changed.box.Height() > 0.0)) return false;
    const auto corners = changed.Corners();
    for (size_t i = 0; i < corners.size(); ++i) {
      if (!Crosses(corners[i], corners[(i + 1) % corners.size()], image)) return false;
    }
    return true;
  }));
}

// The convention under which nearly all boxes lie in the image; null when there is none.
const BoxConvention* BetterConvention(const std::vector<TurnedBox>& boxes, const Camera& camera,
                                      const BoxConvention& assumed) {
  constexpr double kNearlyAll = 0.98;
  const BoxConvention* best = nullptr;
  int most = static_cast<int>(kNearlyAll * static_cast<double>(boxes.size()));
  for (const BoxConvention& other : kConventions) {
    if (&other == &assumed) continue;
    const int plausible = CountPlausible(
        boxes, camera, other.corners_from_numbers * assumed.corners_from_numbers.inverse());
    if (plausible <= most) continue;
    best = &other;
    most = plausible;
  }
  return best;
}

// Maximum x and y of all boxes (px).
Eigen::Vector2d Extent(const std::vector<TurnedBox>& boxes) {
  Eigen::Vector2d extent = Eigen::Vector2d::Zero();
  for (const TurnedBox& turned : boxes) {
    const Box around = turned.Around();
    extent = extent.cwiseMax(Eigen::Vector2d(around.x_max, around.y_max));
  }
  return extent;
}

std::vector<Finding> CheckConvention(const std::vector<TurnedBox>& boxes, const Camera& camera,
                                     const ImportOptions& options) {
  constexpr int kFewest = 3;
  constexpr double kTolerated = 0.03;
  constexpr double kMostly = 0.75;
  const auto all = static_cast<double>(boxes.size());
  const int plausible = CountPlausible(boxes, camera, Eigen::Matrix4d::Identity());
  const int bad = static_cast<int>(boxes.size()) - plausible;
  if (bad < kFewest || bad <= kTolerated * all) return {};
  const DetectionsFormat format = options.folder.detections_format;
  const bool has_corner =
      format == DetectionsFormat::kCoco || format == DetectionsFormat::kYoloPixels;
  const bool has_centre = format == DetectionsFormat::kYolo;
  const BoxConvention& assumed = kConventions[has_corner ? 1 : has_centre ? 2 : 0];
  const BoxConvention* better = BetterConvention(boxes, camera, assumed);
  // Boxes of whole objects that the image cuts extend beyond it on all sides.
  const auto is_left_or_above = [&](const TurnedBox& turned) {
    const Box box = turned.Around();
    return box.x_min < -kMargin * camera.width || box.y_min < -kMargin * camera.height;
  };
  const bool is_larger = std::ranges::none_of(boxes, is_left_or_above);
  const bool is_mostly_right = plausible > kMostly * all || (better == nullptr && !is_larger);
  const Eigen::Vector2d extent = Extent(boxes);
  Advice advice = {"boxes of whole objects that the image cuts, or of another camera",
                   "cut the boxes at the border of the image, as detectors do"};
  if (better != nullptr) {
    advice = {fmt::format("boxes that are meant as {}", better->name),
              fmt::format("write {}, or name the right detections_format", assumed.name)};
  } else if (is_larger) {
    advice = {"boxes of images of another size, or of another camera",
              fmt::format("give boxes in pixels of {} x {}, or the camera of the images that the "
                          "detector saw",
                          camera.width, camera.height)};
  }
  return {{"box_convention", is_mostly_right ? Severity::kWarning : Severity::kError,
           fmt::format("{} of {} boxes, read as {}, have no area or reach out of the image of "
                       "{} x {} (up to {:.0f}, {:.0f})",
                       bad, boxes.size(), assumed.name, camera.width, camera.height, extent.x(),
                       extent.y()),
           "boxes in the image", advice.cause, advice.remedy}};
}

// Finds boxes of downscaled images: they begin at the left border, and some end at the border of
// the smaller image. Oblique boxes of objects that the border cuts extend beyond it; their centres
// do not.
std::vector<Finding> CheckUnusedPart(std::vector<TurnedBox> boxes, const Camera& camera) {
  constexpr size_t kFewest = 30;
  constexpr double kLargestPart = 0.7;
  constexpr double kAtBorder = 0.02;
  constexpr double kSameEndPx = 1.5;
  for (TurnedBox& turned : boxes) {
    const Eigen::Vector2d centre = turned.box.Centre();
    if (turned.IsOblique()) turned.box = {centre.x(), centre.y(), centre.x(), centre.y()};
  }
  const Eigen::Vector2d extent = Extent(boxes);
  const Eigen::Vector2d part = extent.cwiseQuotient(Eigen::Vector2d(camera.width, camera.height));
  if (boxes.size() < kFewest || part.maxCoeff() > kLargestPart) return {};
  const bool begins = std::ranges::any_of(boxes, [&](const TurnedBox& turned) {
    return turned.Around().x_min < kAtBorder * camera.width;
  });
  const auto ends = std::ranges::count_if(boxes, [&](const TurnedBox& turned) {
    const Box box = turned.Around();
    return box.x_max > extent.x() - kSameEndPx || box.y_max > extent.y() - kSameEndPx;
  });
  if (!begins || ends < 3) return {};
  return {
      {"box_extent", Severity::kWarning,
       fmt::format("none of {} boxes reaches farther than {:.0f}, {:.0f} in an image of {} x {}",
                   boxes.size(), extent.x(), extent.y(), camera.width, camera.height),
       "boxes all over the image", "boxes of images that were made smaller than the camera's",
       fmt::format("give boxes and camera of one image size (boxes times {:.3g})",
                   1.0 / part.maxCoeff())}};
}

}  // namespace

std::vector<Finding> CheckBoxes(const ImportView& view) {
  constexpr double kLargestFraction = 1.5;
  const bool is_folder = view.options.format == DatasetFormat::kSoslam ||
                         view.options.format == DatasetFormat::kTumRgbd ||
                         view.options.format == DatasetFormat::kIclNuim;
  if (!is_folder) return {};  // other formats define their boxes
  const std::vector<DetectionRow>& rows = view.content.rows;
  std::vector<TurnedBox> boxes;
  for (const DetectionRow& row : rows) boxes.push_back(row.InImageFile());
  const Camera& camera = view.sequence.camera;
  const ImageSize size{camera.width, camera.height};
  const auto is_other = [&](const DetectionRow& row) {
    return row.image_size && *row.image_size != size;
  };
  const auto first = std::ranges::find_if(rows, is_other);
  if (first != rows.end()) {
    return {
        {"box_image_size", Severity::kError,
         fmt::format("{} of {} boxes are of images of {} x {} pixels, as their file says, the "
                     "camera has {} x {}",
                     std::ranges::count_if(rows, is_other), rows.size(), first->image_size->width,
                     first->image_size->height, size.width, size.height),
         "boxes in images of the camera's size",
         "an annotation tool that changed the size of the images",
         "export boxes of the original images, or correct width and height in the file"}};
  }
  const double largest = Extent(boxes).maxCoeff();
  if (!boxes.empty() && !(largest > kLargestFraction)) {
    return {{"box_unit", Severity::kError,
             fmt::format("all numbers of {} boxes are at most {:.3g}", boxes.size(), largest),
             fmt::format("boxes in pixels of an image of {} x {}", camera.width, camera.height),
             "boxes as fractions of the image",
             "multiply x by the width and y by the height of the image, or set detections_format "
             "to yolo where its layout fits"}};
  }
  std::vector<Finding> findings = CheckConvention(boxes, camera, view.options);
  if (findings.empty()) findings = CheckUnusedPart(boxes, camera);
  return findings;
}

std::vector<Finding> CheckScores(const ImportView& view) {
  const std::vector<DetectionRow>& rows = view.content.rows;
  const auto outside = std::ranges::count_if(
      rows, [](const DetectionRow& row) { return row.score < 0.0 || row.score > 1.0; });
  if (outside == 0) return {};
  const auto [lowest, highest] = std::ranges::minmax(rows, {}, &DetectionRow::score);
  return {{"scores", Severity::kWarning,
           fmt::format("{} of {} scores are outside 0 to 1 ({:g} to {:g})", outside, rows.size(),
                       lowest.score, highest.score),
           "scores from 0 to 1", "per cent, or a network's output before the sigmoid",
           "give scores as probabilities; min_score counts on them"}};
}

std::vector<Finding> CheckClassNumbers(const ImportView& view) {
  constexpr int kFewest = 10;
  std::set<std::string> known;
  for (const Object& object : view.sequence.objects) {
    if (object.ground_truth) known.insert(object.label);
  }
  const auto all = static_cast<int>(view.content.rows.size());
  // Number of detections whose label is in objects.json, with their class numbers increased.
  const auto count_known = [&](int shift) {
    const std::vector<std::string>& names = view.content.class_names;
    return static_cast<int>(std::ranges::count_if(view.content.rows, [&](const DetectionRow& row) {
      if (shift == 0) return known.contains(row.label);
      const auto found = std::ranges::find(names, row.label);
      const auto index = std::distance(names.begin(), found) + shift;
      return found != names.end() && index >= 0 && index < std::ssize(names) &&
             known.contains(names[index]);
    }));
  };
  const int as_read = count_known(0);
  if (view.content.class_names.empty() || all < kFewest || 3 * as_read > all) return {};
  for (const int shift : {-1, 1}) {
    const int shifted = count_known(shift);
    if (3 * shifted < 2 * all) continue;
    return {{"class_numbers", Severity::kWarning,
             fmt::format("{} of {} detections have a label of objects.json, but {} if their "
                         "classes are counted one {}",
                         as_read, all, shifted, shift < 0 ? "lower" : "higher"),
             "classes numbered as in the list of their names",
             shift < 0 ? "classes counted from 1, or a name too many in front of the list"
                       : "classes counted from 0, or a name missing in front of the list",
             "give the list of names that the detector was trained with: class_names"}};
  }
  return {};
}

std::vector<Finding> CheckBlankLines(const ImportView& view) {
  const auto& file = view.content.class_names_file;
  if (!file || file->extension() == ".yaml" || file->extension() == ".yml") return {};
  std::ifstream stream(*file);
  int blank = 0;
  int between = 0;
  for (std::string line; std::getline(stream, line);) {
    const bool is_blank = line.find_first_not_of(" \t\r") == line.npos;
    if (!is_blank) between = blank;
    if (is_blank) ++blank;
  }
  if (between == 0) return {};
  return {{"class_names", Severity::kWarning,
           fmt::format("{} has {} blank lines before or between its names",
                       file->filename().string(), between),
           "one name a line, as blank lines do not count as classes",
           "a name that was deleted, which shifts all classes after it",
           "put a name in each blank line, or take the line away where classes were numbered "
           "without it"}};
}

}  // namespace soslam
