// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/object_heights.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

#include "soslam/association/fit_track.h"
#include "soslam/base/parallel.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

constexpr double kLeastVotes = 0.15;     // share of a label that is considered
constexpr double kNoSupport = 0.1;       // prior probability of a free height
constexpr double kBesidePlane = 0.02;    // factor where a plane has no surface under the object
constexpr double kEvidenceWeight = 0.5;  // see AssociateOptions::label_evidence_weight

// True if the plane has a surface under the object or beside it: points that are not on one line,
// as those on a wall are.
bool IsOverSurface(const PlaneOfPoints& plane, const Eigen::Vector3d& up,
                   const Landmark& landmark) {
  constexpr double kLeastWidth = 0.1;  // standard deviation, relative to the reach
  constexpr double kLeastAround = 3.0;
  const double reach = 2.0 * landmark.half_axes.head<2>().norm();
  const Eigen::Matrix3d level = UprightRotation(up, 0.0).toRotationMatrix();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double count = 0.0;
  for (const Eigen::Vector3d& point : plane.points_in_world) {
    const Eigen::Vector2d from_centre =
        level.leftCols<2>().transpose() * (point - landmark.Centre());
    if (from_centre.norm() > reach) continue;
    sum += from_centre;
    squares += from_centre * from_centre.transpose();
    ++count;
  }
  if (count < kLeastAround) return false;
  const Eigen::Matrix2d spread = squares / count - sum * sum.transpose() / (count * count);
  const double least = kLeastWidth * reach;
  // Positive definite where the spread is more than the least one in all directions.
  const Eigen::Matrix2d excess = spread - least * least * Eigen::Matrix2d::Identity();
  return excess(0, 0) > 0.0 && excess.determinant() > 0.0;
}

// Probability that an object is a false one or not what its boxes say: those that are detected in
// few of the frames that show their place are seldom right. One that a person measured is right but
// for mistakes.
double WrongProbability(const Sequence& sequence, const std::vector<int>& frames_to_group,
                        const MeasuredObject& object, const GroundOptions& options) {
  constexpr double kUsualShare = 0.2;
  constexpr double kMistake = 0.001;
  if (object.size.Any()) return kMistake;
  const auto& hypotheses = object.evidence.hypotheses;
  const auto best = std::ranges::max_element(hypotheses, {}, &ScaleHypothesis::probability);
  const Landmark& landmark = object.landmarks[best - hypotheses.begin()];
  const auto in_view = std::ranges::count_if(frames_to_group, [&](int index) {
    const Frame& frame = sequence.frames[index];
    const Camera& camera = sequence.CameraOf(frame);
    const auto pixel = camera.Project(frame.world_from_camera.Inverse() * landmark.Centre());
    return pixel && camera.IsInside(*pixel);
  });
  std::set<int> frames;
  for (const int index : object.detections) {
    frames.insert(sequence.detections[index].frame_index);
  }
  const double share = static_cast<double>(frames.size()) /
                       static_cast<double>(std::max<std::ptrdiff_t>(1, in_view));
  return 1.0 - (1.0 - options.wrong_height_probability) * std::min(1.0, share / kUsualShare);
}

// Finds the hypotheses of an object whose detections and votes are known: its labels with a height,
// on each plane or, as the world is not in metres, at a free height.
void Measure(const Sequence& sequence, const SemanticTable& table, const HorizontalPlanes& planes,
             const UpEstimate& up, const std::set<std::string>& moving_labels,
             const GroundOptions& options, MeasuredObject* object) {
  const AssociateOptions fit_options = FitOptions(options);
  auto& hypotheses = object->evidence.hypotheses;
  std::vector<double> costs;  // one per hypothesis
  for (const auto& [label, votes] : object->votes) {
    if (votes < kLeastVotes || moving_labels.contains(NormalisedLabel(label)) ||
        !table.Contains(label)) {
      continue;
    }
    ShapePrior prior = WithKnownSize(*table.Find(label), object->size);
    const auto length = prior.Length();
    if (!length || prior.attitude != Attitude::kStanding) continue;
    // The world is not in metres yet.
    const Eigen::Index axis = length->axis;
    prior.height_m.reset();
    prior.known_length.reset();
    const auto add = [&, label = label](int plane, double probability,
                                        const std::variant<Plane, UpEstimate>& support) {
      const auto fit = FitTrack(sequence, object->detections, prior, fit_options, support);
      if (!fit) return;
      const Landmark& landmark = fit->landmark_in_world;
      if (plane != kNoPlane && !IsOverSurface(planes.planes[plane], planes.up_in_world, landmark)) {
        probability *= kBesidePlane;
      }
      hypotheses.push_back(
          {label, plane, std::log(length->length_m.median / (2.0 * landmark.half_axes[axis])),
           std::hypot(length->length_m.log_sigma, std::sqrt(fit->covariance(6 + axis, 6 + axis))),
           probability});
      object->landmarks.push_back(landmark);
      costs.push_back(fit->cost);
    };
    const bool stands = prior.mount == Mount::kStanding;
    const double count = std::max<double>(1.0, static_cast<double>(planes.planes.size()));
    for (size_t k = 0; k < planes.planes.size() && stands; ++k) {
      add(static_cast<int>(k), votes * (1.0 - kNoSupport) / count,
          Plane{planes.up_in_world, -planes.planes[k].height});
    }
    add(kNoPlane, votes * (stands ? kNoSupport : 1.0), up);
  }
  if (hypotheses.empty()) return;
  const double lowest = std::ranges::min(costs);
  double sum = 0.0;
  for (size_t i = 0; i < costs.size(); ++i) {
    hypotheses[i].probability *= std::exp(kEvidenceWeight * (lowest - costs[i]));
    sum += hypotheses[i].probability;
  }
  for (ScaleHypothesis& one : hypotheses) one.probability /= sum;
}

}  // namespace

AssociateOptions FitOptions(const GroundOptions& options) {
  AssociateOptions fit;
  fit.tilt = options.tilt;
  fit.upright = options.upright;
  return fit;
}

std::vector<BoxGroup> WithSizes(const FoundEdits& edits,
                                const std::vector<std::vector<int>>& groups) {
  std::vector<BoxGroup> sized;  // what edits of common boxes say
  for (size_t e = 0; e < edits.boxes.size(); ++e) {
    BoxGroup one{edits.boxes[e], edits.edits.edits[e].size};
    if (!one.size.Any()) continue;
    std::ranges::sort(one.detections);
    for (BoxGroup& other : sized) {
      std::vector<int> common, all;
      std::ranges::set_intersection(one.detections, other.detections, std::back_inserter(common));
      if (common.empty()) continue;
      std::ranges::set_union(one.detections, other.detections, std::back_inserter(all));
      one.detections = std::move(all);
      if (!one.size.depth_m) one.size.depth_m = other.size.depth_m;
      if (!one.size.width_m) one.size.width_m = other.size.width_m;
      if (!one.size.height_m) one.size.height_m = other.size.height_m;
      other.size = KnownSize();
    }
    std::erase_if(sized, [](const BoxGroup& other) { return !other.size.Any(); });
    sized.push_back(std::move(one));
  }
  std::ranges::stable_sort(sized, std::greater(),
                           [](const BoxGroup& group) { return group.detections.size(); });
  std::vector<BoxGroup> result;
  for (const std::vector<int>& group : groups) result.push_back({group, {}});
  for (const auto& [named, size] : sized) {
    const auto is_named = [&named = named](int box) {
      return std::ranges::binary_search(named, box);
    };
    const auto count = [&](const BoxGroup& group) {
      return group.size.Any() ? 0 : std::ranges::count_if(group.detections, is_named);
    };
    auto most = std::ranges::max_element(result, {}, count);
    if (most == result.end() || count(*most) == 0) most = result.insert(most, BoxGroup());
    for (BoxGroup& group : result) std::erase_if(group.detections, is_named);
    most->detections.insert(most->detections.end(), named.begin(), named.end());
    std::ranges::sort(most->detections);
    most->size = size;
  }
  std::erase_if(result, [](const BoxGroup& group) { return group.detections.empty(); });
  return result;
}

std::vector<MeasuredObject> MeasureObjects(const Sequence& sequence, const std::vector<int>& frames,
                                           const std::vector<BoxGroup>& groups,
                                           const SemanticTable& table,
                                           const HorizontalPlanes& planes,
                                           const GroundOptions& options, int threads) {
  const UpEstimate up =
      MakeUpEstimate(WithTiltCovariance(planes.up_in_world, planes.tilt_covariance));
  const std::set<std::string> moving = NormalisedLabels("moving_labels", sequence.moving_labels);
  std::vector<MeasuredObject> objects;
  for (const BoxGroup& group : groups) {
    const auto count = static_cast<int>(group.detections.size());
    if (count < options.min_boxes && !group.size.Any()) continue;
    MeasuredObject& object = objects.emplace_back();
    object.detections = group.detections;
    object.size = group.size;
    double sum = 0.0;
    for (const int index : group.detections) {
      const Detection& detection = sequence.detections[index];
      object.votes[sequence.ObjectOf(detection).label] += detection.score;
      sum += detection.score;
    }
    for (auto& [label, share] : object.votes) share = sum > 0.0 ? share / sum : 1.0;
  }
  ParallelFor("objects", objects.size(), threads, [&](size_t i) {
    Measure(sequence, table, planes, up, moving, options, &objects[i]);
    if (objects[i].evidence.hypotheses.empty()) return;
    objects[i].evidence.wrong_probability = WrongProbability(sequence, frames, objects[i], options);
  });
  return objects;
}

}  // namespace soslam
