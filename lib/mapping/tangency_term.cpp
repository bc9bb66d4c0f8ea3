// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangency_term.h"

#include <cmath>
#include <limits>

#include "constraints/tangent_space.h"
#include "geometry/support_curvature.h"

namespace soslam {
namespace {

using ByPose = Eigen::Matrix<double, 4, kPoseDof>;
using ByLandmark = Eigen::Matrix<double, 4, kLandmarkDof>;
using PoseGradient = Eigen::Matrix<double, kPoseDof, 1>;
using LandmarkGradient = Eigen::Matrix<double, kLandmarkDof, 1>;
using PosePose = Eigen::Map<Eigen::Matrix<double, kPoseDof, kPoseDof>>;
using LandmarkPose = Eigen::Map<Eigen::Matrix<double, kLandmarkDof, kPoseDof>>;
using LandmarkLandmark = Eigen::Map<Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>>;

}  // namespace

// What the edges are compared with. All is in the object frame, where derivatives are simplest, and
// turned into the world at the end.
class TangencyTerm::View {
 public:
  View(const Blocks& blocks, double shape_exponent, double least_depth_m)
      : world_from_object_(Eigen::Quaterniond(blocks.landmark_in_world).toRotationMatrix()),
        object_from_camera_(world_from_object_.transpose() *
                            Eigen::Quaterniond(blocks.world_from_camera).toRotationMatrix()),
        offset_(world_from_object_.transpose() * (Eigen::Vector3d(blocks.landmark_in_world + 4) -
                                                  Eigen::Vector3d(blocks.world_from_camera + 4))),
        depth_by_offset_(object_from_camera_.col(2)),
        depth_(depth_by_offset_.dot(offset_)),
        half_axes_(Eigen::Vector3d(blocks.landmark_in_world + kPoseSize).array().exp()),
        shape_exponent_(shape_exponent),
        bias_px_(blocks.bias_px) {
    if (depth_ > least_depth_m) return;
    depth_ = least_depth_m;
    depth_by_offset_.setZero();
  }

  // How far the body reaches outside an edge.
  struct Excess {
    double value;            // less the bias
    double without_bias;     // outside the plane, over the centre's depth
    Eigen::Vector3d normal;  // of the plane behind the edge
    SupportValue support;
  };
  Excess Of(const Edge& edge) const {
    Excess excess;
    excess.normal = object_from_camera_ * edge.plane;
    excess.support = SupportFunction(half_axes_, shape_exponent_, excess.normal);
    excess.without_bias = (excess.normal.dot(offset_) + excess.support.extent) / depth_;
    excess.value = excess.without_bias - edge.per_px * bias_px_[edge.side];
    return excess;
  }
  SupportCurvature CurvatureOf(const Excess& excess) const {
    return CurvatureOfSupport(half_axes_, shape_exponent_, excess.normal, excess.support);
  }

  const Eigen::Matrix3d& world_from_object() const { return world_from_object_; }
  const Eigen::Vector3d& offset() const { return offset_; }  // from the camera to the centre
  double depth() const { return depth_; }                    // of the centre
  // The camera's optical axis, 0 where the depth is held.
  const Eigen::Vector3d& depth_by_offset() const { return depth_by_offset_; }

 private:
  Eigen::Matrix3d world_from_object_, object_from_camera_;
  Eigen::Vector3d offset_;
  Eigen::Vector3d depth_by_offset_;
  double depth_;
  Eigen::Vector3d half_axes_;
  double shape_exponent_;
  const double* bias_px_;
};

// One row per edge: first derivatives of its excess, and what its loss makes of them.
struct TangencyTerm::Rows {
  using ByVector = Eigen::Matrix<double, 4, 3>;

  double cost = 0.0;
  Eigen::Vector4d slopes = Eigen::Vector4d::Zero();
  Eigen::Vector4d curvatures = Eigen::Vector4d::Zero();
  ByVector by_turn = ByVector::Zero();    // of the landmark
  ByVector by_centre = ByVector::Zero();  // and the opposite by the camera's place
  ByVector by_axes = ByVector::Zero();    // log half axes
  ByVector by_camera_turn = ByVector::Zero();
  // Relative change of the centre's depth, which divides them all.
  Eigen::Vector3d depth_by_centre, depth_by_camera_turn;
};

// The sum over the edges of slope times second derivatives of the excess r = (n . d + h(n)) / (a .
// d): n the plane's normal, d the offset, q the point of contact, a the optical axis. Turns w of
// the landmark and v of the camera turn n, and v turns a. Without what is the product of the
// gradients of r and a . d.
class TangencyTerm::SecondDerivatives {
 public:
  // Where the body turns past an edge or a face that should come nearer, it is held there. Not so
  // where it should go away from it.
  void AddKink(const View& view, const View::Excess& excess, double slope) {
    if (!(slope > 0.0)) return;
    AddTurn(excess, slope / view.depth() * view.CurvatureOf(excess).by_direction);
  }

  void AddAll(const View& view, const View::Excess& excess, double slope) {
    const SupportCurvature curvature = view.CurvatureOf(excess);
    const double factor = slope / view.depth();
    const Eigen::Vector3d n = factor * excess.normal;
    const Eigen::Vector3d n_less_depth = n - factor * excess.without_bias * view.depth_by_offset();
    const Eigen::Vector3d& q = excess.support.contact;
    AddTurn(excess, factor * curvature.by_direction);
    normal_contact_ += n * q.transpose();
    axes_turn_ += curvature.mixed.rowwise().cross(n);
    axes_axes_ += factor * curvature.by_log_half_axes;
    normal_ += n_less_depth;
  }

  void TurnToWorld(const View& view) {
    const Eigen::Matrix3d& world_from_object = view.world_from_object();
    for (Eigen::Matrix3d* both : {&turn_, &normal_contact_}) {
      *both = (world_from_object * *both * world_from_object.transpose()).eval();
    }
    axes_turn_ = (axes_turn_ * world_from_object.transpose()).eval();
    normal_ = (world_from_object * normal_).eval();
    offset_ = world_from_object * view.offset();
  }

  void AddTo(LandmarkLandmark* square) const {
    square->topLeftCorner<3, 3>() += turn_ + OfTurned(normal_contact_);
    square->bottomLeftCorner<3, 3>() += axes_turn_;
    square->bottomRightCorner<3, 3>() += axes_axes_;
  }
  void AddTo(PosePose* square) const {
    square->topLeftCorner<3, 3>() +=
        turn_ + OfTurned(normal_contact_ + normal_ * offset_.transpose());
    square->bottomLeftCorner<3, 3>() += Skew(normal_);
  }
  void AddTo(LandmarkPose* mixed) const {
    mixed->topLeftCorner<3, 3>() -= turn_ + normal_contact_;
    mixed->topLeftCorner<3, 3>().diagonal().array() += normal_contact_.trace();
    mixed->block<3, 3>(3, 0) -= Skew(normal_);
    mixed->bottomLeftCorner<3, 3>() -= axes_turn_;
  }

 private:
  // Of x . exp(w) n by w at zero, from the sum of n x^T.
  static Eigen::Matrix3d OfTurned(const Eigen::Matrix3d& product) {
    Eigen::Matrix3d second = 0.5 * (product + product.transpose());
    second.diagonal().array() -= product.trace();
    return second;
  }

  void AddTurn(const View::Excess& excess, const Eigen::Matrix3d& by_direction) {
    turn_ += by_direction.rowwise().cross(excess.normal).colwise().cross(excess.normal);
  }

  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Zero();  // w w and v v, the opposite of w v: of h alone
  Eigen::Matrix3d normal_contact_ = Eigen::Matrix3d::Zero();  // n q^T
  Eigen::Matrix3d axes_turn_ = Eigen::Matrix3d::Zero();       // log half axes, w; the opposite by v
  Eigen::Matrix3d axes_axes_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();  // v and d: v . ((n - r a) x d)
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
};

TangencyTerm::TangencyTerm(const std::array<int, 3>& variables, const Blocks& blocks,
                           const TangentBox& box, double huber_delta, double weight)
    : Term({variables.begin(), variables.end()}),
      blocks_(blocks),
      box_(box),
      loss_{huber_delta},
      weight_(weight) {}

double TangencyTerm::Cost() const {
  const View view(blocks_, box_.shape_exponent, box_.least_depth_m);
  double cost = 0.0;
  for (int i = 0; i < box_.num_edges; ++i) {
    const Edge& edge = box_.edges[static_cast<size_t>(i)];
    const double excess = view.Of(edge).value;
    if (!(edge.is_bound && excess > 0.0)) cost += loss_(std::abs(excess)).cost;
  }
  return std::isfinite(cost) ? weight_ * cost : std::numeric_limits<double>::infinity();
}

double TangencyTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  const View view(blocks_, box_.shape_exponent, box_.least_depth_m);
  const double inverse_depth = 1.0 / view.depth();
  Rows rows;
  rows.depth_by_centre = inverse_depth * view.depth_by_offset();
  rows.depth_by_camera_turn = inverse_depth * view.depth_by_offset().cross(view.offset());
  const bool has_kinks = hessian == Hessian::kFar && box_.shape_exponent < kEllipsoidExponent;
  const bool has_second = hessian == Hessian::kNear || has_kinks;
  SecondDerivatives second;
  for (int i = 0; i < box_.num_edges; ++i) {
    const Edge& edge = box_.edges[static_cast<size_t>(i)];
    const View::Excess excess = view.Of(edge);
    if (edge.is_bound && excess.value > 0.0) continue;
    const HuberLoss::Value loss = loss_(std::abs(excess.value));
    rows.cost += weight_ * loss.cost;
    rows.slopes[i] = weight_ * loss.weight * excess.value;
    rows.curvatures[i] = weight_ * (hessian == Hessian::kNear ? loss.curvature : loss.weight);
    const Eigen::Vector3d& contact = excess.support.contact;
    const Eigen::Vector3d normal = inverse_depth * excess.normal;
    rows.by_turn.row(i) = contact.cross(normal);
    rows.by_centre.row(i) = normal - excess.without_bias * rows.depth_by_centre;
    rows.by_axes.row(i) = inverse_depth * excess.support.by_log_half_axes;
    rows.by_camera_turn.row(i) =
        normal.cross(view.offset() + contact) - excess.without_bias * rows.depth_by_camera_turn;
    if (hessian == Hessian::kNear) {
      second.AddAll(view, excess, rows.slopes[i]);
    } else if (has_kinks) {
      second.AddKink(view, excess, rows.slopes[i]);
    }
  }
  if (!std::isfinite(rows.cost)) return std::numeric_limits<double>::infinity();
  if (has_second) second.TurnToWorld(view);
  Add(rows, view.world_from_object(), has_second ? &second : nullptr, places);
  if (hessian == Hessian::kNear) AddDepthProducts(rows, view.world_from_object(), places);
  return rows.cost;
}

void TangencyTerm::Add(const Rows& rows, const Eigen::Matrix3d& world_from_object,
                       const SecondDerivatives* second, const TermPlaces& places) const {
  const auto [of_pose, of_landmark, of_bias] = places.gradient;
  const Eigen::Matrix3d to_world = world_from_object.transpose();
  ByLandmark by_landmark;
  by_landmark.leftCols<3>().noalias() = rows.by_turn.lazyProduct(to_world);
  by_landmark.middleCols<3>(3).noalias() = rows.by_centre.lazyProduct(to_world);
  by_landmark.rightCols<3>() = rows.by_axes;
  const ByLandmark weighted = rows.curvatures.asDiagonal() * by_landmark;
  if (of_landmark != nullptr) {
    Eigen::Map<LandmarkGradient>(of_landmark).noalias() +=
        by_landmark.transpose().lazyProduct(rows.slopes);
    LandmarkLandmark square(places.hessian[1][1]);
    square.noalias() += by_landmark.transpose().lazyProduct(weighted);
    if (second != nullptr) second->AddTo(&square);
  }
  ByPose by_pose;
  if (of_pose != nullptr) {
    by_pose.leftCols<3>().noalias() = rows.by_camera_turn.lazyProduct(to_world);
    by_pose.rightCols<3>() = -by_landmark.middleCols<3>(3);
    Eigen::Map<PoseGradient>(of_pose).noalias() += by_pose.transpose().lazyProduct(rows.slopes);
    const ByPose weighted_pose = rows.curvatures.asDiagonal() * by_pose;
    PosePose square(places.hessian[0][0]);
    square.noalias() += by_pose.transpose().lazyProduct(weighted_pose);
    if (second != nullptr) second->AddTo(&square);
    if (of_landmark != nullptr) {
      LandmarkPose mixed(places.hessian[1][0]);
      mixed.noalias() += weighted.transpose().lazyProduct(by_pose);
      if (second != nullptr) second->AddTo(&mixed);
    }
  }
  if (of_bias == nullptr) return;
  for (int i = 0; i < box_.num_edges; ++i) {
    const Edge& edge = box_.edges[static_cast<size_t>(i)];
    of_bias[edge.side] -= edge.per_px * rows.slopes[i];
    places.hessian[2][2][(kBiasSize + 1) * edge.side] +=
        edge.per_px * edge.per_px * rows.curvatures[i];
    if (of_landmark != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kBiasSize, kLandmarkDof>>(places.hessian[2][1])
          .row(edge.side) -= edge.per_px * weighted.row(i);
    }
    if (of_pose != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kBiasSize, kPoseDof>>(places.hessian[2][0]).row(edge.side) -=
          edge.per_px * rows.curvatures[i] * by_pose.row(i);
    }
  }
}

// What SecondDerivatives leaves out: less the gradient of the cost times the relative change of the
// depth, both ways round.
void TangencyTerm::AddDepthProducts(const Rows& rows, const Eigen::Matrix3d& world_from_object,
                                    const TermPlaces& places) const {
  const Eigen::Vector3d depth_by_centre = world_from_object * rows.depth_by_centre;
  const Eigen::Vector3d by_centre = world_from_object * (rows.by_centre.transpose() * rows.slopes);
  LandmarkGradient depth_by_landmark = LandmarkGradient::Zero();
  depth_by_landmark.segment<3>(3) = depth_by_centre;
  LandmarkGradient by_landmark;
  by_landmark << world_from_object * (rows.by_turn.transpose() * rows.slopes), by_centre,
      rows.by_axes.transpose() * rows.slopes;
  PoseGradient depth_by_pose, by_pose;
  depth_by_pose << world_from_object * rows.depth_by_camera_turn, -depth_by_centre;
  by_pose << world_from_object * (rows.by_camera_turn.transpose() * rows.slopes), -by_centre;
  const bool with_landmark = places.gradient[1] != nullptr;
  const bool with_pose = places.gradient[0] != nullptr;
  if (with_landmark) {
    LandmarkLandmark(places.hessian[1][1]) -=
        by_landmark * depth_by_landmark.transpose() + depth_by_landmark * by_landmark.transpose();
  }
  if (with_pose) {
    PosePose(places.hessian[0][0]) -=
        by_pose * depth_by_pose.transpose() + depth_by_pose * by_pose.transpose();
  }
  if (with_landmark && with_pose) {
    LandmarkPose(places.hessian[1][0]) -=
        by_landmark * depth_by_pose.transpose() + depth_by_landmark * by_pose.transpose();
  }
}

}  // namespace soslam
