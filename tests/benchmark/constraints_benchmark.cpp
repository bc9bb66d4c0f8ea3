// SPDX-License-Identifier: BSD-3-Clause
// One evaluation of each residual block with its Jacobians.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "benchmark/inputs.h"
#include "benchmark/texture_settings.h"
#include "constraints/detection.h"
#include "constraints/odometry.h"
#include "constraints/scale_ratio.h"
#include "constraints/support.h"
#include "constraints/symmetry.h"
#include "constraints/tangency.h"
#include "constraints/upright_on_plane.h"
#include "initialisation/landmark_terms.h"
#include "orientation/edge_alignment.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// The first observation of an ellipsoid, and its landmark a little beside the truth.
struct View {
  Sequence sequence = OnlyObject(TwelveViews(), 1);
  const Detection& detection = sequence.detections.front();
  Rigid3d world_from_camera = sequence.frames.front().world_from_camera;
  Landmark landmark_in_world =
      RotatedAboutZ(sequence.objects.front().ground_truth->landmark_in_world, 0.05);
  Landmark landmark_in_camera = Transform(world_from_camera.Inverse(), landmark_in_world);
  PoseBlock pose = ToParameterBlock(world_from_camera);
  PoseBlock next_pose = ToParameterBlock(sequence.frames[1].world_from_camera);
  LandmarkBlock landmark = ToParameterBlock(landmark_in_world);
  std::array<double, kNormalSize> normal = {0.0, 0.0, 1.0};
  double offset = 0.0;
};

void Evaluate(benchmark::State& state, const ceres::CostFunction& cost,
              const std::vector<const double*>& blocks) {
  std::vector<double> residuals(static_cast<size_t>(cost.num_residuals()));
  std::vector<std::vector<double>> jacobians;
  std::vector<double*> jacobian_blocks;
  for (const int size : cost.parameter_block_sizes()) {
    jacobians.emplace_back(residuals.size() * static_cast<size_t>(size));
    jacobian_blocks.push_back(jacobians.back().data());
  }
  for (auto _ : state) {
    if (!cost.Evaluate(blocks.data(), residuals.data(), jacobian_blocks.data())) {
      state.SkipWithError("the residual cannot be evaluated");
      return;
    }
    benchmark::DoNotOptimize(residuals.data());
    benchmark::ClobberMemory();
  }
  state.counters["residuals"] = static_cast<double>(residuals.size());
}

void Evaluate(benchmark::State& state, const LandmarkCost& cost, int residuals,
              const Landmark& landmark) {
  for (auto _ : state) {
    LandmarkModel model;
    cost.AddTo(landmark, &model);
    benchmark::DoNotOptimize(model);
  }
  state.counters["residuals"] = residuals;
}

void QuadricOfBox(benchmark::State& state) {
  const View view;
  Evaluate(state, DetectionResidual(view.sequence.camera, view.detection.box, 10.0),
           {view.pose.data(), view.landmark.data()});
}
BENCHMARK(QuadricOfBox)->Name("residual/detection_quadric");

// One edge of a box, with its curvature rows; the argument is a hundred times the shape exponent.
void TangencyOfEdge(benchmark::State& state) {
  View view;
  view.landmark_in_camera.shape_exponent = 0.01 * static_cast<double>(state.range(0));
  const double bias_px = 0.0;
  const bool with_curvature = true;
  const auto edges = BoxEdges(view.sequence.camera, view.detection.box, {}, 0.02);
  Evaluate(state, TangencyResidual(edges[0], view.landmark_in_camera, &with_curvature),
           {view.pose.data(), view.landmark.data(), &bias_px});
}
BENCHMARK(TangencyOfEdge)
    ->Name("residual/tangency_of_edge")
    ->ArgName("p_percent")
    ->Arg(100)
    ->Arg(125)
    ->Arg(200);

void Odometry(benchmark::State& state) {
  const View view;
  Evaluate(state, OdometryResidual(Rigid3d(), 0.01, 0.01),
           {view.pose.data(), view.next_pose.data()});
}
BENCHMARK(Odometry)->Name("residual/odometry");

void ScaleRatio(benchmark::State& state) {
  const View view;
  Evaluate(state, ScaleRatioResidual({1.0, 1.0}, 1.0), {view.landmark.data()});
}
BENCHMARK(ScaleRatio)->Name("residual/scale_ratio");

void RatioWithSpread(benchmark::State& state) {
  const View view;
  Evaluate(state, LandmarkTermResidual(std::make_unique<RatioTerm>(ShapePrior())),
           {view.landmark.data()});
}
BENCHMARK(RatioWithSpread)->Name("residual/ratio_with_spread");

void Support(benchmark::State& state) {
  const View view;
  Evaluate(state, SupportResidual(Plane(), 10.0, 10.0), {view.landmark.data()});
}
BENCHMARK(Support)->Name("residual/support_quadric");

void Standing(benchmark::State& state) {
  const View view;
  Evaluate(state, UprightOnPlaneResidual(0.002, 0.002),
           {view.landmark.data(), view.normal.data(), &view.offset});
}
BENCHMARK(Standing)->Name("residual/standing");

void SymmetryPair(benchmark::State& state, Descriptor descriptor) {
  const View view;
  const auto image =
      std::make_shared<const SymmetryImage>(EdgesOfTwelveViews()[0]->maps, view.detection.box);
  const Eigen::Vector2d pixel = view.detection.box.Centre() + Eigen::Vector2d(10.0, 5.0);
  Evaluate(
      state,
      SymmetryResidual(descriptor, image, view.sequence.camera, pixel, kEllipsoidExponent, 1.0),
      {view.pose.data(), view.landmark.data()});
}
BENCHMARK_CAPTURE(SymmetryPair, dt, Descriptor::kDistanceTransform)
    ->Name("residual/symmetry_pair/distance_transform");
BENCHMARK_CAPTURE(SymmetryPair, improved, Descriptor::kImprovedDt)
    ->Name("residual/symmetry_pair/improved_dt");
BENCHMARK_CAPTURE(SymmetryPair, linearised, Descriptor::kLinearisedDt)
    ->Name("residual/symmetry_pair/improved_dt_linearised");

// All pairs of one observation.
void Asymmetry(benchmark::State& state) {
  const View view;
  const auto image =
      std::make_shared<const SymmetryImage>(EdgesOfTwelveViews()[0]->maps, view.detection.box);
  const AsymmetryTerm term(image, view.sequence.camera, view.landmark_in_camera, TextureOfST(),
                           SymmetryOfST(), 1.0);
  Evaluate(state, term, term.NumPairs(), view.landmark_in_camera);
}
BENCHMARK(Asymmetry)->Name("residual/asymmetry_of_observation");

// All points of one observation.
void EdgeAlignment(benchmark::State& state) {
  const View view;
  const auto image =
      std::make_shared<const EdgeImage>(EdgeImage{EdgesOfTwelveViews()[0], view.detection.box, {}});
  const EdgeTerm term(image, view.sequence.camera, view.landmark_in_camera, EdgeOptions());
  Evaluate(state, term, term.NumPoints(), view.landmark_in_camera);
}
BENCHMARK(EdgeAlignment)->Name("residual/edge_alignment_of_observation");

}  // namespace
}  // namespace soslam
