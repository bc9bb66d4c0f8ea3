// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/texture_asymmetry.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/facing_view.h"
#include "support/landmark_costs.h"

namespace soslam {
namespace {

SymmetryOptions EverywhereInTheImage(Descriptor descriptor) {
  SymmetryOptions options;
  options.descriptor = descriptor;
  options.sampling = Sampling::kUniform;
  options.uniform_columns = 40;
  options.min_viewing_cosine = 0.3;
  return options;
}

TextureOptions Texture(double cost, double scale) {
  TextureOptions options;
  options.asymmetry_cost = cost;
  options.asymmetry_scale = scale;
  return options;
}

std::shared_ptr<const SymmetryImage> SharedImage(const Box& box = kWholeImage) {
  return std::make_shared<const SymmetryImage>(SparseImage(box));
}

// All pixels the same: whatever is mirrored, nothing differs.
TEST(TextureAsymmetry, IsZeroForAUniformTextureAndWholeWhereNothingIsMirrored) {
  SymmetryImage image = SparseImage();
  image.maps.grey = cv::Scalar(128);
  const SymmetryOptions options = EverywhereInTheImage(Descriptor::kGrey);
  TextureOptions texture;
  texture.asymmetry_cost = 4.0;
  const Landmark landmark = FacingView().LandmarkInCamera();
  const auto cost = [&](const Landmark& of) {
    return TextureAsymmetry(image, TestCamera(), texture, options).Cost(of);
  };
  EXPECT_NEAR(cost(landmark), 0.0, 1e-12);
  // Seen from its side, every mirror point is hidden.
  EXPECT_EQ(cost(RotatedAboutZ(landmark, std::numbers::pi / 2)), 4.0);
}

// Half axes of a landmark whose front is 2.5 m away.
const Eigen::Vector3d kHalfAxes = Eigen::Vector3d::Constant(0.5);

// Two grey halves that meet in the middle of the image: every pair differs by all of the range.
TEST(TextureAsymmetry, GrowsToAllOfItWithTheDifference) {
  SymmetryImage image = SparseImage();
  image.maps.grey = cv::Scalar(0);
  image.maps.grey.colRange(0, 320) = cv::Scalar(255);
  const SymmetryOptions options = EverywhereInTheImage(Descriptor::kGrey);
  Camera camera = TestCamera();
  camera.cx = 319.5;
  const Landmark landmark = FacingLandmark(kHalfAxes);
  for (const double scale : {0.1, 1.0, 2.0, 100.0}) {
    EXPECT_NEAR(TextureAsymmetry(image, camera, Texture(3.0, scale), options).Cost(landmark),
                3.0 / (1.0 + scale * scale), 1e-9);
  }
}

// Grey values that are symmetric about a column beside the body's centre.
TEST(TextureAsymmetry, FindsTheMirrorPlaneBesideTheCentre) {
  SymmetryImage image = SparseImage();
  Camera camera = TestCamera();
  camera.cx = 319.5;
  // A plane 0.05 m to the right of the centre: y points to the left.
  const double column = 319.5 + camera.fx * 0.05 / 2.5;
  for (int x = 0; x < 640; ++x) {
    image.maps.grey.col(x) = cv::Scalar(std::min(255.0, 2.0 * std::abs(x - column)));
  }
  const SymmetryOptions options = EverywhereInTheImage(Descriptor::kGrey);
  const Landmark landmark = FacingLandmark(kHalfAxes, kCuboidExponent);
  TextureOptions texture = Texture(1.0, 0.1);
  const auto centred = TextureAsymmetry(image, camera, texture, options).Find(landmark);
  texture.mirror_plane_range = 0.2;  // of its size, either way: up to 0.1 m in steps of 0.0125 m
  const auto beside = TextureAsymmetry(image, camera, texture, options).Find(landmark);
  ASSERT_TRUE(centred && beside);
  EXPECT_GT(centred->asymmetry, 0.3);
  EXPECT_EQ(centred->mirror_plane, 0.0);
  EXPECT_LT(beside->asymmetry, 0.01);
  EXPECT_NEAR(std::abs(beside->mirror_plane) * kHalfAxes.x(), 0.05, 1e-12);
  EXPECT_NEAR(TextureAsymmetry(image, camera, texture, options).Cost(landmark), beside->asymmetry,
              1e-12);
}

TEST(MirrorPlane, MayNotLieBesideTheCentreOfWhatIsMeasuredOnTheSurface) {
  TextureOptions texture;
  for (const Descriptor descriptor :
       {Descriptor::kNearestEdge3d, Descriptor::kImprovedDt, Descriptor::kLinearisedDt}) {
    texture.mirror_plane_range = 0.1;
    EXPECT_THROW(CheckMirrorPlane(texture, descriptor), SettingsError);
    texture.mirror_plane_range = 0.0;
    EXPECT_NO_THROW(CheckMirrorPlane(texture, descriptor));
  }
  texture.mirror_plane_range = 0.1;
  EXPECT_NO_THROW(CheckMirrorPlane(texture, Descriptor::kDistanceTransform));
}

TEST(AsymmetryCost, IsTheCostAtItsStartTimesItsWeight) {
  const auto image = SharedImage();
  for (const Descriptor descriptor : {Descriptor::kLinearisedDt, Descriptor::kDistanceTransform}) {
    const SymmetryOptions options = EverywhereInTheImage(descriptor);
    TextureOptions texture = Texture(4.0, 0.3);
    // The cost's own mirror plane, wherever it is best.
    texture.mirror_plane_range = descriptor == Descriptor::kDistanceTransform ? 0.3 : 0.0;
    for (int i = 0; i < 10; ++i) {
      const Landmark start = FacingView().LandmarkInCamera();
      const AsymmetryCost term(image, TestCamera(), start, texture, options, 0.25);
      ASSERT_GT(term.NumPairs(), 50);
      const double expected =
          0.25 * TextureAsymmetry(*image, TestCamera(), texture, options).Cost(start);
      EXPECT_GT(expected, 1e-3);
      EXPECT_NEAR(term.Value(start), expected, 1e-9);
    }
  }
}

constexpr Box kMiddle{250, 180, 390, 300};

void ExpectCorrectGradients(const TextureOptions& texture, Descriptor descriptor) {
  SymmetryOptions options = EverywhereInTheImage(descriptor);
  options.uniform_columns = 12;
  for (int i = 0; i < 12; ++i) {
    Landmark landmark = FacingView().LandmarkInCamera();
    landmark.rests_on = kRestingFaces[static_cast<size_t>(i) % kRestingFaces.size()];
    const AsymmetryCost term(SharedImage(kMiddle), TestCamera(), landmark, texture, options, 0.7);
    ASSERT_GT(term.NumPairs(), landmark.rests_on == RestingFace::kSide ? 10 : 50);
    ExpectCorrectGradient(term, landmark);
  }
}

TEST(AsymmetryCost, DerivativesAgreeWithNumbers) {
  ExpectCorrectGradients(Texture(4.0, 0.3), Descriptor::kLinearisedDt);
}

TEST(AsymmetryCost, DerivativesAgreeWithNumbersWithAMirrorPlaneBesideTheCentre) {
  TextureOptions texture = Texture(4.0, 0.3);
  texture.mirror_plane_range = 0.4;
  texture.asymmetry_scale_px = 1000.0;  // differences here are hundreds of pixels
  ExpectCorrectGradients(texture, Descriptor::kDistanceTransform);
}

TEST(AsymmetryCost, CountsPairsThatLeaveTheSurfaceAsAsymmetric) {
  Landmark landmark = FacingView().LandmarkInCamera();
  const AsymmetryCost term(SharedImage(), TestCamera(), landmark, Texture(4.0, 0.3),
                           EverywhereInTheImage(Descriptor::kDistanceTransform), 1.0);
  ASSERT_GT(term.NumPairs(), 50);
  // Beside the image: no pixel's ray meets it any more.
  landmark.frame_from_object.translation.x() += 20.0;
  EXPECT_NEAR(term.Value(landmark), 4.0, 1e-9);
  LandmarkModel model;
  term.AddTo(landmark, &model);
  EXPECT_NEAR(model.cost, 4.0, 1e-9);
  EXPECT_EQ(model.gradient.norm(), 0.0);
}

}  // namespace
}  // namespace soslam
