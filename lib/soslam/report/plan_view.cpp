// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/plan_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "soslam/report/page_html.h"

namespace soslam {
namespace {

using Points = std::vector<Eigen::Vector2d>;
using Rectangle = cv::Rect2d;  // px

Eigen::AlignedBox2d FindBounds(const Points& points) {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& point : points) bounds.extend(point);
  return bounds;
}

}  // namespace

PlanAxes AxesOfPlan(const Eigen::Vector3d& up, const std::optional<Eigen::Vector3d>& scene_axis,
                    const std::vector<Eigen::Vector3d>& objects,
                    const std::vector<Eigen::Vector3d>& cameras) {
  Eigen::Index level = 0;
  up.cwiseAbs().minCoeff(&level);
  const Eigen::Vector3d axis = scene_axis.value_or(Eigen::Vector3d::Unit(level));
  PlanAxes axes;
  axes.right = (axis - up.dot(axis) * up).normalized();
  axes.away = up.cross(axes.right);
  if (objects.empty() || cameras.empty()) return axes;
  const auto bounds = [&](const std::vector<Eigen::Vector3d>& points) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& point : points) box.extend(axes.Place(point));
    return box;
  };
  const Eigen::Vector2d extent = bounds(objects).merged(bounds(cameras)).sizes();
  if (extent.y() > extent.x()) axes = {axes.away, -axes.right};
  if (bounds(cameras).center().y() > bounds(objects).center().y()) {
    axes = {-axes.right, -axes.away};
  }
  return axes;
}

Points Footprint(const Landmark& landmark_in_world, const PlanAxes& axes) {
  constexpr int kDirections = 72;
  constexpr double kSame = 0.004;  // of the longest half axis; corners are not quite sharp
  const double same = kSame * landmark_in_world.half_axes.maxCoeff();
  Points footprint;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kDirections;
    const Eigen::Vector3d direction = std::cos(angle) * axes.right + std::sin(angle) * axes.away;
    const Eigen::Vector2d point = axes.Place(FindSupportPoint(landmark_in_world, direction).point);
    if (footprint.empty() || (point - footprint.back()).norm() > same) footprint.push_back(point);
  }
  if ((footprint.front() - footprint.back()).norm() <= same) footprint.pop_back();
  return footprint;
}

Points Front(const Landmark& landmark_in_world, const PlanAxes& axes) {
  const double width = 0.6 * landmark_in_world.half_axes.head<2>().minCoeff();
  const double tip = 0.9 * landmark_in_world.half_axes.x();
  Points corners;
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(tip, 0.0, 0.0), Eigen::Vector3d(tip - width, 0.5 * width, 0.0),
        Eigen::Vector3d(tip - width, -0.5 * width, 0.0)}) {
    corners.push_back(axes.Place(landmark_in_world.frame_from_object * corner));
  }
  return corners;
}

double RoundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length) + 1e-9));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= length * (1.0 + 1e-9)) return digit * power;
  }
  return power;
}

std::string LengthInWords(double length, bool in_metres) {
  if (!in_metres) return fmt::format("{:.3g}", length);
  if (length >= 100.0) return fmt::format("{:.0f} m", length);
  return length < 1.0 ? fmt::format("{:.3g} cm", 100.0 * length) : fmt::format("{:.3g} m", length);
}

namespace {

// From the plan to the screen.
struct Screen {
  double scale = 1.0;  // px per unit of the world
  Eigen::Vector2d top_left = Eigen::Vector2d::Zero();
  double width = 0.0, height = 0.0;

  // Length of the scale bar in the world.
  double Bar() const { return RoundLength(0.25 * width / scale); }
  Eigen::Vector2d Place(const Eigen::Vector2d& point) const {
    return {scale * (point.x() - top_left.x()), scale * (top_left.y() - point.y())};
  }
  Points Place(Points points) const {
    for (Eigen::Vector2d& point : points) point = Place(point);
    return points;
  }
};

Screen FitScreen(const PlanView& plan, const PlanFormat& format) {
  Points all = plan.cameras;
  for (const PlanObject& object : plan.objects) {
    all.insert(all.end(), object.footprint.begin(), object.footprint.end());
  }
  const Eigen::AlignedBox2d bounds = FindBounds(all);
  const Eigen::Vector2d size = bounds.sizes().cwiseMax(1e-9);
  const Eigen::Vector2d room =
      Eigen::Vector2d(format.width, format.max_height).array() - 2.0 * format.margin;
  Screen screen;
  screen.scale = (room.array() / size.array()).minCoeff();
  screen.width = format.width;
  // No flatter than this, so that there is room for names.
  screen.height = std::max(screen.scale * size.y() + 2.0 * format.margin, 0.35 * format.width);
  screen.top_left = bounds.center() + Eigen::Vector2d(-0.5 * screen.width / screen.scale,
                                                      0.5 * screen.height / screen.scale);
  return screen;
}

std::string PointsText(const Points& points) {
  std::string text;
  for (const Eigen::Vector2d& point : points) {
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", point.x(), point.y());
  }
  return text;
}

std::string GridLines(const Screen& screen) {
  const double step = RoundLength(std::max(0.09 * screen.width, 60.0) / screen.scale);
  std::string path;
  const double right = screen.top_left.x() + screen.width / screen.scale;
  const double bottom = screen.top_left.y() - screen.height / screen.scale;
  for (double x = std::ceil(screen.top_left.x() / step) * step; x <= right; x += step) {
    path +=
        fmt::format("M{:.1f} 0V{:.1f}", screen.scale * (x - screen.top_left.x()), screen.height);
  }
  for (double y = std::ceil(bottom / step) * step; y <= screen.top_left.y(); y += step) {
    path += fmt::format("M0 {:.1f}H{:.1f}", screen.scale * (screen.top_left.y() - y), screen.width);
  }
  return fmt::format("<path class=\"grid-lines\" d=\"{}\"/>\n", path);
}

std::string ScaleBar(const PlanView& plan, const Screen& screen, const PlanFormat& format) {
  const double x = format.font, y = screen.height - 0.8 * format.font;
  return fmt::format(
      "<path class=\"bar-line\" d=\"M{:.1f} {:.1f}v-6m0 3h{:.1f}m0 -3v6\"/>\n"
      "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
      x, y + 3.0, screen.scale * screen.Bar(), x + 5.0, y - 5.0,
      HtmlText(LengthInWords(screen.Bar(), plan.in_metres)));
}

std::string PathOfCameras(const PlanView& plan, const Screen& screen) {
  if (plan.cameras.empty()) return "";
  const Points path = screen.Place(plan.cameras);
  return fmt::format(
      "<polyline class=\"path\" points=\"{}\"/>\n"
      "<circle class=\"path\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>\n",
      PointsText(path), path.front().x(), path.front().y());
}

// At most as many characters as fit beside others.
std::string Shortened(const std::string& name) {
  constexpr size_t kMaxBytes = 22;
  if (name.size() <= kMaxBytes) return name;
  size_t end = kMaxBytes - 3;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end) + "…";
}

Rectangle AsRectangle(const Eigen::AlignedBox2d& box) {
  return {box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y()};
}

// Sum of the areas that the rectangle shares with others, px^2.
double SharedArea(const Rectangle& one, const std::vector<Rectangle>& others) {
  double area = 0.0;
  for (const Rectangle& other : others) area += (one & other).area();
  return area;
}

// The line from an object to its card; a point where the card is on the object.
struct Leader {
  cv::Point2d from, to;

  bool Crosses(const Rectangle& card) const {
    cv::Point first = from, last = to;
    return from != to && cv::clipLine(cv::Rect(card), first, last);
  }
};

Leader MakeLeader(const Rectangle& footprint, const Rectangle& card) {
  const cv::Point2d from = 0.5 * (footprint.tl() + footprint.br());
  return {from, {std::clamp(from.x, card.x, card.br().x), std::clamp(from.y, card.y, card.br().y)}};
}

// The place near the footprint at which a card of this size covers least: of other cards, of
// leaders to them, and of footprints.
Rectangle FreePlace(const Rectangle& footprint, const cv::Size2d& size, const Screen& screen,
                    const std::vector<Rectangle>& cards, const std::vector<Leader>& leaders,
                    const std::vector<Rectangle>& footprints) {
  constexpr int kDirections = 16;
  constexpr double kStep = 9.0, kPerFootprint = 150.0, kOverlap = 600.0;
  const Rectangle whole(2.0, 2.0, screen.width - 4.0, screen.height - 4.0);
  const double farthest = std::max(screen.width, screen.height);
  Rectangle best;
  double least = std::numeric_limits<double>::infinity();
  for (double distance = 0.0; distance < std::min(farthest, least); distance += kStep) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      Rectangle place(footprint.x + 0.5 * (footprint.width - size.width),
                      footprint.y + 0.5 * (footprint.height - size.height), size.width,
                      size.height);
      place.x = std::clamp(place.x + distance * std::cos(angle), whole.x,
                           std::max(whole.x, whole.br().x - size.width));
      place.y = std::clamp(place.y + distance * std::sin(angle), whole.y,
                           std::max(whole.y, whole.br().y - size.height));
      const Leader own = MakeLeader(footprint, place);
      const bool is_crossed =
          std::ranges::any_of(cards, [&](const auto& card) { return own.Crosses(card); }) ||
          std::ranges::any_of(leaders, [&](const auto& leader) { return leader.Crosses(place); });
      const double overlap = SharedArea(place, cards);
      double covered = 0.0;  // sum of the parts of footprints
      for (const Rectangle& other : footprints) covered += (place & other).area() / other.area();
      const double cost = distance + overlap + (overlap > 0.0 || is_crossed ? kOverlap : 0.0) +
                          kPerFootprint * covered;
      if (cost < least) {
        least = cost;
        best = place;
      }
    }
  }
  return best;
}

// Width by height of the picture on a card.
double ClampAspect(const PlanObject& object) { return std::clamp(object.picture_aspect, 0.5, 1.6); }

// Cards of all objects, names with pictures of this height above them; the area of the cards, and
// that which two of them share.
struct CardLayout {
  double picture_height = 0.0;
  std::vector<Rectangle> cards = {};
  double area = 0.0;
  double overlap = 0.0;

  double HeightOn(const PlanObject& object) const {
    return object.picture.empty() ? 0.0 : picture_height;
  }
};

CardLayout LayOut(const PlanView& plan, const Screen& screen, const PlanFormat& format,
                  double picture_height) {
  constexpr double kWidthOfLetter = 0.58, kGap = 3.0;
  std::vector<Rectangle> footprints,
      taken = {{0.0, screen.height - 3.0 * format.font,
                screen.scale * screen.Bar() + 2.0 * format.font, 3.0 * format.font}};
  for (const PlanObject& object : plan.objects) {
    footprints.push_back(AsRectangle(FindBounds(screen.Place(object.footprint))));
  }
  CardLayout layout{picture_height};
  std::vector<Leader> leaders;
  for (size_t i = 0; i < plan.objects.size(); ++i) {
    const PlanObject& object = plan.objects[i];
    const double height = layout.HeightOn(object);
    const double text =
        kWidthOfLetter * format.font * static_cast<double>(Shortened(object.name).size());
    const cv::Size2d size(std::max(text, height * ClampAspect(object)) + kGap,
                          height + 1.3 * format.font + kGap);
    const Rectangle card = FreePlace(footprints[i], size, screen, taken, leaders, footprints);
    layout.area += card.area();
    layout.overlap += SharedArea(card, taken);
    layout.cards.push_back(card);
    taken.push_back(card);
    leaders.push_back(MakeLeader(footprints[i], card));
  }
  return layout;
}

}  // namespace

std::string PlanSvg(const PlanView& plan, const PlanFormat& format) {
  const Screen screen = FitScreen(plan, format);
  constexpr double kMaxShareOfCards = 0.3;  // of the plan, which is to be seen as well
  CardLayout layout;
  for (const double height : format.picture_heights) {
    layout = LayOut(plan, screen, format, height);
    const double share = layout.area / (screen.width * screen.height);
    if (layout.overlap <= 0.0 && share < kMaxShareOfCards) break;
  }
  std::string shapes, leaders, pictures, fronts, names;
  for (size_t i = 0; i < plan.objects.size(); ++i) {
    const PlanObject& object = plan.objects[i];
    const Points footprint = screen.Place(object.footprint);
    shapes += fmt::format("<polygon{} points=\"{}\"/>\n",
                          object.is_uncertain ? " class=\"uncertain\"" : "", PointsText(footprint));
    if (!object.front.empty()) {
      fronts += fmt::format("<polygon class=\"front\" points=\"{}\"/>\n",
                            PointsText(screen.Place(object.front)));
    }
    const Rectangle& card = layout.cards[i];
    const auto& [from, to] = MakeLeader(AsRectangle(FindBounds(footprint)), card);
    if (cv::norm(to - from) >= 1.0) {
      leaders += fmt::format(
          "<path class=\"leader\" d=\"M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}\"/>\n"
          "<circle class=\"leader\" cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"2\"/>\n",
          from.x, from.y, to.x, to.y);
    }
    const double middle = card.x + 0.5 * card.width, height = layout.HeightOn(object);
    if (height > 0.0) {
      const double width = height * ClampAspect(object);
      pictures += fmt::format(
          "<use href=\"#{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
          object.picture, middle - 0.5 * width, card.y, width, height);
    }
    names += fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", middle,
                         card.y + height + format.font, HtmlText(Shortened(object.name)));
  }
  return fmt::format(
             "<svg class=\"plan {}\" viewBox=\"0 0 {:.0f} {:.0f}\" font-size=\"{:.0f}\" "
             "role=\"img\" aria-label=\"{} objects from above\">\n",
             format.name, screen.width, screen.height, format.font, plan.objects.size()) +
         GridLines(screen) + PathOfCameras(plan, screen) + shapes + leaders + pictures + fronts +
         names + ScaleBar(plan, screen, format) + "</svg>\n";
}

}  // namespace soslam
