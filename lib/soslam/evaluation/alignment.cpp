// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/alignment.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

// Root mean square distance of the true camera centres from their mean, below which the camera is
// taken to stand still.
constexpr double kStillM = 0.005;
// Paths are unlike each other when the best similarity leaves more than this share of that
// distance between them.
constexpr double kUnlikeShare = 0.5;
// Centres are on a line when the standard deviation of the rotation about it, as they determine it,
// is above this. The cameras' own rotations determine it then.
constexpr double kLineDeg = 0.5;
// Smallest noise that is assumed even of an exact path, as a share of that distance.
constexpr double kLeastNoise = 1e-5;

// Camera centres and their means.
struct Centres {
  Eigen::Matrix3Xd estimated, truth;
  Eigen::Vector3d mean_estimated, mean_truth;

  explicit Centres(const std::vector<PosePair>& pairs)
      : estimated(CollectCentres(pairs, &PosePair::estimated)),
        truth(CollectCentres(pairs, &PosePair::truth)),
        mean_estimated(estimated.rowwise().mean()),
        mean_truth(truth.rowwise().mean()) {}

  Eigen::Matrix3Xd CentredEstimated() const { return estimated.colwise() - mean_estimated; }
  Eigen::Matrix3Xd CentredTruth() const { return truth.colwise() - mean_truth; }
};

CameraPath ClassifyPath(const Centres& centres) {
  if (centres.truth.cols() < 2) return CameraPath::kFewPoses;
  const auto count = static_cast<double>(centres.truth.cols());
  const Eigen::Matrix3Xd truth = centres.CentredTruth();
  const double spread = truth.norm() / std::sqrt(count);
  if (spread < kStillM) return CameraPath::kStill;
  if (centres.CentredEstimated().norm() == 0.0) return CameraPath::kUnrelated;
  const double residual = ResidualOfFit(centres.estimated, centres.truth, /*with_scale=*/true);
  if (!(residual <= kUnlikeShare * spread)) return CameraPath::kUnrelated;
  const Eigen::Vector3d variances =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(truth * truth.transpose()).eigenvalues() /
      count;
  // Only distances from the line of largest variance determine the rotation about it.
  const double off_the_line = std::sqrt(std::max(variances[0] + variances[1], 0.0));
  const double noise = std::max(residual / std::sqrt(count), kLeastNoise * spread);
  return kDegPerRad * noise > kLineDeg * off_the_line ? CameraPath::kLine : CameraPath::kGeneral;
}

// The mean of the rotations from estimated to true cameras (chordal mean).
Eigen::Matrix3d MeanRotation(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& [estimated, truth] : pairs) {
    sum += (truth.rotation * estimated.rotation.conjugate()).toRotationMatrix();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// True if estimates have to be scaled onto the truth: the best scale differs from 1, and leaves
// less than half of the distances that the best motion alone leaves. Two poses or fewer fit any
// scale.
bool HaveOtherScale(const Alignment& rigid, const Alignment& similarity) {
  constexpr int kFewest = 3;
  constexpr double kLeastLogScale = 0.1;
  return similarity.kind == AlignmentKind::kSimilarity && similarity.frames >= kFewest &&
         std::abs(std::log(similarity.scale)) > kLeastLogScale &&
         2.0 * *similarity.rmse_m < *rigid.rmse_m;
}

AlignmentKind ChooseKind(AlignmentKind choice, const Sequence& sequence,
                         const std::vector<PosePair>& odometry) {
  if (choice != AlignmentKind::kAuto) return choice;
  if (sequence.odometry_world == OdometryWorld::kOwnWithScale) return AlignmentKind::kSimilarity;
  if (sequence.odometry_world == OdometryWorld::kOwn) return AlignmentKind::kRigid;
  if (odometry.empty() || AreInOneWorld(odometry)) return AlignmentKind::kNone;
  return HaveOtherScale(Align(odometry, AlignmentKind::kRigid),
                        Align(odometry, AlignmentKind::kSimilarity))
             ? AlignmentKind::kSimilarity
             : AlignmentKind::kRigid;
}

// Angle between the estimated and the true up of a segment; none where one of them is unknown.
std::optional<double> UpErrorDeg(const Sequence& sequence, int segment,
                                 const std::vector<PosePair>& pairs) {
  if (sequence.odometry_world == OdometryWorld::kOfTruth || pairs.empty()) return std::nullopt;
  // The estimate is the normal of the support plane of most detections, however the cameras are
  // held.
  std::map<int, int> detections;  // number by plane
  for (const Detection& detection : sequence.detections) {
    const int plane = sequence.ObjectOf(detection).plane_index;
    if (plane != kNoPlane && sequence.FrameOf(detection).segment == segment) ++detections[plane];
  }
  if (detections.empty()) return std::nullopt;
  const auto most =
      std::ranges::max_element(detections, {}, [](const auto& entry) { return entry.second; });
  const Eigen::Vector3d& estimated_up = sequence.planes[most->first].plane_in_world.normal;
  // The truth is the z axis of the standing true object that has the least sum of angles to those
  // of the others, as single ones may lean.
  std::vector<Eigen::Vector3d> axes;
  for (const TrueObject& object : sequence.true_objects) {
    const Landmark& landmark = object.truth.landmark_in_world;
    if (object.segment != segment || landmark.rests_on != RestingFace::kBottom) continue;
    axes.emplace_back(landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ());
  }
  if (axes.empty()) return std::nullopt;
  const auto true_up = std::ranges::min_element(axes, {}, [&](const Eigen::Vector3d& axis) {
    double sum = 0.0;
    for (const Eigen::Vector3d& other : axes) sum += AngleBetween(axis, other);
    return sum;
  });
  return AngleBetweenDeg(MeanRotation(pairs) * estimated_up, *true_up);
}

}  // namespace

Alignment Align(const std::vector<PosePair>& pairs, AlignmentKind kind) {
  Alignment alignment;
  alignment.frames = static_cast<int>(pairs.size());
  if (pairs.empty()) return alignment;
  const Centres centres(pairs);
  alignment.path = ClassifyPath(centres);
  if (kind != AlignmentKind::kNone) {
    const bool is_general = alignment.path == CameraPath::kGeneral;
    const bool has_scale = is_general || alignment.path == CameraPath::kLine;
    const Eigen::Matrix3d rotation =
        is_general
            ? Eigen::Matrix3d(
                  Eigen::umeyama(centres.estimated, centres.truth, false).topLeftCorner<3, 3>())
            : MeanRotation(pairs);
    alignment.kind = AlignmentKind::kRigid;
    if (kind == AlignmentKind::kSimilarity && has_scale) {
      // It minimises the squared distances after this rotation.
      const Eigen::Matrix3Xd estimated = centres.CentredEstimated();
      const double scale =
          centres.CentredTruth().cwiseProduct(rotation * estimated).sum() / estimated.squaredNorm();
      if (scale > 0.0) {
        alignment.kind = kind;
        alignment.scale = scale;
      }
    }
    alignment.truth_from_scaled = {
        Eigen::Quaterniond(rotation).normalized(),
        centres.mean_truth - alignment.scale * (rotation * centres.mean_estimated)};
  }
  double sum_m2 = 0.0;
  for (const auto& [estimated, truth] : pairs) {
    sum_m2 += (alignment.Apply(estimated.translation) - truth.translation).squaredNorm();
  }
  alignment.rmse_m = std::sqrt(sum_m2 / static_cast<double>(pairs.size()));
  return alignment;
}

Alignments AlignSegments(const Sequence& sequence, const std::vector<Rigid3d>& world_from_camera,
                         AlignmentKind choice) {
  const auto odometry = PosePairs(sequence, PosesOf(sequence));
  Alignments alignments;
  for (const auto& [segment, estimated] : PosePairs(sequence, world_from_camera)) {
    const AlignmentKind asked = ChooseKind(choice, sequence, odometry.at(segment));
    Alignment alignment = Align(estimated, asked);
    alignment.up_error_deg = UpErrorDeg(sequence, segment, estimated);
    alignments.of_segment[segment] = alignment;
    const char* kind = kAlignmentKindNames[static_cast<size_t>(alignment.kind)];
    if (alignment.kind != asked) {
      alignments.findings.push_back(
          {"alignment", Severity::kWarning,
           fmt::format("the map of segment {} is aligned as {}, not {}: {} frames with a true "
                       "pose, path of the camera: {}",
                       segment, kind, kAlignmentKindNames[static_cast<size_t>(asked)],
                       alignment.frames, kCameraPathNames[static_cast<size_t>(alignment.path)]),
           "true poses of a camera that moves",
           "no ground truth of the trajectory, or a camera that stands still, which tells no scale",
           "give groundtruth.txt of a camera that moves, or choose another alignment"});
    }
    if (estimated.empty() || alignment.kind == AlignmentKind::kSimilarity) continue;
    const Alignment similarity = Align(estimated, AlignmentKind::kSimilarity);
    if (HaveOtherScale(Align(estimated, AlignmentKind::kRigid), similarity)) {
      alignments.findings.push_back(
          {"alignment_scale", Severity::kWarning,
           fmt::format("the map of segment {} is aligned as {}, which leaves its cameras {:.3g} m "
                       "from the true ones; scaled by {:.3g} it would be {:.3g} m",
                       segment, kind, *alignment.rmse_m, similarity.scale, *similarity.rmse_m),
           "an estimate in the metres of the truth",
           "odometry of a single camera, which has a scale of its own, or a wrong scale",
           "set odometry_has_own_scale, or --alignment similarity"});
    }
  }
  return alignments;
}

AlignedMap ApplyAlignments(const Sequence& sequence, const std::vector<ObjectEstimate>& estimates,
                           const std::vector<Rigid3d>& world_from_camera,
                           const std::vector<Plane>& planes_in_world,
                           const Alignments& alignments) {
  AlignedMap map;
  const auto detections = DetectionsByObject(sequence);
  for (const ObjectEstimate& estimate : estimates) {
    const std::vector<int>& own = detections[estimate.object_index];
    if (!estimate.landmark_in_world || own.empty()) continue;
    const int segment = sequence.FrameOf(sequence.detections[own.front()]).segment;
    const Alignment& alignment = alignments.of_segment.at(segment);
    map.landmarks.push_back(
        {estimate.object_index, segment, alignment.Apply(*estimate.landmark_in_world)});
    const int plane = sequence.objects[estimate.object_index].plane_index;
    if (plane >= 0 && static_cast<size_t>(plane) < planes_in_world.size()) {
      map.landmarks.back().plane_in_world = alignment.Apply(planes_in_world[plane]);
    }
  }
  std::ranges::stable_sort(map.landmarks, {}, &AlignedLandmark::object_index);
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    map.world_from_camera.push_back(
        alignments.of_segment.at(sequence.frames[i].segment).Apply(world_from_camera[i]));
  }
  return map;
}

}  // namespace soslam
