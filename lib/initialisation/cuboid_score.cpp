// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/cuboid_score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "geometry/angles.h"
#include "geometry/wireframe.h"

namespace soslam {
namespace {

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

std::vector<ImageEdge> VisibleEdges(const CuboidView& view, const Landmark& cuboid) {
  std::vector<ImageEdge> visible;
  for (const LineSegment3& edge : VisibleCuboidEdges(cuboid)) {
    const auto begin = view.camera.Project(PointAt(cuboid, edge[0]));
    const auto end = view.camera.Project(PointAt(cuboid, edge[1]));
    int axis = 0;
    (edge[1] - edge[0]).maxCoeff(&axis);
    if (begin && end) visible.push_back({axis, {*begin, *end}});
  }
  return visible;
}

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

// The axis to whose vanishing point a segment runs best; none beyond the largest angle.
std::optional<int> AxisOf(const LineSegment& segment,
                          const std::array<Eigen::Vector3d, 3>& vanishing_points,
                          double largest_angle) {
  const Eigen::Vector2d middle = 0.5 * (segment.begin + segment.end);
  std::optional<int> best;
  for (int axis = 0; axis < 3; ++axis) {
    const double angle = std::abs(
        AngleFrom(DirectionTo(vanishing_points[axis], middle), segment.end - segment.begin));
    if (angle > largest_angle) continue;
    largest_angle = angle;
    best = axis;
  }
  return best;
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
    if (const auto axis = AxisOf(segment, vanishing_points, largest_angle)) {
      add(*axis, segment, &of_segments);
    }
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

CuboidErrors ErrorsOf(const CuboidView& view, const Landmark& cuboid,
                      const CuboidEvidence& evidence, const CuboidOptions& options) {
  const std::vector<ImageEdge> edges = VisibleEdges(view, cuboid);
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

}  // namespace soslam
