// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "soslam/training/furniture_model.h"

namespace soslam {
namespace {

const std::vector<std::string> kKindsOfSeats = {"office chair", "cantilever chair", "shell chair",
                                                "sofa"};
const std::vector<std::string> kOtherKinds = {"monitor",      "laptop", "keyboard", "cabinet",
                                              "refrigerator", "desk",   "bed"};
constexpr int kModels = 20;  // of each kind

template <typename Check>
void ForModels(const std::vector<std::string>& kinds, const Check& check) {
  for (const std::string& kind : kinds) {
    for (int i = 0; i < kModels; ++i) {
      SCOPED_TRACE(kind + " " + std::to_string(i));
      Random random(i);
      const auto model = ParametricModel(kind, &random);
      ASSERT_TRUE(model);
      check(*model);
    }
  }
}

// Area times the normal.
Eigen::Vector3f AreaOf(const FurnitureModel::Corner* corners) {
  const float area = 0.5f * (corners[1].position - corners[0].position)
                                .cross(corners[2].position - corners[0].position)
                                .norm();
  return area * corners[0].normal;
}

Eigen::Vector3f MiddleOf(const FurnitureModel::Corner* corners, size_t count) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (size_t i = 0; i < count; ++i) sum += corners[i].position;
  return sum / static_cast<float>(count);
}

void ExpectSound(const FurnitureModel& model) {
  ASSERT_FALSE(model.corners.empty());
  ASSERT_EQ(model.corners.size(), 3 * model.materials_of_triangles.size());
  EXPECT_GT(model.size.minCoeff(), 0.01f);
  EXPECT_LT(model.size.maxCoeff(), 3.5f);
  for (const int material : model.materials_of_triangles) {
    ASSERT_GE(material, 0);
    ASSERT_LT(material, static_cast<int>(model.materials.size()));
  }
  Eigen::AlignedBox3f extent;
  for (const auto& corner : model.corners) {
    extent.extend(corner.position);
    ASSERT_NEAR(corner.normal.norm(), 1.0f, 1e-4f);
  }
  const Eigen::Vector3f half(0.5f * model.size.x(), 0.5f * model.size.y(), 0.0f);
  EXPECT_LT((extent.min() + half).norm(), 1e-4f);
  EXPECT_LT((extent.max() - half - Eigen::Vector3f(0, 0, model.size.z())).norm(), 1e-4f);
  // The sum over a closed surface of its normals is zero, and of what leaves it the volume.
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float volume = 0.0f, area = 0.0f;
  for (size_t i = 0; i < model.corners.size(); i += 3) {
    const Eigen::Vector3f of_triangle = AreaOf(&model.corners[i]);
    sum += of_triangle;
    area += of_triangle.norm();
    volume += of_triangle.dot(MiddleOf(&model.corners[i], 3)) / 3.0f;
  }
  EXPECT_LT(sum.norm(), 1e-3f * area);
  EXPECT_GT(volume, 0.0f);
}

TEST(ParametricModel, OfAnyKindAreClosedAndOfTheirSize) {
  ForModels(kKindsOfSeats, ExpectSound);
  ForModels(kOtherKinds, ExpectSound);
}

TEST(ParametricModel, NormalsOfBoxesPointOutwards) {
  ForModels({"refrigerator", "laptop", "keyboard", "monitor"}, [](const FurnitureModel& model) {
    constexpr size_t kCorners = 36;  // of a box
    ASSERT_EQ(model.corners.size() % kCorners, 0u);
    for (size_t box = 0; box < model.corners.size(); box += kCorners) {
      const Eigen::Vector3f middle = MiddleOf(&model.corners[box], kCorners);
      for (size_t i = box; i < box + kCorners; i += 3) {
        const Eigen::Vector3f outwards = MiddleOf(&model.corners[i], 3) - middle;
        ASSERT_GT(outwards.dot(model.corners[i].normal), 0.0f);
      }
    }
  });
}

TEST(ParametricModel, WhatIsHighestOfASeatIsItsBackAtTheRear) {
  ForModels(kKindsOfSeats, [](const FurnitureModel& model) {
    for (const auto& corner : model.corners) {
      if (corner.position.z() > 0.98f * model.size.z()) {
        EXPECT_LT(corner.position.x(), 0.0f);
      }
    }
  });
}

TEST(ParametricModel, IsTheSameForTheSameNumbers) {
  Random one(7), same(7), other(8);
  const auto model = ParametricModel("office chair", &one);
  EXPECT_EQ(model->size, ParametricModel("office chair", &same)->size);
  EXPECT_NE(model->size, ParametricModel("office chair", &other)->size);
}

TEST(ParametricModel, IsNoneOfAnUnknownKind) {
  Random random(1);
  EXPECT_FALSE(ParametricModel("spaceship", &random));
}

}  // namespace
}  // namespace soslam
