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

}  // namespace

std::map<int, ShapeExponents> LearnShapeExponents(const Sequence& sequence, int min_views) {
  std::map<int, ShapeExponents> exponents;
  const auto by_object = DetectionsByObject(sequence);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    if (!sequence.objects[i].ground_truth) continue;
    // Detections with the object's cuboid, which reaches farthest, in front of the camera: all
    // edges have a tangent point.
    std::vector<int> usable;
    for (const int index : by_object[i]) {
      Landmark cuboid = *TrueLandmarkInCamera(sequence, sequence.detections[index]);
      cuboid.shape_exponents = kCuboidExponent;
      if (IsInFront(cuboid)) usable.push_back(index);
    }
    if (usable.size() < static_cast<size_t>(min_views)) continue;
    // The exponents in [1, 2] for which the true pose and size of the object fit its boxes best:
    // least Huber loss of the tangency residuals, at true camera poses if they are known.
    ShapeExponents best = kCuboidExponent;
    double least_loss = std::numeric_limits<double>::infinity();
    for (int h = 0; h <= kSteps; ++h) {
      for (int v = 0; v <= kSteps; ++v) {
        const ShapeExponents candidate(ExponentAt(h), ExponentAt(v));
        double loss = 0.0;
        for (const int index : usable) {
          loss += Loss(sequence, sequence.detections[index], candidate);
        }
        if (loss < least_loss) {
          least_loss = loss;
          best = candidate;
        }
      }
    }
    exponents.emplace(static_cast<int>(i), best);
  }
  return exponents;
}

}  // namespace soslam
