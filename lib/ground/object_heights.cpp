// SPDX-License-Identifier: BSD-3-Clause
#include "ground/object_heights.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "association/fit_track.h"
#include "base/parallel.h"
#include "model/label_groups.h"

namespace soslam {
namespace {

constexpr double kLeastVotes = 0.15;     // share of a label that is considered
constexpr double kNoSupport = 0.1;       // prior probability of a free height
constexpr double kBesidePlane = 0.02;    // factor where a plane has no surface under the object
constexpr double kEvidenceWeight = 0.5;  // see AssociateOptions::label_evidence_weight

std::map<std::string, double> VotesOf(const Sequence& sequence,
                                      const std::vector<int>& detections) {
  std::map<std::string, double> votes;
  double sum = 0.0;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    votes[sequence.ObjectOf(detection).label] += detection.score;
    sum += detection.score;
  }
  for (auto& [label, share] : votes) share = sum > 0.0 ? share / sum : 1.0;
  return votes;
}

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

class Measurement {
 public:
  Measurement(const Sequence& sequence, const HorizontalPlanes& planes, const UpEstimate& up,
              const GroundOptions& options, MeasuredObject* object)
      : sequence_(sequence),
        planes_(planes),
        up_(up),
        options_(FitOptions(options)),
        object_(object) {}

  // Adds the hypotheses of a label. `votes` is the prior probability.
  void Add(const std::string& label, ShapePrior prior, double votes) {
    const LogNormal height_m = *prior.height_m;
    prior.height_m.reset();  // the world is not in metres
    const double planes = std::max<double>(1.0, static_cast<double>(planes_.planes.size()));
    if (prior.mount == Mount::kStanding) {
      for (size_t k = 0; k < planes_.planes.size(); ++k) {
        const Plane plane{planes_.up_in_world, -planes_.planes[k].height};
        Try({label, static_cast<int>(k), 0.0, 0.0, votes * (1.0 - kNoSupport) / planes}, prior,
            height_m, plane);
      }
    }
    const double free = prior.mount == Mount::kStanding ? kNoSupport : 1.0;
    Try({label, kNoPlane, 0.0, 0.0, votes * free}, prior, height_m, up_);
  }

  // Turns costs into probabilities.
  void Finish() {
    if (costs_.empty()) return;
    const double lowest = std::ranges::min(costs_);
    double sum = 0.0;
    auto& hypotheses = object_->evidence.hypotheses;
    for (size_t i = 0; i < costs_.size(); ++i) {
      hypotheses[i].probability *= std::exp(kEvidenceWeight * (lowest - costs_[i]));
      sum += hypotheses[i].probability;
    }
    for (ScaleHypothesis& one : hypotheses) one.probability /= sum;
  }

 private:
  void Try(ScaleHypothesis hypothesis, const ShapePrior& prior, const LogNormal& height_m,
           const std::variant<Plane, UpEstimate>& support) {
    const auto fit = FitTrack(sequence_, object_->detections, prior, options_, support);
    if (!fit) return;
    if (hypothesis.plane != kNoPlane &&
        !IsOverSurface(planes_.planes[hypothesis.plane], planes_.up_in_world,
                       fit->landmark_in_world)) {
      hypothesis.probability *= kBesidePlane;
    }
    hypothesis.log_scale = std::log(height_m.median / (2.0 * fit->landmark_in_world.half_axes.z()));
    hypothesis.log_sigma = std::hypot(height_m.log_sigma, std::sqrt(fit->covariance(8, 8)));
    object_->evidence.hypotheses.push_back(hypothesis);
    object_->landmarks.push_back(fit->landmark_in_world);
    costs_.push_back(fit->cost);
  }

  const Sequence& sequence_;
  const HorizontalPlanes& planes_;
  const UpEstimate& up_;
  AssociateOptions options_;
  MeasuredObject* object_;
  std::vector<double> costs_;  // one per hypothesis
};

// Probability that an object is a false one or not what its boxes say: those that are detected in
// few of the frames that show their place are seldom right.
double WrongProbability(const Sequence& sequence, const MeasuredObject& object,
                        const GroundOptions& options) {
  constexpr double kUsualShare = 0.2;
  const auto& hypotheses = object.evidence.hypotheses;
  const auto best = std::ranges::max_element(hypotheses, {}, &ScaleHypothesis::probability);
  const Landmark& landmark = object.landmarks[best - hypotheses.begin()];
  std::set<int> frames_with_boxes;
  for (const Detection& detection : sequence.detections) {
    frames_with_boxes.insert(detection.frame_index);
  }
  const auto in_view = std::ranges::count_if(frames_with_boxes, [&](int index) {
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

}  // namespace

AssociateOptions FitOptions(const GroundOptions& options) {
  AssociateOptions fit;
  fit.tilt = options.tilt;
  fit.upright = options.upright;
  return fit;
}

std::vector<MeasuredObject> MeasureObjects(const Sequence& sequence,
                                           const std::vector<std::vector<int>>& groups,
                                           const SemanticTable& table,
                                           const HorizontalPlanes& planes, const UpEstimate& up,
                                           const GroundOptions& options, int threads) {
  const std::set<std::string> moving = NormalisedLabels("moving_labels", options.moving_labels);
  std::vector<MeasuredObject> objects;
  for (const std::vector<int>& group : groups) {
    if (static_cast<int>(group.size()) < options.min_boxes) continue;
    objects.push_back({group, VotesOf(sequence, group), {}, {}});
  }
  ParallelFor("objects", objects.size(), threads, [&](size_t i) {
    MeasuredObject& object = objects[i];
    Measurement measurement(sequence, planes, up, options, &object);
    for (const auto& [label, votes] : object.votes) {
      if (votes < kLeastVotes || moving.contains(NormalisedLabel(label))) continue;
      const auto prior = table.Contains(label) ? table.Find(label) : std::nullopt;
      const bool has_height = prior && prior->height_m && prior->attitude == Attitude::kStanding;
      if (has_height) measurement.Add(label, *prior, votes);
    }
    measurement.Finish();
    if (object.evidence.hypotheses.empty()) return;
    object.evidence.wrong_probability = WrongProbability(sequence, object, options);
  });
  return objects;
}

}  // namespace soslam
