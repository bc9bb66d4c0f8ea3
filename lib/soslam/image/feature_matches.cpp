// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/feature_matches.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <opencv2/features2d.hpp>
#include <tuple>

namespace soslam {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Pixels at which a second feature is another place, not the same one at another scale.
constexpr double kElsewherePx = 8.0;

// Rounding errors of a translation, such as that of a camera that only turns.
double BoundRounding(const Eigen::Vector3d& place) { return 1e-9 * (1.0 + place.norm()); }

// One row per feature.
using Coordinates = Eigen::Array<float, Eigen::Dynamic, 2>;
using Lines = Eigen::Array<float, Eigen::Dynamic, 3>;  // (a, b, c): a x + b y + c is a distance

Lines EpipolarLines(const Eigen::Matrix3d& fundamental, const Eigen::Matrix2Xd& pixels) {
  Lines lines(pixels.cols(), 3);
  for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
    const Eigen::Vector3d line = fundamental * pixels.col(i).homogeneous();
    const double norm = line.head<2>().norm();
    if (norm > 0.0) {
      lines.row(i) = (line / norm).cast<float>().transpose().array();
    } else {
      lines.row(i) << 0.0F, 0.0F, kInfinity;  // the pixel is the epipole
    }
  }
  return lines;
}

// Pixels moved by the homography of a rotation; infinite where that is behind the camera.
Coordinates ApplyHomography(const Eigen::Matrix3d& homography, const Eigen::Matrix2Xd& pixels) {
  Coordinates moved = Coordinates::Constant(pixels.cols(), 2, kInfinity);
  for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
    const Eigen::Vector3d target = homography * pixels.col(i).homogeneous();
    if (target.z() > 0.0) moved.row(i) = target.hnormalized().cast<float>().transpose().array();
  }
  return moved;
}

// Which features of two views may show the same point, by the poses alone.
class TwoViewGeometry {
 public:
  TwoViewGeometry(const FeatureView& first, const FeatureView& second)
      : first_pixels_(first.features.pixels.cast<float>().transpose().array()),
        second_pixels_(second.features.pixels.cast<float>().transpose().array()) {
    const Rigid3d second_from_first = second.world_from_camera.Inverse() * first.world_from_camera;
    const Eigen::Matrix3d rotation = second_from_first.rotation.toRotationMatrix();
    const Eigen::Matrix3d first_ray_from_pixel = first.camera.Intrinsics().inverse();
    const Eigen::Matrix3d second_ray_from_pixel = second.camera.Intrinsics().inverse();
    const Eigen::Matrix3d homography = second.camera.Intrinsics() * rotation * first_ray_from_pixel;
    translation_ = second_from_first.translation;
    only_turns_ = translation_.norm() <= BoundRounding(first.world_from_camera.translation);
    at_infinity_ = ApplyHomography(homography, first.features.pixels);
    if (only_turns_) {
      back_at_infinity_ = ApplyHomography(homography.inverse(), second.features.pixels);
      return;
    }
    const Eigen::Matrix3d fundamental =
        second_ray_from_pixel.transpose() * Skew(translation_) * rotation * first_ray_from_pixel;
    lines_in_second_ = EpipolarLines(fundamental, first.features.pixels);
    lines_in_first_ = EpipolarLines(fundamental.transpose(), second.features.pixels);
    first_rays_ = rotation * first_ray_from_pixel * first.features.pixels.colwise().homogeneous();
    second_rays_ = second_ray_from_pixel * second.features.pixels.colwise().homogeneous();
  }

  // The larger one of the distances (px) of a feature of the first view and each of the second from
  // each other's epipolar lines; of a camera that only turns, from where the rotation moves them.
  void Distances(Eigen::Index first, Eigen::ArrayXf* distances) const {
    const auto x = second_pixels_.col(0), y = second_pixels_.col(1);
    const float u = first_pixels_(first, 0), v = first_pixels_(first, 1);
    if (only_turns_) {
      *distances = ((x - at_infinity_(first, 0)).square() + (y - at_infinity_(first, 1)).square())
                       .max((back_at_infinity_.col(0) - u).square() +
                            (back_at_infinity_.col(1) - v).square())
                       .sqrt();
      return;
    }
    const float a = lines_in_second_(first, 0), b = lines_in_second_(first, 1);
    const float c = lines_in_second_(first, 2);
    *distances =
        (a * x + b * y + c)
            .abs()
            .max((lines_in_first_.col(0) * u + lines_in_first_.col(1) * v + lines_in_first_.col(2))
                     .abs());
  }

  // True if the rays of two features near each other's epipolar lines meet in front of both
  // cameras, or are parallel but for errors of `tolerance_px`.
  bool MeetInFront(Eigen::Index first, Eigen::Index second, double tolerance_px) const {
    if ((second_pixels_.row(second) - at_infinity_.row(first)).matrix().norm() <= tolerance_px) {
      return true;
    }
    if (only_turns_) return false;
    // At the depths d and e, which are z in the cameras, d first + translation = e second.
    const Eigen::Vector3d first_ray = first_rays_.col(first);
    const Eigen::Vector3d second_ray = second_rays_.col(second);
    const Eigen::Vector3d normal = first_ray.cross(second_ray);
    return second_ray.cross(translation_).dot(normal) > 0.0 &&
           first_ray.cross(translation_).dot(normal) > 0.0;
  }

 private:
  Coordinates first_pixels_, second_pixels_;
  Eigen::Vector3d translation_;  // of second_from_first
  bool only_turns_ = false;
  Coordinates at_infinity_;  // where the second view shows the first one's features, if far away
  Coordinates back_at_infinity_;  // where the first view shows those of the second
  Lines lines_in_second_, lines_in_first_;
  Eigen::Matrix3Xd first_rays_, second_rays_;  // in the second camera's frame
};

// A pair of features, and the squared distance of their descriptors in bytes.
struct Candidate {
  int first;
  int second;
  int distance;
};

// For each feature of one view its best candidate, null where it has none, and how good the best
// one elsewhere is, more than kElsewherePx away.
struct BestCandidates {
  std::vector<const Candidate*> best;
  std::vector<int> elsewhere;
};

// `feature` and `other` say which views these are; `pixels` are those of the other one's features.
BestCandidates FindBest(const std::vector<Candidate>& candidates, int Candidate::*feature,
                        Eigen::Index features, int Candidate::*other,
                        const Eigen::Matrix2Xd& pixels) {
  BestCandidates found{std::vector<const Candidate*>(features),
                       std::vector<int>(features, std::numeric_limits<int>::max())};
  for (const Candidate& candidate : candidates) {
    const Candidate*& best = found.best[candidate.*feature];
    if (best == nullptr || candidate.distance < best->distance) best = &candidate;
  }
  for (const Candidate& candidate : candidates) {
    const int best = found.best[candidate.*feature]->*other;
    int& elsewhere = found.elsewhere[candidate.*feature];
    if (candidate.distance < elsewhere &&
        (pixels.col(candidate.*other) - pixels.col(best)).norm() > kElsewherePx) {
      elsewhere = candidate.distance;
    }
  }
  return found;
}

// True if all views of a track see one point, which may be at infinity, within this distance of its
// projections. Pairs of images alone let a match slide along the epipolar line.
bool HasOnePoint(const FeatureTrack& track, const std::vector<FeatureView>& views,
                 double max_error_px) {
  // The homogeneous point (x, w) with the smallest sum of |across (x - w centre)|^2, where `across`
  // projects along a ray; centres are relative to the first one, in units of their spread.
  const Eigen::Vector3d origin = views[track.places.front().image].world_from_camera.translation;
  double spread = 0.0;
  for (const FeatureTrack::Place& place : track.places) {
    spread = std::max(spread, (views[place.image].world_from_camera.translation - origin).norm());
  }
  const bool only_turns = spread <= BoundRounding(origin);
  const double unit = only_turns ? 1.0 : spread;
  Eigen::Matrix4d normal_matrix = Eigen::Matrix4d::Zero();
  if (only_turns) normal_matrix(3, 3) = 1.0;  // all points are at infinity
  for (const FeatureTrack::Place& place : track.places) {
    const FeatureView& view = views[place.image];
    const Eigen::Vector3d ray =
        (view.world_from_camera.rotation * view.camera.Ray(place.pixel)).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    Eigen::Matrix<double, 3, 4> residual;
    residual << across, -across * (view.world_from_camera.translation - origin) / unit;
    normal_matrix += residual.transpose() * residual;
  }
  const Eigen::Vector4d point =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(normal_matrix).eigenvectors().col(0);
  const auto error_px = [&](const FeatureTrack::Place& place, double sign) {
    const FeatureView& view = views[place.image];
    const Eigen::Vector3d centre = (view.world_from_camera.translation - origin) / unit;
    const auto pixel = view.camera.Project(view.world_from_camera.rotation.conjugate() *
                                           (sign * (point.head<3>() - point.w() * centre)));
    return pixel ? (*pixel - place.pixel).norm() : std::numeric_limits<double>::infinity();
  };
  return std::ranges::any_of(std::array{1.0, -1.0}, [&](double sign) {
    return std::ranges::all_of(track.places, [&](const FeatureTrack::Place& place) {
      return error_px(place, sign) <= max_error_px;
    });
  });
}

}  // namespace

ImageFeatures FindFeatures(const cv::Mat& grey, const MatchOptions& options) {
  constexpr int kLayers = 3;  // of each octave; this and the edge threshold are Lowe's
  constexpr double kEdgeThreshold = 10.0;
  std::vector<cv::KeyPoint> points;
  cv::Mat histograms;
  cv::SIFT::create(options.max_features, kLayers, options.contrast_threshold, kEdgeThreshold)
      ->detectAndCompute(grey, cv::noArray(), points, histograms);
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int i) {
    const cv::KeyPoint& point = points[i];
    return std::tuple(point.pt.x, point.pt.y, point.size, point.angle, i);
  });
  ImageFeatures features;
  const auto count = static_cast<Eigen::Index>(points.size());
  features.pixels.resize(2, count);
  features.descriptors.resize(Eigen::NoChange, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const cv::Point2f& pixel = points[order[i]].pt;
    features.pixels.col(i) << pixel.x, pixel.y;
    const Eigen::Map<const Eigen::Array<float, 128, 1>> histogram(histograms.ptr<float>(order[i]));
    const float scale =
        ImageFeatures::kDescriptorScale / std::sqrt(std::max(1.0F, histogram.sum()));
    features.descriptors.col(i) =
        (histogram.sqrt() * scale).round().min(255.0F).cast<std::uint8_t>().matrix();
  }
  return features;
}

std::vector<FeatureMatch> MatchFeatures(const FeatureView& first, const FeatureView& second,
                                        const MatchOptions& options) {
  const TwoViewGeometry geometry(first, second);
  const auto max_px = static_cast<float>(options.max_epipolar_px);
  std::vector<Candidate> candidates;
  Eigen::ArrayXf distances;
  for (int i = 0; i < static_cast<int>(first.features.descriptors.cols()); ++i) {
    geometry.Distances(i, &distances);
    for (int j = 0; j < static_cast<int>(distances.size()); ++j) {
      if (!(distances[j] <= max_px) || !geometry.MeetInFront(i, j, options.max_epipolar_px)) {
        continue;
      }
      const std::uint8_t* const a = first.features.descriptors.col(i).data();
      const std::uint8_t* const b = second.features.descriptors.col(j).data();
      int sum = 0;
      for (int k = 0; k < ImageFeatures::Descriptors::RowsAtCompileTime; ++k) {
        const int difference = a[k] - b[k];
        sum += difference * difference;
      }
      candidates.push_back({i, j, sum});
    }
  }
  const Eigen::Matrix2Xd &first_pixels = first.features.pixels,
                         &second_pixels = second.features.pixels;
  const BestCandidates of_first = FindBest(candidates, &Candidate::first, first_pixels.cols(),
                                           &Candidate::second, second_pixels);
  const BestCandidates of_second = FindBest(candidates, &Candidate::second, second_pixels.cols(),
                                            &Candidate::first, first_pixels);
  std::vector<FeatureMatch> matches;
  for (const Candidate* best : of_first.best) {
    if (best == nullptr || of_second.best[best->second] != best) continue;
    const double distance = std::sqrt(best->distance);
    const double elsewhere =
        std::sqrt(std::min(of_first.elsewhere[best->first], of_second.elsewhere[best->second]));
    constexpr double kScale = ImageFeatures::kDescriptorScale;
    if (distance > options.max_descriptor_distance * kScale ||
        distance >= options.max_ratio * elsewhere) {
      continue;
    }
    matches.push_back({best->first, best->second, static_cast<float>(distance / kScale)});
  }
  return matches;
}

// Images of a video show the same when they are neighbours, and again whenever the camera returns,
// which may be at any time. So images are paired at all small gaps, and at larger ones that grow by
// a fifth each: the number of pairs grows with n log n, and every return of the camera, which lasts
// some images, is met by pairs of about that gap. Tracks join them.
std::vector<std::pair<int, int>> ImagePairs(const std::vector<int>& segments) {
  const int count = static_cast<int>(segments.size());
  std::vector<int> gaps;
  for (int gap = 1; gap < count;
       gap = std::max(gap + 1, static_cast<int>(std::lround(1.2 * gap)))) {
    gaps.push_back(gap);
  }
  std::vector<std::pair<int, int>> pairs;
  for (int first = 0; first < count; ++first) {
    for (const int gap : gaps) {
      const int second = first + gap;
      if (second < count && segments[second] == segments[first]) pairs.emplace_back(first, second);
    }
  }
  return pairs;
}

std::vector<FeatureTrack> JoinMatches(const std::vector<FeatureView>& views,
                                      const std::vector<std::pair<int, int>>& pairs,
                                      const std::vector<std::vector<FeatureMatch>>& matches,
                                      const MatchOptions& options) {
  // All features are counted in one row, view after view. Those of one pixel, which differ in the
  // orientation of their descriptors, are the first of them.
  std::vector<int> begins, view_of, first_of_pixel;
  for (size_t view = 0; view < views.size(); ++view) {
    const Eigen::Matrix2Xd& pixels = views[view].features.pixels;
    begins.push_back(static_cast<int>(view_of.size()));
    for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
      const bool is_known = i > 0 && pixels.col(i) == pixels.col(i - 1);
      first_of_pixel.push_back(is_known ? first_of_pixel.back() : static_cast<int>(view_of.size()));
      view_of.push_back(static_cast<int>(view));
    }
  }
  struct Link {
    float distance;
    int first, second;
  };
  std::vector<Link> links;
  for (size_t pair = 0; pair < pairs.size(); ++pair) {
    for (const FeatureMatch& match : matches[pair]) {
      links.push_back({match.distance, first_of_pixel[begins[pairs[pair].first] + match.first],
                       first_of_pixel[begins[pairs[pair].second] + match.second]});
    }
  }
  std::ranges::sort(links, {}, [](const Link& link) {
    return std::tuple(link.distance, link.first, link.second);
  });
  // Tracks are rings of features: to exchange the successors of two features joins their rings.
  std::vector<int> next(view_of.size());
  std::iota(next.begin(), next.end(), 0);
  const auto ring_of = [&](int feature) {
    std::vector<int> ring = {feature};
    for (int i = next[feature]; i != feature; i = next[i]) ring.push_back(i);
    return ring;
  };
  const auto track_of = [&](std::vector<int> features) {
    std::ranges::sort(features);
    FeatureTrack track;
    for (const int feature : features) {
      const int view = view_of[feature];
      track.places.push_back({view, views[view].features.pixels.col(feature - begins[view])});
    }
    return track;
  };
  const auto has_an_image_twice = [](const FeatureTrack& track) {
    return std::ranges::adjacent_find(track.places, {}, &FeatureTrack::Place::image) !=
           track.places.end();
  };
  for (const Link& link : links) {
    std::vector<int> features = ring_of(link.first);
    std::ranges::copy(ring_of(link.second), std::back_inserter(features));
    const FeatureTrack joined = track_of(std::move(features));
    if (!has_an_image_twice(joined) &&
        HasOnePoint(joined, views, options.max_reprojection_error_px)) {
      std::swap(next[link.first], next[link.second]);
    }
  }
  std::vector<FeatureTrack> tracks;
  for (int i = 0; i < static_cast<int>(next.size()); ++i) {
    std::vector<int> ring = ring_of(i);
    if (ring.size() >= 2 && std::ranges::min(ring) == i)
      tracks.push_back(track_of(std::move(ring)));
  }
  return tracks;
}

}  // namespace soslam
