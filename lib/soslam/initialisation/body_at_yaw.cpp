// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/body_at_yaw.h"

#include <Eigen/Dense>
#include <cmath>

#include "soslam/constraints/loss.h"
#include "soslam/constraints/tangency.h"

namespace soslam {
namespace {

constexpr int kMaxRounds = 20;
// The first rounds hold the body to the prior's ratio: the initial guess is too rough to adapt it.
constexpr int kRoundsWithFixedRatio = 3;
// Smallest reciprocal condition number (1-norm) of the first round's system: below it, the boxes do
// not determine the body.
constexpr double kMinConditionReciprocal = 1e-9;
// Smallest one of later rounds, which reweight, drop and add edges: below it, rounding errors
// dominate the solution.
constexpr double kMinLaterConditionReciprocal = 1e-13;
// Smallest share of the initial size. One box without size and height has a trivial solution: a
// body of no size at the camera's centre.
constexpr double kLeastSizeShare = 1e-6;

}  // namespace

struct BodyAtYaw::LinearSystem {
  using Row = Eigen::Matrix<double, 6, 1>;
  using Matrix = Eigen::Matrix<double, 6, 6>;

  // Adds the cost weight (row . unknowns + constant)^2.
  void Add(const Row& row, double constant, double weight) {
    const Row weighted = weight * row;
    normal_matrix += weighted * row.transpose();
    right_side -= constant * weighted;
  }

  // The unknowns as a linear function of fewer ones that are free.
  using FromFree = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;

  std::optional<Row> Solve(const FromFree& from_free, double min_condition_reciprocal) const {
    using Free = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
    const Eigen::LLT<Free> factor(Free(from_free.transpose() * normal_matrix * from_free));
    if (factor.info() != Eigen::Success || !(factor.rcond() > min_condition_reciprocal)) {
      return std::nullopt;
    }
    const Row unknowns = from_free * factor.solve(from_free.transpose() * right_side);
    return unknowns.allFinite() ? std::optional(unknowns) : std::nullopt;
  }

  Matrix normal_matrix = Matrix::Zero();
  Row right_side = Row::Zero();
};

BodyAtYaw::BodyAtYaw(const ObjectEvidence& evidence)
    : evidence_(evidence), upright_(evidence.plane), loss_(evidence.huber_delta) {
  if (evidence.HasRatio()) ratio_.emplace(*evidence.prior);
  // Initial guess at the point nearest to all rays, as high as the boxes.
  const Eigen::Vector3d point = NearestToAllRays(evidence);
  const Eigen::Vector3d from_origin = point - upright_.origin;
  start_.foot = {from_origin.dot(upright_.x), from_origin.dot(upright_.y)};
  start_.half_axes.setOnes();
  if (evidence.prior) start_.half_axes.head<2>() = evidence.prior->ratio;
  double sum = 0.0;
  for (const BoxView& view : evidence.views) {
    const double depth = (view.camera_from_reference * point).z();
    sum += 0.5 * std::abs(depth) * HeightAtUnitDepth(view);
  }
  start_.half_axes *= sum / static_cast<double>(evidence.views.size());
  if (evidence.height_is_free) {
    start_.height_m = from_origin.dot(upright_.normal) - start_.half_axes.z();
  }
}

std::optional<Landmark> BodyAtYaw::Solve(double yaw) const {
  Body body = start_;
  body.yaw = yaw;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Eigen::Vector3d before = body.half_axes;
    if (!Step(round, &body)) {
      if (round == 0) return std::nullopt;
      break;
    }
    if (round >= kRoundsWithFixedRatio &&
        (body.half_axes - before).norm() < evidence_.tolerance.half_axes * before.norm()) {
      break;
    }
  }
  const Landmark landmark = MakeLandmark(body);
  for (const BoxView& view : evidence_.views) {
    if (!IsInFront(Transform(view.camera_from_reference, landmark))) return std::nullopt;
  }
  return landmark;
}

Landmark BodyAtYaw::MakeLandmark(const Body& body) const {
  UprightVector parameters;
  parameters << body.yaw, body.foot, body.half_axes.array().log().matrix(), body.height_m;
  return upright_.LandmarkAt(parameters, evidence_.Exponents(), evidence_.RestsOn());
}

bool BodyAtYaw::Step(int round, Body* body) const {
  const bool is_first = round == 0;
  LinearSystem system;
  const Landmark landmark = MakeLandmark(*body);
  for (const BoxView& view : evidence_.views) AddView(view, landmark, *body, is_first, &system);
  // RatioTerm to first order about the object of this height with the prior's ratios. There both
  // residuals are zero, and a derivative by a half axis is that by its logarithm divided by the
  // half axis.
  for (int i = 0; ratio_ && i < 2; ++i) {
    const Eigen::Vector3d of_prior = body->half_axes.z() * evidence_.prior->ratio.homogeneous();
    LinearSystem::Row row = LinearSystem::Row::Zero();
    row.segment<3>(2) = ratio_->d_log_half_axes.row(i).transpose().cwiseQuotient(of_prior);
    system.Add(row, 0.0, 1.0);
  }
  if (evidence_.HasSize()) {  // LengthTerm to first order about the previous length
    const auto [length_m, axis] = *evidence_.prior->Length();
    const double before = body->half_axes[axis];
    LinearSystem::Row row = LinearSystem::Row::Zero();
    row(2 + axis) = 1.0 / (length_m.log_sigma * before);
    system.Add(row, LengthResidual(length_m, before) - row(2 + axis) * before, 1.0);
  }
  LinearSystem::FromFree from_free = LinearSystem::Matrix::Identity();
  if (ratio_ && round < kRoundsWithFixedRatio) {
    from_free.col(2).segment<3>(2) = evidence_.prior->ratio.homogeneous();
    from_free.col(3) = from_free.col(5);
    from_free.conservativeResize(Eigen::NoChange, 4);
  }
  if (!evidence_.height_is_free) {
    from_free.conservativeResize(Eigen::NoChange, from_free.cols() - 1);
  }
  const auto unknowns =
      system.Solve(from_free, is_first ? kMinConditionReciprocal : kMinLaterConditionReciprocal);
  const double least_m = kLeastSizeShare * start_.half_axes.minCoeff();
  if (!unknowns || !(unknowns->segment<3>(2).minCoeff() > least_m)) return false;
  body->foot = unknowns->head<2>();
  body->half_axes = unknowns->segment<3>(2);
  body->height_m = (*unknowns)(5);
  return true;
}

// Tangencies of a view's edges to first order about the body, whose tangent points are at their
// own depths, in the first round at that of the centre.
void BodyAtYaw::AddView(const BoxView& view, const Landmark& landmark_in_reference,
                        const Body& body, bool is_first, LinearSystem* system) const {
  const Landmark landmark = Transform(view.camera_from_reference, landmark_in_reference);
  const Eigen::Matrix3d reference_from_camera =
      view.camera_from_reference.rotation.toRotationMatrix().transpose();
  LinearSystem::Row at;
  at << body.foot, body.half_axes, body.height_m;
  for (const BoxEdge& edge : view.edges) {
    // The initial guess is too rough to decide which one-sided edges are active and which edges
    // are outliers.
    if (is_first && edge.is_one_sided) continue;
    LandmarkJacobian1 d_landmark;
    std::optional<double> residual;
    if (!is_first) {
      residual = TangencyAtOwnDepth(edge, landmark, &d_landmark);
    } else {  // all as deep as the centre; any depth will do where it is not in front
      const double depth_m = landmark.Centre().z() > 0.0 ? landmark.Centre().z() : 1.0;
      residual = Tangency(edge, landmark, {depth_m}, 0.0, &d_landmark);
    }
    if (!residual) continue;
    const double robust = is_first ? 1.0 : EvaluateLoss(loss_, *residual).weight;
    const Eigen::Vector3d d_centre = reference_from_camera * d_landmark.segment<3>(3).transpose();
    const double d_height = d_centre.dot(upright_.normal);
    LinearSystem::Row row;
    row.head<2>() << d_centre.dot(upright_.x), d_centre.dot(upright_.y);
    row.segment<3>(2) = d_landmark.tail<3>().transpose().cwiseQuotient(body.half_axes);
    row(4) += d_height;
    row(5) = evidence_.height_is_free ? d_height : 0.0;
    system->Add(row, *residual - row.dot(at), view.weight * robust);
  }
}

}  // namespace soslam
