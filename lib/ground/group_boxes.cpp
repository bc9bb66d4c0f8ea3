// SPDX-License-Identifier: BSD-3-Clause
#include "ground/group_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace soslam {
namespace {

constexpr size_t kLeastPoints = 3;    // in a box
constexpr double kInnerShare = 0.7;   // of a box, that has fewer points of its surroundings
constexpr double kNearQuantile = 0.3; // of the depths in a box: that of its own surface
constexpr double kLeastOverlap = 0.35;
constexpr double kMaxDepthRatio = 1.5;
constexpr double kSameBox = 0.6;      // overlap of two boxes of one object in one frame

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

std::vector<std::vector<DepthReading>> ReadingsByFrame(const Sequence& sequence,
                                                       const std::vector<GroundPoint>& points) {
  std::vector<std::vector<DepthReading>> readings(sequence.frames.size());
  for (const GroundPoint& point : points) {
    for (const int index : point.frame_indices) {
      const Frame& frame = sequence.frames[static_cast<size_t>(index)];
      const Eigen::Vector3d in_camera = frame.world_from_camera.Inverse() * point.position_in_world;
      const auto pixel = sequence.CameraOf(frame).Project(in_camera);
      if (pixel) readings[static_cast<size_t>(index)].push_back({*pixel, in_camera.z()});
    }
  }
  return readings;
}

Box Shrunk(const Box& box, double share) {
  const Eigen::Vector2d half = 0.5 * share * Eigen::Vector2d(box.Width(), box.Height());
  const Eigen::Vector2d low = box.Centre() - half, high = box.Centre() + half;
  return {low.x(), low.y(), high.x(), high.y()};
}

std::optional<double> DepthOfPoints(const std::vector<DepthReading>& readings, const Box& box) {
  for (const double share : {kInnerShare, 1.0}) {
    const Box inside = Shrunk(box, share);
    std::vector<double> depths;
    for (const DepthReading& reading : readings) {
      if (inside.Contains(reading.pixel)) depths.push_back(reading.depth);
    }
    if (depths.size() < kLeastPoints) continue;
    const auto near = depths.begin() +
                      static_cast<std::ptrdiff_t>(kNearQuantile * static_cast<double>(depths.size()));
    std::nth_element(depths.begin(), near, depths.end());
    return *near;
  }
  return std::nullopt;
}

// Depth of the highest plane below the camera under the lower edge of a box.
std::optional<double> DepthOfPlane(const Sequence& sequence, const Detection& detection,
                                   const HorizontalPlanes& planes) {
  const Frame& frame = sequence.FrameOf(detection);
  const Eigen::Vector2d foot(detection.box.Centre().x(), detection.box.y_max);
  const Eigen::Vector3d ray =
      frame.world_from_camera.rotation * sequence.CameraOf(detection).Ray(foot);
  const double slope = planes.up_in_world.dot(ray);
  const double camera = planes.up_in_world.dot(frame.world_from_camera.translation);
  std::optional<double> depth;
  for (const PlaneOfPoints& plane : planes.planes) {
    const double to_plane = (plane.height - camera) / slope;
    if (plane.height < camera && to_plane > 0.0) depth = to_plane;
  }
  return depth;
}

std::vector<Place> PlacesOf(const Sequence& sequence, const std::vector<GroundPoint>& points,
                            const HorizontalPlanes& planes) {
  const auto readings = ReadingsByFrame(sequence, points);
  std::vector<Place> places;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    auto depth =
        DepthOfPoints(readings[static_cast<size_t>(detection.frame_index)], detection.box);
    if (!depth) depth = DepthOfPlane(sequence, detection, planes);
    if (!depth) continue;
    const Camera& camera = sequence.CameraOf(detection);
    places.push_back({static_cast<int>(i),
                      sequence.FrameOf(detection).world_from_camera *
                          (*depth * camera.Ray(detection.box.Centre())),
                      *depth * detection.box.Width() / camera.fx,
                      *depth * detection.box.Height() / camera.fy});
  }
  return places;
}

// Overlap of a box with the rectangle of another one, seen from the same camera; 0 where their
// depths differ.
double Overlap(const Sequence& sequence, const Place& place, const Place& other) {
  const Detection& detection = sequence.detections[static_cast<size_t>(place.detection)];
  const Camera& camera = sequence.CameraOf(detection);
  const Rigid3d camera_from_world = sequence.FrameOf(detection).world_from_camera.Inverse();
  const Eigen::Vector3d centre = camera_from_world * other.centre_in_world;
  const double depth = (camera_from_world * place.centre_in_world).z();
  const auto pixel = camera.Project(centre);
  if (!pixel || std::max(depth / centre.z(), centre.z() / depth) > kMaxDepthRatio) return 0.0;
  const Eigen::Vector2d half =
      0.5 * Eigen::Vector2d(camera.fx * other.width, camera.fy * other.height) / centre.z();
  return BoxOverlap(detection.box, {pixel->x() - half.x(), pixel->y() - half.y(),
                                    pixel->x() + half.x(), pixel->y() + half.y()});
}

// Groups of places that grow box by box.
class Grouping {
 public:
  explicit Grouping(const Sequence& sequence) : sequence_(sequence) {}

  void Add(const Place& place) {
    std::vector<Place>* best = nullptr;
    double highest = kLeastOverlap;
    for (auto& group : groups_) {
      const double overlap = OverlapWith(place, group);
      if (overlap <= highest) continue;
      highest = overlap;
      best = &group;
    }
    if (best == nullptr) best = &groups_.emplace_back();
    best->push_back(place);
  }

  // Joins groups at the same place that are hardly ever seen apart in one frame.
  void Join() {
    for (size_t i = 0; i < groups_.size(); ++i) {
      for (size_t k = i + 1; k < groups_.size();) {
        if (!AreOne(groups_[i], groups_[k])) {
          ++k;
          continue;
        }
        groups_[i].insert(groups_[i].end(), groups_[k].begin(), groups_[k].end());
        groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(k));
        k = i + 1;
      }
    }
  }

  std::vector<std::vector<int>> Detections() const {
    std::vector<std::vector<int>> result;
    for (const auto& group : groups_) {
      result.emplace_back();
      for (const Place& place : group) result.back().push_back(place.detection);
      std::ranges::sort(result.back());
    }
    std::ranges::sort(result);
    return result;
  }

 private:
  int FrameOf(const Place& place) const {
    return sequence_.detections[static_cast<size_t>(place.detection)].frame_index;
  }
  const Box& BoxOf(const Place& place) const {
    return sequence_.detections[static_cast<size_t>(place.detection)].box;
  }

  // Mean overlap with the members that are seen in the nearest frames; 0 if the object is seen
  // elsewhere in the same frame.
  double OverlapWith(const Place& place, const std::vector<Place>& group) const {
    constexpr size_t kMembers = 5;
    std::vector<const Place*> nearest;
    for (const Place& member : group) {
      if (FrameOf(member) == FrameOf(place) && BoxOverlap(BoxOf(member), BoxOf(place)) < kSameBox) {
        return 0.0;
      }
      nearest.push_back(&member);
    }
    std::ranges::stable_sort(nearest, {}, [&](const Place* member) {
      return std::abs(FrameOf(*member) - FrameOf(place));
    });
    nearest.resize(std::min(nearest.size(), kMembers));
    double sum = 0.0;
    for (const Place* member : nearest) sum += Overlap(sequence_, place, *member);
    return sum / static_cast<double>(nearest.size());
  }

  static Eigen::Vector4d MedianOf(const std::vector<Place>& group) {
    Eigen::Vector4d median;
    for (int i = 0; i < 4; ++i) {
      std::vector<double> values;
      for (const Place& place : group) {
        values.push_back(i < 3 ? place.centre_in_world(i) : std::max(place.width, place.height));
      }
      std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
      median(i) = values[values.size() / 2];
    }
    return median;
  }

  bool AreOne(const std::vector<Place>& one, const std::vector<Place>& other) const {
    constexpr double kMaxSizeRatio = 1.6;
    constexpr double kMaxShareApart = 0.1;  // of the smaller group
    const Eigen::Vector4d of_one = MedianOf(one), of_other = MedianOf(other);
    const auto [smaller, larger] = std::minmax(of_one(3), of_other(3));
    if (larger > kMaxSizeRatio * smaller ||
        (of_one - of_other).head<3>().norm() > 0.5 * smaller) {
      return false;
    }
    int apart = 0;
    for (const Place& place : one) {
      apart += static_cast<int>(std::ranges::count_if(other, [&](const Place& second) {
        return FrameOf(second) == FrameOf(place) && BoxOverlap(BoxOf(second), BoxOf(place)) < kSameBox;
      }));
    }
    return apart <= kMaxShareApart * static_cast<double>(std::min(one.size(), other.size()));
  }

  const Sequence& sequence_;
  std::vector<std::vector<Place>> groups_;
};

}  // namespace

std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes) {
  Grouping grouping(sequence);
  for (const Place& place : PlacesOf(sequence, points, planes)) grouping.Add(place);
  grouping.Join();
  return grouping.Detections();
}

}  // namespace soslam
