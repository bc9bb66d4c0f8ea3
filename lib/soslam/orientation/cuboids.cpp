// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/cuboids.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "soslam/base/parallel.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/wireframe.h"

namespace soslam {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

// The direction of the view along the plane, of any length.
Eigen::Vector3d HorizontalRay(const CuboidView& view) {
  const Eigen::Vector3d ray = view.camera.Ray(view.box.Centre());
  const Eigen::Vector3d& up = view.plane_in_camera.normal;
  return ray - up.dot(ray) * up;
}

double Sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

// How far line segments may lie outside the box, as a fraction of its diagonal.
constexpr double kMargin = 0.05;
// Standard deviation of the blur before segments are found, as noise would break them.
constexpr double kSegmentBlurPx = 1.0;

double Diagonal(const Box& box) { return std::hypot(box.Width(), box.Height()); }

// An edge of the cuboid in the image, and the axis along which it runs.
struct ImageEdge {
  int axis;
  LineSegment segment;
};

// The mean over the points in the image; its diagonal if there are none.
double MeanDistance(const std::vector<ImageEdge>& edges, const cv::Mat& distance, int samples) {
  double sum = 0.0;
  int count = 0;
  for (const ImageEdge& edge : edges) {
    for (int i = 0; i < samples; ++i) {
      const double t = (i + 0.5) / samples;
      const auto sample =
          SampleBilinear(distance, (1.0 - t) * edge.segment.begin + t * edge.segment.end);
      if (!sample) continue;
      sum += sample->value;
      ++count;
    }
  }
  return count > 0 ? sum / count : std::hypot(distance.cols, distance.rows);
}

// The direction in the image from a pixel to a vanishing point (homogeneous), up to its sign.
Eigen::Vector2d DirectionTo(const Eigen::Vector3d& vanishing_point, const Eigen::Vector2d& pixel) {
  return vanishing_point.head<2>() - vanishing_point.z() * pixel;
}

// The angle from one direction to another, both up to their signs, in [-pi/2, pi/2), rad.
double AngleFrom(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return YawDifferenceModuloPi(std::atan2(to.y(), to.x()), std::atan2(from.y(), from.x()));
}

// The differences between outmost line segments and outmost edges, summed over the axes. Angles
// count from the direction in which the vanishing point is seen from the centre of the box. Where
// an axis has no segments or no visible edges, both its differences are `largest_angle`.
double AngleError(const CuboidView& view, const Landmark& cuboid,
                  const std::vector<ImageEdge>& edges, const std::vector<LineSegment>& segments,
                  double largest_angle) {
  const Eigen::Matrix3d to_image =
      view.camera.Intrinsics() * cuboid.frame_from_object.rotation.toRotationMatrix();
  const std::array<Eigen::Vector3d, 3> vanishing_points = {to_image.col(0), to_image.col(1),
                                                           to_image.col(2)};
  using OutmostAngles = std::array<Eigen::AlignedBox1d, 3>;  // the smallest and largest, by axis
  OutmostAngles of_segments, of_edges;
  const auto add = [&](int axis, const LineSegment& segment, OutmostAngles* angles) {
    const Eigen::Vector2d reference = DirectionTo(vanishing_points[axis], view.box.Centre());
    (*angles)[axis].extend(
        Eigen::AlignedBox1d::VectorType(AngleFrom(reference, segment.end - segment.begin)));
  };
  for (const LineSegment& segment : segments) {
    // The axis to whose vanishing point it runs best.
    const Eigen::Vector2d middle = 0.5 * (segment.begin + segment.end);
    std::optional<int> best_axis;
    double least = largest_angle;
    for (int axis = 0; axis < 3; ++axis) {
      const double angle = std::abs(
          AngleFrom(DirectionTo(vanishing_points[axis], middle), segment.end - segment.begin));
      if (angle > least) continue;
      least = angle;
      best_axis = axis;
    }
    if (best_axis) add(*best_axis, segment, &of_segments);
  }
  for (const ImageEdge& edge : edges) add(edge.axis, edge.segment, &of_edges);
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::AlignedBox1d &one = of_segments[axis], &other = of_edges[axis];
    sum += one.isEmpty() || other.isEmpty() ? 2.0 * largest_angle
                                            : std::abs(one.min().x() - other.min().x()) +
                                                  std::abs(one.max().x() - other.max().x());
  }
  return sum;
}

// Scales finite values to [0, 1].
void Normalise(std::vector<double>* values) {
  if (values->empty()) return;
  const auto [low, high] = std::ranges::minmax(*values);
  for (double& value : *values) value = high > low ? (value - low) / (high - low) : 0.0;
}

}  // namespace

double YawFacingCamera(const CuboidView& view) {
  const Eigen::Vector3d& up = view.plane_in_camera.normal;
  const Eigen::Vector3d in_ground =
      UprightRotation(up, 0.0).conjugate() * Eigen::Vector3d(-HorizontalRay(view));
  return std::atan2(in_ground.y(), in_ground.x());
}

std::optional<Landmark> CuboidAt(const CuboidView& view, double yaw, double corner_column_px) {
  const Plane& support = view.plane_in_camera;
  const Eigen::Quaterniond rotation = UprightRotation(support.normal, yaw);
  const Eigen::Matrix3d axes = rotation.toRotationMatrix();

  // Conditions that corners, as signs along the axes, are in planes through the camera. Unknowns:
  // foot along x and y from the plane's point nearest to the camera, half axes along x and y,
  // height.
  Matrix5 rows;
  Vector5 values;
  int count = 0;
  const auto add = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& plane_normal) {
    const Eigen::Vector3d along = axes.transpose() * plane_normal;
    rows.row(count) << along.x(), along.y(), corner.x() * along.x(), corner.y() * along.y(),
        (corner.z() > 0.0 ? along.z() : 0.0);
    values[count++] = support.offset * along.z();
  };
  const Eigen::Vector3d ray = view.camera.Ray(view.box.Centre());
  for (const Eigen::Vector3d& line : view.box.EdgeLines()) {
    Eigen::Vector3d inward = view.camera.BackProject(line).normal;
    if (inward.dot(ray) < 0.0) inward = -inward;
    add(-(axes.transpose() * inward).unaryExpr(&Sign), inward);
  }
  // The top corner farthest along the view; at the yaw that faces the camera two corners are
  // equally far, up to rounding.
  constexpr double kTie = 1e-9;
  const Eigen::Vector3d along = axes.transpose() * HorizontalRay(view).normalized();
  const Eigen::Vector3d column(1.0, 0.0, -corner_column_px);
  add({Sign(along.x() - kTie), Sign(along.y() - kTie), 1.0},
      view.camera.BackProject(column).normal);

  const Eigen::FullPivLU<Matrix5> decomposition(rows);
  if (!decomposition.isInvertible()) return std::nullopt;
  const Vector5 solution = decomposition.solve(values);
  if (!solution.allFinite() || !(solution.tail<3>().minCoeff() > 0.0)) return std::nullopt;

  Landmark cuboid;
  cuboid.shape_exponents = kCuboidExponent;
  cuboid.half_axes = {solution[2], solution[3], 0.5 * solution[4]};
  cuboid.frame_from_object = {
      rotation, axes * Eigen::Vector3d(solution[0], solution[1], cuboid.half_axes.z()) -
                    support.offset * support.normal};
  if (!IsInFront(cuboid)) return std::nullopt;
  return cuboid;
}

std::vector<CuboidProposal> ProposeCuboids(const CuboidView& view, int yaw_samples,
                                           int corner_samples) {
  const double facing = YawFacingCamera(view);
  std::vector<CuboidProposal> proposals;
  for (int i = 0; i < yaw_samples; ++i) {
    const double yaw = facing + 0.5 * std::numbers::pi * ((i + 0.5) / yaw_samples - 0.5);
    for (int k = 0; k < corner_samples; ++k) {
      const double column = view.box.x_min + (k + 0.5) / corner_samples * view.box.Width();
      const auto cuboid = CuboidAt(view, yaw, column);
      if (cuboid) proposals.push_back({yaw, *cuboid});
    }
  }
  return proposals;
}

CuboidEvidence EvidenceInBox(const EdgeMaps& maps, const Box& box, double min_segment_fraction) {
  const cv::Rect image(0, 0, maps.grey.cols, maps.grey.rows);
  const double margin = kMargin * Diagonal(box);
  const cv::Point first(static_cast<int>(std::floor(box.x_min - margin)),
                        static_cast<int>(std::floor(box.y_min - margin)));
  const cv::Point last(static_cast<int>(std::ceil(box.x_max + margin)) + 1,
                       static_cast<int>(std::ceil(box.y_max + margin)) + 1);
  const cv::Rect inside = cv::Rect(first, last) & image;
  CuboidEvidence evidence{maps.distance, {}};
  if (inside.empty()) return evidence;
  cv::Mat smooth;
  cv::GaussianBlur(maps.grey(inside), smooth, cv::Size(), kSegmentBlurPx);
  evidence.segments = FindLineSegments(smooth, min_segment_fraction * Diagonal(box));
  const Eigen::Vector2d offset(inside.x, inside.y);
  for (LineSegment& segment : evidence.segments) {
    segment.begin += offset;
    segment.end += offset;
  }
  return evidence;
}

CuboidErrors ComputeErrors(const CuboidView& view, const Landmark& cuboid,
                           const CuboidEvidence& evidence, const CuboidOptions& options) {
  std::vector<ImageEdge> edges;
  for (const LineSegment3& edge : VisibleCuboidEdges(cuboid)) {
    const auto begin = view.camera.Project(PointAt(cuboid, edge[0]));
    const auto end = view.camera.Project(PointAt(cuboid, edge[1]));
    int axis = 0;
    (edge[1] - edge[0]).maxCoeff(&axis);
    if (begin && end) edges.push_back({axis, {*begin, *end}});
  }
  CuboidErrors errors{};
  errors.distance =
      MeanDistance(edges, evidence.distance, options.edge_samples) / Diagonal(view.box);
  errors.angle =
      AngleError(view, cuboid, edges, evidence.segments, options.segment_angle_deg * kRadPerDeg);
  const double ratio = cuboid.half_axes.x() / cuboid.half_axes.y();
  errors.shape = std::max(0.0, std::max(ratio, 1.0 / ratio) - options.shape_threshold);
  return errors;
}

std::vector<double> CuboidCosts(const std::vector<CuboidErrors>& errors,
                                const CuboidOptions& options) {
  std::vector<double> distances, angles, costs;
  for (const CuboidErrors& error : errors) {
    distances.push_back(error.distance);
    angles.push_back(error.angle);
  }
  Normalise(&distances);
  Normalise(&angles);
  for (size_t i = 0; i < errors.size(); ++i) {
    costs.push_back(distances[i] + options.angle_weight * angles[i] +
                    options.shape_weight * errors[i].shape);
  }
  return costs;
}

std::vector<Hypothesis> BestCuboids(const CuboidView& view, const CuboidEvidence& evidence,
                                    const CuboidOptions& options) {
  const auto proposals = ProposeCuboids(view, options.yaw_samples, options.corner_samples);
  std::vector<CuboidErrors> errors;
  for (const CuboidProposal& proposal : proposals) {
    errors.push_back(ComputeErrors(view, proposal.landmark_in_camera, evidence, options));
  }
  const std::vector<double> costs = CuboidCosts(errors, options);
  std::vector<Hypothesis> best;
  for (size_t i = 0; i < proposals.size(); ++i) {
    const Hypothesis hypothesis = {proposals[i].landmark_in_camera, costs[i]};
    if (i == 0 || proposals[i].yaw != proposals[i - 1].yaw) {
      best.push_back(hypothesis);
    } else if (hypothesis.cost < best.back().cost) {
      best.back() = hypothesis;
    }
  }
  std::ranges::stable_sort(best, {}, &Hypothesis::cost);
  return best;
}

LandmarkEstimates InitialiseCuboids(const Sequence& sequence,
                                    const std::function<EdgeMaps(const Frame&)>& edges_of,
                                    const CuboidOptions& options, int threads) {
  LandmarkEstimates estimates;
  estimates.observations.resize(sequence.detections.size());
  std::vector<std::vector<int>> of_frame(sequence.frames.size());  // indices of detections
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    of_frame[sequence.detections[i].frame_index].push_back(static_cast<int>(i));
  }
  ParallelFor("frames", of_frame.size(), threads, [&](size_t frame_index) {
    if (of_frame[frame_index].empty()) return;
    const Frame& frame = sequence.frames[frame_index];
    const EdgeMaps maps = frame.image.empty() ? EdgeMaps() : edges_of(frame);
    for (const int i : of_frame[frame_index]) {
      const Detection& detection = sequence.detections[i];
      ObservationEstimate& estimate = estimates.observations[i];
      estimate.detection_index = i;
      if (maps.distance.empty()) {
        estimate.failure = "frame_without_image";
      } else if (!std::isfinite(maps.distance.at<float>(0, 0))) {
        estimate.failure = "no_edges";
      } else {
        estimate.hypotheses =
            BestCuboids({sequence.CameraOf(detection), detection.box, detection.plane_in_camera},
                        EvidenceInBox(maps, detection.box, options.min_segment_fraction), options);
        if (estimate.hypotheses.empty()) estimate.failure = "no_solution";
      }
    }
  });
  return estimates;
}

}  // namespace soslam
