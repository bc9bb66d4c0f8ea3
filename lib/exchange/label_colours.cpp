// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/label_colours.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace soslam {
namespace {

constexpr double kSaturation = 0.65;
constexpr double kValue = 0.9;

// `hue` in turns: 0 red, 1/3 green, 2/3 blue.
Colour ColourOfHue(double hue) {
  const Eigen::Array3d offset(5.0, 3.0, 1.0);
  Colour colour;
  for (int channel = 0; channel < 3; ++channel) {
    const double sector = std::fmod(6.0 * hue + offset[channel], 6.0);
    const double missing = std::clamp(std::min(sector, 4.0 - sector), 0.0, 1.0);
    colour[channel] = kValue * (1.0 - kSaturation * missing);
  }
  return colour;
}

}  // namespace

LabelColours ColoursOfLabels(const std::vector<World>& worlds) {
  LabelColours colours;
  for (const World& world : worlds) {
    for (const WorldObject& object : world.objects) colours[object.label];
  }
  // Steps of the golden ratio keep their distance from the hues of the last few steps.
  double hue = 0.0;
  for (auto& [label, colour] : colours) {
    colour = ColourOfHue(hue);
    hue = std::fmod(hue + 1.0 / std::numbers::phi, 1.0);
  }
  return colours;
}

}  // namespace soslam
