// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/constraints/parameters.h"
#include "support/jacobians.h"
#include "support/random_scene.h"

namespace soslam {
namespace {

// Random residuals and derivatives, the same at any landmark.
class SampledCost final : public LandmarkCost {
 public:
  explicit SampledCost(int samples)
      : residuals_(Eigen::VectorXd::Random(samples)),
        jacobian_(Eigen::MatrixXd::Random(samples, kLandmarkDof)) {}

  double Value(const Landmark& /*landmark*/) const override {
    return 0.5 * residuals_.squaredNorm();
  }
  void AddTo(const Landmark& landmark, LandmarkModel* sum) const override {
    sum->cost += Value(landmark);
    sum->gradient += jacobian_.transpose() * residuals_;
    sum->information += jacobian_.transpose() * jacobian_;
  }

 private:
  Eigen::VectorXd residuals_;
  Eigen::MatrixXd jacobian_;
};

struct Blocks {
  PoseBlock pose = ToParameterBlock(RandomRigid());
  LandmarkBlock landmark = ToParameterBlock(RandomLandmarkInCamera());
};

constexpr int kRows = kLandmarkDof + 1;
template <int kColumns>
using ImageRows = Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>;

// A few samples leave the information singular.
TEST(ImageResidual, HasCostGradientAndInformationOfAllItsSamples) {
  for (const int samples : {3, 9, 200}) {
    const Blocks blocks;
    const SampledCost cost(samples);
    const ImageResidual residual(std::make_unique<SampledCost>(cost), kCuboidExponent);
    Eigen::Matrix<double, kRows, 1> residuals;
    ImageRows<kPoseSize> d_pose;
    ImageRows<kLandmarkSize> d_landmark;
    const double* at[] = {blocks.pose.data(), blocks.landmark.data()};
    double* jacobians[] = {d_pose.data(), d_landmark.data()};
    ASSERT_TRUE(residual.Evaluate(at, residuals.data(), jacobians));
    EXPECT_NEAR(0.5 * residuals.squaredNorm(), cost.Value(Landmark()), 1e-9);

    // The same samples as a cost function of their own.
    const RelativeObservation observation(at, kCuboidExponent);
    LandmarkModel model;
    cost.AddTo(observation.landmark_in_camera(), &model);
    const std::unique_ptr<ceres::Manifold> manifold(NewLandmarkManifold());
    Eigen::Matrix<double, kLandmarkSize, kLandmarkDof, Eigen::RowMajor> plus;
    manifold->PlusJacobian(blocks.landmark.data(), plus.data());
    Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> d_tangent =
        LandmarkInCameraJacobian(observation.camera_from_world());
    d_tangent.leftCols<3>() *= 2.0;  // Ceres' rotation tangent is half the rotation vector
    const LandmarkModel expected = model.Chained(d_tangent);
    const Eigen::Matrix<double, kRows, kLandmarkDof> rows = d_landmark * plus;
    EXPECT_LT((rows.transpose() * residuals - expected.gradient).norm(),
              1e-9 * expected.gradient.norm());
    EXPECT_LT((rows.transpose() * rows - expected.information).norm(),
              1e-9 * expected.information.norm());
    // The camera moves against the landmark.
    EXPECT_LT((d_pose.rightCols<3>() + d_landmark.middleCols<3>(4)).norm(), 1e-12);

    EXPECT_NEAR(0.5 * ResidualsAt(residual, {at[0], at[1]}).squaredNorm(), cost.Value(Landmark()),
                1e-9);
  }
}

class UndefinedCost final : public LandmarkCost {
 public:
  double Value(const Landmark& /*landmark*/) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  void AddTo(const Landmark& landmark, LandmarkModel* sum) const override {
    sum->cost += Value(landmark);
  }
};

TEST(ImageResidual, FailsWhereItsCostIsNotDefined) {
  const Blocks blocks;
  const ImageResidual residual(std::make_unique<UndefinedCost>(), kCuboidExponent);
  const double* at[] = {blocks.pose.data(), blocks.landmark.data()};
  Eigen::Matrix<double, kRows, 1> residuals;
  EXPECT_FALSE(residual.Evaluate(at, residuals.data(), nullptr));
  ImageRows<kLandmarkSize> d_landmark;
  double* jacobians[] = {nullptr, d_landmark.data()};
  EXPECT_FALSE(residual.Evaluate(at, residuals.data(), jacobians));
}

}  // namespace
}  // namespace soslam
