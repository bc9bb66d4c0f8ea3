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

std::vector<std::vector<DepthReading>> ReadingsByFrame(const Sequence& sequence,
                                                       const std::vector<GroundPoint>& points) {
  std::vector<std::vector<DepthReading>> readings(sequence.frames.size());
  for (const GroundPoint& point : points) {
    for (const int index : point.frame_indices) {
      const Frame& frame = sequence.frames[index];
      const Eigen::Vector3d in_camera = frame.world_from_camera.Inverse() * point.position_in_world;
      const auto pixel = sequence.CameraOf(frame).Project(in_camera);
      if (pixel) readings[index].push_back({*pixel, in_camera.z()});
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
    if (depths.size() < kLeastInBox) continue;
    const auto near = depths.begin() + static_cast<std::ptrdiff_t>(
                                           kNearQuantile * static_cast<double>(depths.size()));
    std::nth_element(depths.begin(), near, depths.end());
    return *near;
  }
  return std::nullopt;
}

// Depths at which an object with this box may be: those of the points in it, and of the planes
// under its lower edge.
std::vector<double> DepthsOf(const Sequence& sequence, const Detection& detection,
                             const std::vector<DepthReading>& readings,
                             const HorizontalPlanes& planes) {
  std::vector<double> depths;
  if (const auto depth = DepthOfPoints(readings, detection.box)) depths.push_back(*depth);
  const Frame& frame = sequence.FrameOf(detection);
  const Eigen::Vector2d foot(detection.box.Centre().x(), detection.box.y_max);
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
  const auto readings = ReadingsByFrame(sequence, points);
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

// Groups of places: the rectangle that most boxes agree with is the first object, and so on with
// the boxes that are left.
class Grouping {
 public:
  Grouping(const Sequence& sequence, std::vector<Place> places, int threads)
      : sequence_(sequence),
        places_(std::move(places)),
        is_taken_(sequence.detections.size()),
        supporters_(places_.size()) {
    ParallelFor(places_.size(), threads,
                [&](size_t i) { supporters_[i] = SupportersOf(places_[i]); });
  }

  void Run() {
    for (;;) {
      const Place* best = nullptr;
      double most = 1.0;  // of the box alone
      for (size_t i = 0; i < places_.size(); ++i) {
        const double support = SupportOf(i);
        if (support <= most) continue;
        most = support;
        best = &places_[i];
      }
      if (best == nullptr) break;
      Take(*best);
    }
    Join();
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
    return sequence_.detections[place.detection].frame_index;
  }
  const Box& BoxOf(const Place& place) const { return sequence_.detections[place.detection].box; }

  // The order: by frame, those of most overlap first.
  std::vector<Supporter> SupportersOf(const Place& place) const {
    std::vector<Supporter> supporters;
    for (size_t i = 0; i < sequence_.detections.size(); ++i) {
      const double overlap = static_cast<int>(i) == place.detection
                                 ? 1.0
                                 : Overlap(sequence_, sequence_.detections[i], place);
      if (overlap > 0.0) supporters.push_back({static_cast<int>(i), overlap});
    }
    std::ranges::stable_sort(supporters, {}, [&](const Supporter& one) {
      return std::pair(sequence_.detections[one.detection].frame_index, -one.overlap);
    });
    return supporters;
  }

  // Calls `visit` with the supporters that are not taken: in each frame, the best one and those
  // that nearly coincide with it.
  template <typename Visit>
  void VisitSupporters(size_t place, const Visit& visit) const {
    const Detection* best = nullptr;
    for (const Supporter& supporter : supporters_[place]) {
      if (is_taken_[supporter.detection]) continue;
      const Detection& detection = sequence_.detections[supporter.detection];
      const bool is_first = best == nullptr || best->frame_index != detection.frame_index;
      if (!is_first && BoxOverlap(best->box, detection.box) < kSameBox) continue;
      if (is_first) best = &detection;
      visit(supporter, is_first);
    }
  }

  double SupportOf(size_t place) const {
    if (is_taken_[places_[place].detection]) return 0.0;
    double sum = 0.0;
    VisitSupporters(place, [&](const Supporter& supporter, bool is_first) {
      if (is_first) sum += supporter.overlap;
    });
    return sum;
  }

  void Take(const Place& best) {
    const Eigen::Vector3d centre = best.centre_in_world;
    std::vector<int> detections;
    VisitSupporters(static_cast<size_t>(&best - places_.data()),
                    [&](const Supporter& one, bool) { detections.push_back(one.detection); });
    groups_.emplace_back();
    for (const int index : detections) {
      is_taken_[index] = true;
      const Detection& detection = sequence_.detections[index];
      const Camera& camera = sequence_.CameraOf(detection);
      const double depth = (sequence_.FrameOf(detection).world_from_camera.Inverse() * centre).z();
      groups_.back().push_back({index, centre, depth * detection.box.Width() / camera.fx,
                                depth * detection.box.Height() / camera.fy});
    }
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

  static Eigen::Vector4d MedianOf(const std::vector<Place>& group) {
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

  bool AreOne(const std::vector<Place>& one, const std::vector<Place>& other) const {
    constexpr double kMaxSizeRatio = 1.6;
    constexpr double kMaxShareApart = 0.1;  // of the smaller group
    const Eigen::Vector4d of_one = MedianOf(one), of_other = MedianOf(other);
    const auto [smaller, larger] = std::minmax(of_one(3), of_other(3));
    if (larger > kMaxSizeRatio * smaller || (of_one - of_other).head<3>().norm() > 0.5 * smaller) {
      return false;
    }
    int apart = 0;
    for (const Place& place : one) {
      apart += static_cast<int>(std::ranges::count_if(other, [&](const Place& second) {
        return FrameOf(second) == FrameOf(place) &&
               BoxOverlap(BoxOf(second), BoxOf(place)) < kSameBox;
      }));
    }
    return apart <= kMaxShareApart * static_cast<double>(std::min(one.size(), other.size()));
  }

  const Sequence& sequence_;
  std::vector<Place> places_;
  std::vector<bool> is_taken_;                      // per detection
  std::vector<std::vector<Supporter>> supporters_;  // per place
  std::vector<std::vector<Place>> groups_;
};

}  // namespace

std::vector<std::vector<int>> GroupBoxes(const Sequence& sequence,
                                         const std::vector<GroundPoint>& points,
                                         const HorizontalPlanes& planes, int threads) {
  Grouping grouping(sequence, PlacesOf(sequence, points, planes), threads);
  grouping.Run();
  return grouping.Detections();
}

}  // namespace soslam
