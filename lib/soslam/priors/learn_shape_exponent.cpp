// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "soslam/constraints/loss.h"
#include "soslam/constraints/tangency.h"
#include "soslam/priors/learn_priors.h"

namespace soslam {
namespace {

constexpr int kSteps = 20;               // from 1 to 2: finer than boxes can resolve
constexpr double kSigmaFraction = 0.02;  // of an edge, as a fraction of the side of its box

double ExponentAt(int step) {
  return kCuboidExponent + (kEllipsoidExponent - kCuboidExponent) * step / kSteps;
}

double Loss(const Sequence& sequence, const Detection& detection,
            const ShapeExponents& shape_exponents) {
  Landmark in_camera = TrueLandmarkInCamera(sequence, detection).value();
  in_camera.shape_exponents = shape_exponents;
  const ceres::HuberLoss huber(1.0);  // of residuals in standard deviations
  double loss = 0.0;
  for (const BoxEdge& edge : BoxEdges(sequence.CameraOf(detection), detection.box,
                                      detection.is_one_sided, kSigmaFraction)) {
    loss += EvaluateLoss(huber, TangencyAtOwnDepth(edge, in_camera, nullptr).value()).cost;
  }
  return loss;
}

// Detections of objects whose cuboid, which reaches farthest, is in front of the camera: all edges
// have a tangent point.
std::vector<int> WhollyInFront(const Sequence& sequence, const std::vector<int>& detections) {
  std::vector<int> in_front;
  for (const int index : detections) {
    Landmark cuboid = *TrueLandmarkInCamera(sequence, sequence.detections[index]);
    cuboid.shape_exponents = kCuboidExponent;
    if (IsInFront(cuboid)) in_front.push_back(index);
  }
  return in_front;
}

// The exponents in [1, 2] for which the true pose and size of an object fit its boxes best: least
// Huber loss of the tangency residuals, at true camera poses if they are known.
ShapeExponents BestShapeExponents(const Sequence& sequence, const std::vector<int>& detections) {
  ShapeExponents best = kCuboidExponent;
  double least_loss = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const ShapeExponents exponents(ExponentAt(i), ExponentAt(j));
      double loss = 0.0;
      for (const int index : detections) {
        loss += Loss(sequence, sequence.detections[index], exponents);
      }
      if (loss < least_loss) {
        least_loss = loss;
        best = exponents;
      }
    }
  }
  return best;
}

}  // namespace

std::map<int, ShapeExponents> LearnShapeExponents(const Sequence& sequence, int min_views) {
  std::map<int, ShapeExponents> exponents;
  const auto by_object = DetectionsByObject(sequence);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    if (!sequence.objects[i].ground_truth) continue;
    const std::vector<int> usable = WhollyInFront(sequence, by_object[i]);
    if (usable.size() < static_cast<size_t>(min_views)) continue;
    exponents.emplace(static_cast<int>(i), BestShapeExponents(sequence, usable));
  }
  return exponents;
}

}  // namespace soslam
