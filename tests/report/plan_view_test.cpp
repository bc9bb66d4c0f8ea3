// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/plan_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <regex>

#include "support/random.h"

namespace soslam {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const PlanAxes kAxes = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};

Landmark Upright(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes, double yaw,
                 const ShapeExponents& shape_exponents) {
  return {{UprightRotation(kUp, yaw), centre}, half_axes, shape_exponents};
}

double DistanceTo(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : outline) least = std::min(least, (corner - point).norm());
  return least;
}

// The support function rounds corners off by less than a thousandth of the half axes.
TEST(Footprint, OfACuboidHasItsFourCornersTurnedByItsYaw) {
  const Landmark cuboid = Upright({2.0, 1.0, 0.4}, {0.5, 0.2, 0.4}, 0.0, kCuboidExponent);
  const double from = Yaw(kUp, cuboid.frame_from_object.rotation);
  for (const double yaw : {0.0, 0.3, 1.2, -2.0}) {
    const auto outline = Footprint(RotatedAboutZ(cuboid, yaw - from), kAxes);
    const Eigen::Vector3d x_axis =
        RotatedAboutZ(cuboid, yaw - from).frame_from_object.rotation * Eigen::Vector3d::UnitX();
    const Eigen::Vector2d x = x_axis.head<2>(), y(-x.y(), x.x());
    for (const Eigen::Vector2d& point : outline) {
      const Eigen::Vector2d inside = point - Eigen::Vector2d(2.0, 1.0);
      EXPECT_NEAR(std::max(std::abs(inside.dot(x)) / 0.5, std::abs(inside.dot(y)) / 0.2), 1.0,
                  0.01);
    }
    for (const double a : {-0.5, 0.5}) {
      for (const double b : {-0.2, 0.2}) {
        EXPECT_LT(DistanceTo(outline, Eigen::Vector2d(2.0, 1.0) + a * x + b * y), 1e-3) << yaw;
      }
    }
  }
}

TEST(Footprint, OfAnEllipsoidIsItsEllipse) {
  const Landmark ball = Upright({1.0, 0.0, 0.2}, {0.3, 0.3, 0.2}, 0.4, kEllipsoidExponent);
  const auto outline = Footprint(ball, kAxes);
  EXPECT_EQ(outline.size(), 72u);
  for (const Eigen::Vector2d& point : outline) {
    EXPECT_NEAR((point - Eigen::Vector2d(1.0, 0.0)).norm(), 0.3, 1e-9);
  }
}

TEST(Front, PointsAlongTheXAxisWithinTheFootprint) {
  for (int i = 0; i < 20; ++i) {
    const double yaw = RandomUniform(-3.0, 3.0);
    const Landmark body = Upright({1.0, 2.0, 3.0}, RandomVector(0.2, 2.0), yaw, kCuboidExponent);
    const auto corners = Front(body, kAxes);
    ASSERT_EQ(corners.size(), 3U);
    const Eigen::Vector2d along = corners[0] - 0.5 * (corners[1] + corners[2]);
    EXPECT_LT((along.normalized() - Eigen::Vector2d(std::cos(yaw), std::sin(yaw))).norm(), 1e-9);
    for (const Eigen::Vector2d& corner : corners) {
      const Eigen::Vector3d in_object =
          body.frame_from_object.Inverse() * Eigen::Vector3d(corner.x(), corner.y(), 3.0);
      EXPECT_LT(std::abs(in_object.x()), body.half_axes.x());
      EXPECT_LT(std::abs(in_object.y()), body.half_axes.y());
    }
  }
}

TEST(AxesOfPlan, TurnTheSceneAxisLevelAndTheLongSideToTheRight) {
  // Objects in a row along the scene axis, 30 degrees from x; cameras on one side.
  const Eigen::Vector3d along(std::cos(kPi / 6), std::sin(kPi / 6), 0.0);
  const Eigen::Vector3d across = kUp.cross(along);
  const std::vector<Eigen::Vector3d> objects = {-2.0 * along, along, 2.0 * along};
  for (const Eigen::Vector3d& axis : {along, across, Eigen::Vector3d(-along)}) {
    for (const double side : {-1.0, 1.0}) {
      const PlanAxes axes = AxesOfPlan(kUp, axis, objects, {side * across});
      EXPECT_NEAR(std::abs(axes.right.dot(along)), 1.0, 1e-12);
      EXPECT_NEAR(axes.away.dot(across), -side, 1e-12);
      // The view is from above, not from below.
      EXPECT_NEAR(axes.right.cross(axes.away).dot(kUp), 1.0, 1e-12);
    }
  }
}

TEST(AxesOfPlan, AreLevelWithoutASceneAxis) {
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -1.0, 0.2).normalized();
  const PlanAxes axes = AxesOfPlan(up, std::nullopt, {}, {});
  EXPECT_NEAR(axes.right.dot(up), 0.0, 1e-12);
  EXPECT_NEAR(axes.away.dot(up), 0.0, 1e-12);
  EXPECT_NEAR(axes.right.norm(), 1.0, 1e-12);
}

TEST(RoundLength, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(RoundLength(1.0), 1.0);
  EXPECT_DOUBLE_EQ(RoundLength(0.49), 0.2);
  EXPECT_DOUBLE_EQ(RoundLength(0.5), 0.5);
  EXPECT_DOUBLE_EQ(RoundLength(999.0), 500.0);
  EXPECT_DOUBLE_EQ(RoundLength(0.011), 0.01);
}

TEST(LengthInWords, HasTheUnitThatPeopleUse) {
  EXPECT_EQ(LengthInWords(0.5, true), "50 cm");
  EXPECT_EQ(LengthInWords(2.0, true), "2 m");
  EXPECT_EQ(LengthInWords(2000.0, true), "2000 m");
  EXPECT_EQ(LengthInWords(0.5, false), "0.5");
}

// Objects at random places, close together where there are many.
PlanView PlanOf(int count) {
  PlanView plan;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d centre(std::fmod(0.618 * i, 1.0) * 5.0, std::fmod(0.414 * i, 1.0) * 3.0,
                                 0.3);
    const Landmark body = Upright(centre, {0.2, 0.15, 0.3}, 0.7 * i, kCuboidExponent);
    plan.objects.push_back(
        {"object " + std::to_string(i), Footprint(body, kAxes), 0.6, "p" + std::to_string(i), 1.3});
  }
  plan.cameras = {{0.0, -1.0}, {5.0, -1.0}};
  return plan;
}

// Where names begin and end, by their middles: all letters are as wide.
std::vector<Eigen::AlignedBox2d> NamesIn(const std::string& svg, double font) {
  std::vector<Eigen::AlignedBox2d> names;
  const std::regex name("class=\"name\" x=\"([0-9.]+)\" y=\"([0-9.]+)\">([^<]*)<");
  for (std::sregex_iterator found(svg.begin(), svg.end(), name), end; found != end; ++found) {
    const double x = std::stod((*found)[1]), y = std::stod((*found)[2]);
    const double half = 0.5 * 0.55 * font * static_cast<double>((*found)[3].length());
    names.emplace_back(Eigen::Vector2d(x - half, y - 0.7 * font), Eigen::Vector2d(x + half, y));
  }
  return names;
}

class PlanSvgTest : public testing::TestWithParam<int> {};

TEST_P(PlanSvgTest, NamesAllObjectsInsideThePlanAndApart) {
  const PlanView plan = PlanOf(GetParam());
  for (const PlanFormat& format : {kWidePlan, kNarrowPlan}) {
    const std::string svg = PlanSvg(plan, format);
    const auto names = NamesIn(svg, format.font);
    ASSERT_EQ(names.size(), plan.objects.size());
    for (size_t i = 0; i < names.size(); ++i) {
      EXPECT_GE(names[i].min().minCoeff(), 0.0);
      EXPECT_LE(names[i].max().x(), format.width);
      EXPECT_LE(names[i].max().y(), format.max_height);
      for (size_t k = 0; k < i; ++k) {
        EXPECT_TRUE(names[i].intersection(names[k]).isEmpty()) << format.name << i << " " << k;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, PlanSvgTest, testing::Values(1, 2, 7, 15, 25, 40));

TEST(PlanSvg, LinesToNamesCrossNoPictureOfAnotherObject) {
  const std::regex line("class=\"leader\" d=\"M([0-9.]+) ([0-9.]+)L([0-9.]+) ([0-9.]+)");
  const std::regex picture(
      "<use [^>]*x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)");
  const auto all = [](const std::string& svg, const std::regex& pattern) {
    std::vector<Eigen::Vector4d> found;
    for (std::sregex_iterator next(svg.begin(), svg.end(), pattern), end; next != end; ++next) {
      found.emplace_back(std::stod((*next)[1]), std::stod((*next)[2]), std::stod((*next)[3]),
                         std::stod((*next)[4]));
    }
    return found;
  };
  for (const int count : {10, 13, 17}) {
    const std::string svg = PlanSvg(PlanOf(count), kWidePlan);
    ASSERT_EQ(all(svg, picture).size(), static_cast<size_t>(count));
    for (const Eigen::Vector4d& ends : all(svg, line)) {
      for (const Eigen::Vector4d& rectangle : all(svg, picture)) {
        const Eigen::AlignedBox2d inside(rectangle.head<2>().array() + 1.0,
                                         (rectangle.head<2>() + rectangle.tail<2>()).array() - 1.0);
        for (double share = 0.0; share < 0.95; share += 0.05) {
          EXPECT_FALSE(inside.contains((1.0 - share) * ends.head<2>() + share * ends.tail<2>()))
              << count;
        }
      }
    }
  }
}

TEST(PlanSvg, IsToScale) {
  const PlanView plan = PlanOf(7);
  const std::string svg = PlanSvg(plan, kWidePlan);
  std::smatch bar, path;
  ASSERT_TRUE(std::regex_search(svg, bar, std::regex("bar-line.*m0 3h([0-9.]+)m0")));
  EXPECT_THAT(svg, HasSubstr(">2 m</text>"));
  // The cameras are 5 m apart.
  ASSERT_TRUE(std::regex_search(
      svg, path, std::regex("polyline class=\"path\" points=\"([0-9.]+),[0-9.]+ ([0-9.]+),")));
  EXPECT_NEAR(std::stod(path[2]) - std::stod(path[1]), 2.5 * std::stod(bar[1]), 0.2);
}

TEST(PlanSvg, PointsToFrontsThatAreKnown) {
  PlanView plan = PlanOf(3);
  EXPECT_THAT(PlanSvg(plan, kWidePlan), testing::Not(HasSubstr("class=\"front\"")));
  plan.objects[1].front = {{0.0, 0.0}, {0.1, 0.0}, {0.0, 0.1}};
  EXPECT_THAT(PlanSvg(plan, kWidePlan), HasSubstr("<polygon class=\"front\" points="));
}

TEST(PlanSvg, HasNamesAsTextAndShortensLongOnes) {
  PlanView plan = PlanOf(1);
  plan.objects[0].name = "<b>&";
  EXPECT_THAT(PlanSvg(plan, kWidePlan), HasSubstr(">&lt;b&gt;&amp;</text>"));
  plan.objects[0].name = std::string(17, 'x') + "ééé" + std::string(400, 'y');
  EXPECT_THAT(PlanSvg(plan, kWidePlan), HasSubstr(">" + std::string(17, 'x') + "é…</text>"));
}

}  // namespace
}  // namespace soslam
