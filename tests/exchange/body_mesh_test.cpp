// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "exchange/meshes.h"
#include "geometry/support_function.h"
#include "geometry/surface.h"
#include "support/mesh_checks.h"

namespace soslam {
namespace {

const Eigen::Vector3d kHalfAxes(0.3, 0.7, 1.1);

class BodyMeshTest : public testing::TestWithParam<double> {
 protected:
  const TriangleMesh mesh_ = BodyMesh(kHalfAxes, GetParam());
};

INSTANTIATE_TEST_SUITE_P(ShapeExponents, BodyMeshTest,
                         testing::Values(1.0, 1.004, 1.01, 1.1, 1.25, 1.5, 1.75, 2.0));

TEST_P(BodyMeshTest, IsClosed) { ExpectClosed(mesh_); }

TEST_P(BodyMeshTest, VerticesAreOnTheSurface) {
  const BodySurface surface(kHalfAxes, GetParam());
  for (const Eigen::Vector3d& vertex : mesh_.vertices) {
    EXPECT_NEAR(surface.Gradient(vertex).dot(vertex), 1.0, 1e-12);
  }
}

TEST_P(BodyMeshTest, HasTheVolumeOfTheBody) {
  const double ratio = SignedVolume(mesh_) / BodyVolume(kHalfAxes, GetParam());
  EXPECT_LT(ratio, 1.0 + 2e-4);  // what is nearly a cuboid is drawn as one
  EXPECT_GT(ratio, 0.99);
}

TEST(BodyMeshTest, CuboidIsABoxOfTwelveTriangles) {
  const TriangleMesh mesh = BodyMesh(kHalfAxes, kCuboidExponent);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  ASSERT_EQ(mesh.vertices.size(), 8u);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_EQ(vertex.cwiseAbs(), kHalfAxes);
  }
}

}  // namespace
}  // namespace soslam
