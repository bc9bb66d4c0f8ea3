// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "soslam/image/binary_descriptor.h"

namespace soslam {
namespace {

constexpr int kFields = 43;
constexpr int kFieldsOfRing = 6;
// Radii of the rings as the authors' implementation has them, whose outer ring has a radius of two
// thirds of its pattern scale of 22 px.
constexpr std::array<double, kFreakRings> kRingRadii = {24, 18, 13, 9, 6, 4, 3, 0};
constexpr double kPxPerRadius = 22.0 / 36.0;
// Radius of the outer ring plus the standard deviation of its fields, px.
constexpr int kFreakPatchRadius = 22;

// Standard deviation of the Gaussian of a ring's fields, px: half the ring's radius; for the centre
// that of the innermost ring.
double FieldSigma(size_t ring) {
  const double radius = ring + 1 < kFreakRings ? kRingRadii[ring] : kRingRadii[ring - 1];
  return 0.5 * radius * kPxPerRadius;
}

struct ReceptiveField {
  size_t ring = 0;
  Eigen::Vector2d offset;  // from the centre of the patch, px
  cv::Point pixel;         // the same in whole pixels
};
using Retina = std::array<ReceptiveField, kFields>;

// Neighbouring rings are turned by half the angle between two fields.
Retina MakeRetina() {
  Retina retina;
  for (int i = 0; i < kFields; ++i) {
    ReceptiveField& field = retina[static_cast<size_t>(i)];
    field.ring = static_cast<size_t>(i / kFieldsOfRing);
    const double steps = i % kFieldsOfRing + (field.ring % 2 == 0 ? 0.0 : 0.5);
    const double angle = steps * 2.0 * std::numbers::pi / kFieldsOfRing;
    field.offset =
        kRingRadii[field.ring] * kPxPerRadius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    field.pixel = {static_cast<int>(std::lround(field.offset.x())),
                   static_cast<int>(std::lround(field.offset.y()))};
  }
  return retina;
}

// Covariance of the grey values of two fields, up to a constant that all have in common, in an
// image whose power falls with the square of the frequency, as that of natural images does: the
// mean of -log |x| over Gaussian x with mean `offset` and the sum of the fields' variances.
double FieldCovariance(const Eigen::Vector2d& offset, double variance) {
  const double squared = offset.squaredNorm();
  if (squared < 1e-12) return -0.5 * (std::log(2.0 * variance) - std::numbers::egamma);
  return -0.5 * (std::log(squared) - std::expint(-squared / (2.0 * variance)));
}

using FieldPair = std::pair<int, int>;

// The authors learn the pairs from images: of the pairs whose bits have a mean near 1/2, one after
// the other is taken that correlates least with those taken before. Here the images are natural
// ones in the mean: all bits then have a mean of 1/2, and the correlations of their differences
// are known. The first pair is the outermost, the first of equal ones is taken.
std::vector<FieldPair> SelectPairs() {
  const Retina retina = MakeRetina();
  Eigen::MatrixXd fields(kFields, kFields);
  for (int i = 0; i < kFields; ++i) {
    for (int j = 0; j < kFields; ++j) {
      const double variance =
          std::pow(FieldSigma(retina[i].ring), 2) + std::pow(FieldSigma(retina[j].ring), 2);
      fields(i, j) = FieldCovariance(retina[i].offset - retina[j].offset, variance);
    }
  }
  std::vector<FieldPair> all;
  for (int i = 1; i < kFields; ++i) {
    for (int j = 0; j < i; ++j) all.emplace_back(i, j);
  }
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(count, kFields);
  for (Eigen::Index k = 0; k < count; ++k) {
    difference(k, all[k].first) = 1.0;
    difference(k, all[k].second) = -1.0;
  }
  const Eigen::MatrixXd covariances = difference * fields * difference.transpose();
  const Eigen::VectorXd scale = covariances.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd correlations = scale.asDiagonal() * covariances * scale.asDiagonal();
  // Rounded, so that pairs that the symmetry of the retina makes equal are equal.
  constexpr double kRounding = 1e6;
  correlations = (correlations.array() * kRounding).round() / kRounding;
  std::vector<FieldPair> selected;
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(count);
  while (selected.size() < FreakBits().size()) {
    Eigen::Index next = 0;
    largest.minCoeff(&next);
    selected.push_back(all[static_cast<size_t>(next)]);
    largest = largest.cwiseMax(correlations.col(next).cwiseAbs());
    largest[next] = std::numeric_limits<double>::infinity();
  }
  return selected;
}

}  // namespace

FreakImage SmoothForFreak(const cv::Mat& grey) {
  CV_Assert(grey.type() == CV_8UC1);
  FreakImage smoothed;
  for (size_t ring = 0; ring < kFreakRings; ++ring) {
    cv::GaussianBlur(grey, smoothed[ring], cv::Size(), FieldSigma(ring));
  }
  return smoothed;
}

std::optional<FreakBits> FreakDescriptor(const FreakImage& smoothed, const Eigen::Vector2d& pixel,
                                         bool mirrored) {
  static const Retina retina = MakeRetina();
  static const std::vector<FieldPair> pairs = SelectPairs();
  const auto centre = PatchCentre(smoothed.front().size(), pixel, kFreakPatchRadius);
  if (!centre) return std::nullopt;
  std::array<std::uint8_t, kFields> grey;
  for (size_t i = 0; i < retina.size(); ++i) {
    const cv::Point& offset = retina[i].pixel;
    const int x = centre->x + (mirrored ? -offset.x : offset.x);
    grey[i] = smoothed[retina[i].ring].at<std::uint8_t>(centre->y + offset.y, x);
  }
  return BitsWhere<FreakBits().size()>(
      [&](size_t i) { return grey[pairs[i].first] < grey[pairs[i].second]; });
}

}  // namespace soslam
