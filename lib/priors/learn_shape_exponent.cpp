// SPDX-License-Identifier: BSD-3-Clause
#include "priors/learn_shape_exponent.h"

#include <cmath>
#include <limits>

#include "constraints/tangency.h"

namespace soslam {
namespace {

constexpr double kHuberDelta = 1.0;      // of residuals in standard deviations
constexpr double kStep = 0.01;           // finer than boxes can tell
constexpr double kSigmaFraction = 0.02;  // of an edge, by the side of its box

double HuberLoss(double residual) {
  const double size = std::abs(residual);
  return size <= kHuberDelta ? 0.5 * size * size : kHuberDelta * (size - 0.5 * kHuberDelta);
}

double Loss(const Sequence& sequence, const Detection& detection, const Landmark& in_world) {
  const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
  const Rigid3d world_from_camera = frame.true_world_from_camera.value_or(frame.world_from_camera);
  const Landmark in_camera = Transform(world_from_camera.Inverse(), in_world);
  double loss = 0.0;
  for (const BoxEdge& edge :
       BoxEdges(sequence.camera, detection.box, detection.is_bound, kSigmaFraction)) {
    loss += HuberLoss(Tangency(edge, in_camera, TangentDepth(edge, in_camera), 0.0, nullptr));
  }
  return loss;
}

}  // namespace

double BestShapeExponent(const Sequence& sequence, int object_index,
                         const std::vector<int>& detections) {
  Landmark body =
      sequence.objects[static_cast<size_t>(object_index)].ground_truth.value().landmark_in_world;
  double best = kCuboidExponent;
  double least_loss = std::numeric_limits<double>::infinity();
  const int steps = static_cast<int>(std::lround((kEllipsoidExponent - kCuboidExponent) / kStep));
  for (int i = 0; i <= steps; ++i) {
    body.shape_exponent = kCuboidExponent + kStep * i;
    double loss = 0.0;
    for (const int index : detections) {
      loss += Loss(sequence, sequence.detections[static_cast<size_t>(index)], body);
    }
    if (loss < least_loss) {
      least_loss = loss;
      best = body.shape_exponent;
    }
  }
  return best;
}

std::map<int, double> LearnShapeExponents(const Sequence& sequence, int min_views) {
  std::map<int, double> exponents;
  const auto by_object = DetectionsByObject(sequence);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    if (!sequence.objects[i].ground_truth) continue;
    if (by_object[i].size() < static_cast<size_t>(min_views)) continue;
    const int object_index = static_cast<int>(i);
    exponents[object_index] = BestShapeExponent(sequence, object_index, by_object[i]);
  }
  return exponents;
}

}  // namespace soslam
