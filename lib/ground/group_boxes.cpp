// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/upper_median.h"
#include "ground/object_heights.h"

namespace soslam {
namespace {

constexpr size_t kLeastInBox = 3;       // in a box
constexpr double kInnerShare = 0.7;     // of a box, that has fewer points of its surroundings
constexpr double kNearQuantile = 0.3;   // of the depths in a box: that of its own surface
constexpr double kLeastOverlap = 0.35;  // of boxes of one object and label
constexpr double kLeastOverlapOfLabels = 0.5;  // of boxes of two labels
constexpr double kSameBox = 0.6;               // overlap of two boxes of one object in one frame

// Image point with its depth.
struct DepthReading {
  Eigen::Vector2d pixel;
  double depth;
};

// Upright rectangle in the world that a detection shows.
struct Place {
  int detection = 0;
  Eigen::Vector3d centre_in_world;
  double width, height;
};

// Depths at which an object with this box may be: those of the points in it, and of the planes
// under its lower edge.
std::vector<double> DepthsOf(const Sequence& sequence, const Detection& detection,
                             const std::vector<DepthReading>& readings,
                             const HorizontalPlanes& planes) {
  std::vector<double> depths;
  const Box& box = detection.box;
  for (const double share : {kInnerShare, 1.0}) {
    const Eigen::Vector2d half = 0.5 * share * Eigen::Vector2d(box.Width(), box.Height());
    const Eigen::Vector2d low = box.Centre() - half, high = box.Centre() + half;
    const Box inside = {low.x(), low.y(), high.x(), high.y()};
    std::vector<double> in_box;
    for (const DepthReading& reading : readings) {
      if (inside.Contains(reading.pixel)) in_box.push_back(reading.depth);
    }
    if (in_box.size() < kLeastInBox) continue;
    const auto near = in_box.begin() + static_cast<std::ptrdiff_t>(
                                           kNearQuantile * static_cast<double>(in_box.size()));
    std::nth_element(in_box.begin(), near, in_box.end());
    depths.push_back(*near);
    break;
  }
  const Frame& frame = sequence.FrameOf(detection);
  const Eigen::Vector2d foot(box.Centre().x(), box.y_max);
  const Eigen::Vector3d ray =
      frame.world_from_camera.rotation * sequence.CameraOf(detection).Ray(foot);
  const double slope = planes.up_in_world.dot(ray);
  const double camera = planes.up_in_world.dot(frame.world_from_camera.translation);
  for (const PlaneOfPoints& plane : planes.planes) {
    const double depth = (plane.height - camera) / slope;
    if (plane.height < camera && depth > 0.0) depths.push_back(depth);
  }
  return depths;
}

std::vector<Place> PlacesOf(const Sequence& sequence, const std::vector<GroundPoint>& points,
                            const HorizontalPlanes& planes) {
  std::vector<std::vector<DepthReading>> readings(sequence.frames.size());
  for (const GroundPoint& point : points) {
    for (const int index : point.frame_indices) {
      const Frame& frame = sequence.frames[index];
      const Eigen::Vector3d in_camera = frame.world_from_camera.Inverse() * point.position_in_world;
      const auto pixel = sequence.CameraOf(frame).Project(in_camera);
      if (pixel) readings[index].push_back({*pixel, in_camera.z()});
    }
  }
  std::vector<Place> places;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const Camera& camera = sequence.CameraOf(detection);
    const Eigen::Vector3d ray = camera.Ray(detection.box.Centre());
    for (const double depth :
         DepthsOf(sequence, detection, readings[detection.frame_index], planes)) {
      places.push_back(
          {static_cast<int>(i), sequence.FrameOf(detection).world_from_camera * (depth * ray),
           depth * detection.box.Width() / camera.fx, depth * detection.box.Height() / camera.fy});
    }
  }
  return places;
}

// Overlap of a detection's box with the rectangle of another one, seen from the same camera; 0
// where it is too small for boxes of one object.
double Overlap(const Sequence& sequence, const Detection& detection, const Place& place) {
  const Camera& camera = sequence.CameraOf(detection);
  const Eigen::Vector3d centre =
      sequence.FrameOf(detection).world_from_camera.Inverse() * place.centre_in_world;
  const auto pixel = camera.Project(centre);
  if (!pixel) return 0.0;
  const Eigen::Vector2d half =
      0.5 * Eigen::Vector2d(camera.fx * place.width, camera.fy * place.height) / centre.z();
  const double overlap = BoxOverlap(detection.box, {pixel->x() - half.x(), pixel->y() - half.y(),
                                                    pixel->x() + half.x(), pixel->y() + half.y()});
  const Detection& own = sequence.detections[place.detection];
  const bool is_same_label = sequence.ObjectOf(own).label == sequence.ObjectOf(detection).label;
  return overlap < (is_same_label ? kLeastOverlap : kLeastOverlapOfLabels) ? 0.0 : overlap;
}

// A detection that shows the same rectangle as a place.
struct Supporter {
  int detection;
  double overlap;
};

// The detections that show the same rectangle, by frame, those of most overlap first.
std::vector<Supporter> SupportersOf(const Sequence& sequence, const Place& place) {
  std::vector<Supporter> supporters;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const double overlap = static_cast<int>(i) == place.detection
                               ? 1.0
                               : Overlap(sequence, sequence.detections[i], place);
    if (overlap > 0.0) supporters.push_back({static_cast<int>(i), overlap});
  }
  std::ranges::stable_sort(supporters, {}, [&](const Supporter& one) {
    return std::pair(sequence.detections[one.detection].frame_index, -one.overlap);
  });
  return supporters;
}

// The median centre and size of a group.
Eigen::Vector4d MedianOf(const std::vector<Place>& group) {
  Eigen::Vector4d median;
  for (int i = 0; i < 4; ++i) {
    std::vector<double> values;
    for (const Place& place : group) {
      values.push_back(i < 3 ? place.centre_in_world(i) : std::max(place.width, place.height));
    }
    median(i) = UpperMedian(std::move(values));
  }
  return median;
}

// True if two groups are at the same place and hardly ever seen apart in one frame.
bool AreOne(const Sequence& sequence, const std::vector<Place>& one,
            const std::vector<Place>& other) {
  constexpr double kMaxSizeRatio = 1.6;
  constexpr double kMaxShareApart = 0.1;  // of the smaller group
  const Eigen::Vector4d of_one = MedianOf(one), of_other = MedianOf(other);
  const auto [smaller, larger] = std::minmax(of_one(3), of_other(3));
  if (larger > kMaxSizeRatio * smaller || (of_one - of_other).head<3>().norm() > 0.5 * smaller) {
    return false;
  }
  int apart = 0;
  for (const Place& place : one) {
    const Detection& first = sequence.detections[place.detection];
    apart += static_cast<int>(std::ranges::count_if(other, [&](const Place& of_other) {
      const Detection& second = sequence.detections[of_other.detection];
      return second.frame_index == first.frame_index &&
             BoxOverlap(second.box, first.box) < kSameBox;
    }));
  }
  return apart <= kMaxShareApart * static_cast<double>(std::min(one.size(), other.size()));
}

// The rectangle that most boxes agree with is the first object, and so on with the boxes that are
// left.
std::vector<std::vector<Place>> GroupPlaces(const Sequence& sequence,
                                            const std::vector<Place>& places, int threads) {
  std::vector<std::vector<Supporter>> supporters(places.size());
  ParallelFor(places.size(), threads,
              [&](size_t i) { supporters[i] = SupportersOf(sequence, places[i]); });
  std::vector<bool> is_taken(sequence.detections.size());
  // Calls `visit` with the supporters that are not taken: in each frame, the best one and those
  // that nearly coincide with it.
  const auto visit_supporters = [&](size_t place, const auto& visit) {
    const Detection* best = nullptr;
    for (const Supporter& supporter : supporters[place]) {
      if (is_taken[supporter.detection]) continue;
      const Detection& detection = sequence.detections[supporter.detection];
      const bool is_first = best == nullptr || best->frame_index != detection.frame_index;
      if (!is_first && BoxOverlap(best->box, detection.box) < kSameBox) continue;
      if (is_first) best = &detection;
      visit(supporter, is_first);
    }
  };
  std::vector<std::vector<Place>> groups;
  for (;;) {
    std::optional<size_t> best;
    double most = 1.0;  // of the box alone
    for (size_t i = 0; i < places.size(); ++i) {
      if (is_taken[places[i].detection]) continue;
      double support = 0.0;
      visit_supporters(i, [&](const Supporter& supporter, bool is_first) {
        if (is_first) support += supporter.overlap;
      });
      if (support <= most) continue;
      most = support;
      best = i;
    }
    if (!best) return groups;
    std::vector<int> detections;
    visit_supporters(*best,
                     [&](const Supporter& one, bool) { detections.push_back(one.detection); });
    const Eigen::Vector3d& centre = places[*best].centre_in_world;
    groups.emplace_back();
    for (const int index : detections) {
      is_taken[index] = true;
      const Detection& detection = sequence.detections[index];
      const Camera& camera = sequence.CameraOf(detection);
      const double depth = (sequence.FrameOf(detection).world_from_camera.Inverse() * centre).z();
      groups.back().push_back({index, centre, depth * detection.box.Width() / camera.fx,
                               depth * detection.box.Height() / camera.fy});
    }
  }
}

}  // namespace

std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes, int threads) {
  auto groups = GroupPlaces(sequence, PlacesOf(sequence, points, planes), threads);
  for (size_t i = 0; i < groups.size(); ++i) {
    for (size_t k = i + 1; k < groups.size();) {
      if (!AreOne(sequence, groups[i], groups[k])) {
        ++k;
        continue;
      }
      groups[i].insert(groups[i].end(), groups[k].begin(), groups[k].end());
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;
    }
  }
  std::vector<std::vector<int>> detections;
  for (const auto& group : groups) {
    detections.emplace_back();
    for (const Place& place : group) detections.back().push_back(place.detection);
    std::ranges::sort(detections.back());
  }
  std::ranges::sort(detections);
  return detections;
}

}  // namespace soslam
